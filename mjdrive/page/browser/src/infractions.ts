// How infractions look wherever they are shown: a letter and a colour each, so that nobody has to tell colours apart.
import { $, make } from "./dom";
import type { Infraction } from "./link";

export const PIN_PX = 14;

const LOOKS: Record<string, [letter: string, color: string]> = {
  red_light: ["R", "#ff7a66"], collision: ["C", "#f0a030"], off_road: ["O", "#d79bf0"], kerb: ["K", "#c9b08a"],
  wrong_way: ["W", "#6fd0e6"], stuck: ["S", "#b4bcc6"],
};

export const look = (kind: string): [string, string] => LOOKS[kind] ?? [kind[0].toUpperCase(), "#ffffff"];
export const spoken = (kind: string): string => kind.replaceAll("_", " ");
export const described = ([kind, time, , , cause]: Infraction): string => `${spoken(kind)} at ${time.toFixed(1)} s${cause ? `: ${cause}` : ""}`;

export function drawPin(pen: CanvasRenderingContext2D, x: number, y: number, kind: string): void {
  const [letter, color] = look(kind);
  pen.fillStyle = color; pen.strokeStyle = "#11151a"; pen.lineWidth = 1;
  pen.beginPath(); pen.arc(x, y - PIN_PX, 7, Math.PI * 0.85, Math.PI * 0.15); pen.lineTo(x, y); pen.closePath();
  pen.fill(); pen.stroke();
  pen.fillStyle = "#11151a"; pen.font = "bold 10px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
  pen.fillText(letter, x, y - PIN_PX + 0.5);
}

/** A ring around the pin that was picked. */
export function drawPicked(pen: CanvasRenderingContext2D, x: number, y: number): void {
  pen.strokeStyle = "#ffffff"; pen.lineWidth = 2;
  pen.beginPath(); pen.arc(x, y - PIN_PX, 11, 0, 7); pen.stroke();
}

/** How many there are of each kind; also the legend of the pins, and the way to them without a mouse: each press picks the next one. */
export function showCounts(infractions: Infraction[], pick: (infraction: Infraction) => void): void {
  const kinds = new Map<string, Infraction[]>(), list = $("infractions");
  for (const it of infractions) kinds.set(it[0], [...(kinds.get(it[0]) ?? []), it]);
  const items = [...kinds].map(([kind, all]) => {
    const [letter, color] = look(kind), badge = make("b", { textContent: letter, ariaHidden: "true" });
    badge.style.background = color;
    const button = make("button", { type: "button", title: "Show the next one on the map" }, badge, `${all.length} × ${spoken(kind)}`);
    let next = 0;
    button.dataset.kind = kind;
    button.onclick = () => pick(all[next++ % all.length]);
    return make("li", {}, button);
  });
  const focused = list.contains(document.activeElement) ? (document.activeElement as HTMLElement).dataset.kind : undefined;
  list.replaceChildren(...(items.length ? items : [make("li", { className: "clean", textContent: "no infraction" })]));
  if (focused) list.querySelector<HTMLElement>(`[data-kind=${focused}]`)?.focus();
}
