// The address holds what is shown, so that a finding can be sent to a colleague; what is as always is left out.

const KNOWN = ["tab", "town", "policy", "seed", "speed", "camera", "episode", "t", "filter", "run", "link"] as const;
type Name = (typeof KNOWN)[number];
type Value = string | number | string[] | null;

/** As the page was opened: what is shown since has been written over it. */
const FIRST = new URLSearchParams(location.search);

export const asked = (name: Name | "noaa"): string | null => FIRST.get(name);

/** Time to begin a replay at [s]; undefined for its start. */
export function askedTime(): number | undefined {
  const time = asked("t");
  return time === null || Number.isNaN(Number(time)) ? undefined : Number(time);
}

/** All values of a name that may come several times; none at all is something else than an empty one. */
export const askedAll = (name: Name): string[] | null => (FIRST.has(name) ? FIRST.getAll(name) : null);

/** Write what is shown into the address. A token never stays there: people copy addresses, and the cookie has it. */
export function remember(values: Partial<Record<Name, Value>>): void {
  if (!location.protocol.startsWith("http")) return; // a file, or a frame without an address
  const query = new URLSearchParams(location.search);
  query.delete("token");
  for (const [name, value] of Object.entries(values)) {
    query.delete(name);
    if (Array.isArray(value)) for (const it of value) query.append(name, it);
    else if (value !== null && value !== "") query.set(name, String(value));
  }
  query.sort();
  const text = query.toString(), now = location.search.replace(/^\?/, "");
  if (text !== now) history.replaceState(null, "", text ? `?${text}` : location.pathname);
}
