// The address holds what is shown, so that a finding can be sent to a colleague.

const KNOWN = ["tab", "town", "policy", "seed", "camera", "episode", "t", "link"] as const;
type Name = (typeof KNOWN)[number];

export const asked = (name: Name | "noaa"): string | null => new URLSearchParams(location.search).get(name);

export function remember(values: Partial<Record<Name, string | number | null>>): void {
  const query = new URLSearchParams(location.search);
  query.delete("token");
  for (const [name, value] of Object.entries(values)) {
    if (value === null || value === "") query.delete(name);
    else query.set(name, String(value));
  }
  const text = query.toString();
  if (`?${text}` !== location.search) history.replaceState(null, "", text ? `?${text}` : location.pathname);
}
