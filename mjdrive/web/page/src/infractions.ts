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

/** How many there are of each kind; also the legend of the pins. */
export function showCounts(infractions: Infraction[]): void {
  const counts = new Map<string, number>();
  for (const [kind] of infractions) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  const items = [...counts].map(([kind, count]) => {
    const [letter, color] = look(kind), badge = make("b", { textContent: letter, ariaHidden: "true" });
    badge.style.background = color;
    return make("li", {}, badge, `${count} × ${spoken(kind)}`);
  });
  $("infractions").replaceChildren(...(items.length ? items : [make("li", { className: "clean", textContent: "no infraction" })]));
}
