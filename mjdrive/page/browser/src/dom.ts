// Small words for the document.

export const $ = <T extends HTMLElement = HTMLElement>(id: string): T => document.getElementById(id) as T;

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, properties: Partial<HTMLElementTagNameMap[K]> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Write text only where it changes: each write costs a layout. */
export function say(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Give a canvas as many pixels as it takes on the screen; its context draws in CSS pixels. */
export function fitted(canvas: HTMLCanvasElement): { pen: CanvasRenderingContext2D; width: number; height: number } {
  const ratio = Math.min(devicePixelRatio, 2), width = canvas.clientWidth, height = canvas.clientHeight;
  const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== columns || canvas.height !== rows) { canvas.width = columns; canvas.height = rows; }
  const pen = canvas.getContext("2d")!;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { pen, width, height };
}

export function options(select: HTMLSelectElement, values: [string, string][], chosen: string): void {
  select.replaceChildren(...values.map(([value, text]) => make("option", { value, textContent: text, selected: value === chosen })));
}

export const COLORS = {
  speed: "#6cb8ff", acceleration: "#8fd694", steering: "#f2c14e", trail: "#6cb8ff", car: "#ff6b57", chosen: "#ffffff",
  road: "#4a525f", land: "#20252c", text: "#aab4c0", grid: "#323a45",
};
