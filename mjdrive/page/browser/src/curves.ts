// Training curves of the runs of one method: their losses can be compared, those of two methods cannot.
import { COLORS, fitted, make } from "./dom";

export interface Epoch { epoch: number; loss: number; validation_loss: number | null; duration_s: number }
export interface Run { name: string; error?: string; method: string; seed: number; epochs: Epoch[] }

const MARGIN = { left: 48, right: 12, top: 10, bottom: 34 };
const KINDS = [["loss", []], ["validation_loss", [5, 4]]] as const;

export class Curves {
  readonly element: HTMLElement;
  private readonly canvas: HTMLCanvasElement;

  constructor(method: string, private readonly runs: Run[], private readonly color: (run: Run) => string) {
    this.canvas = make("canvas", { role: "img", ariaLabel: `Loss of ${method} by epoch: ${runs.map((it) => it.name).join(", ")}` });
    this.element = make("figure", {}, make("figcaption", {}, method), this.canvas);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  private draw(): void {
    if (!this.canvas.clientWidth) return;
    const { pen, width, height } = fitted(this.canvas), { left, right, top, bottom } = MARGIN;
    const values = this.runs.flatMap((it) => it.epochs.flatMap((epoch) => [epoch.loss, epoch.validation_loss ?? epoch.loss])).filter(Number.isFinite);
    const ticks = niceTicks(Math.min(...values), Math.max(...values)), low = ticks[0], high = ticks[ticks.length - 1];
    const most = Math.max(2, ...this.runs.map((it) => it.epochs.length));
    const x = (epoch: number): number => left + (epoch - 1) / (most - 1) * (width - left - right);
    const y = (loss: number): number => top + (1 - (loss - low) / (high - low)) * (height - top - bottom);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif"; pen.lineWidth = 1; pen.setLineDash([]);
    pen.fillStyle = COLORS.text; pen.strokeStyle = COLORS.grid; pen.textAlign = "right"; pen.textBaseline = "middle";
    for (const value of ticks) {
      pen.beginPath(); pen.moveTo(left, y(value)); pen.lineTo(width - right, y(value)); pen.stroke();
      pen.fillText(String(Number(value.toPrecision(6))).replace("-", "−"), left - 6, y(value));
    }
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (let epoch = 1; epoch <= most; epoch += Math.max(1, Math.ceil(most / 10))) pen.fillText(String(epoch), x(epoch), height - bottom + 5);
    pen.fillText("epoch", left + (width - left - right) / 2, height - bottom + 19);
    for (const run of this.runs) for (const [name, dash] of KINDS) this.drawLine(pen, run, name, [...dash], x, y);
  }

  private drawLine(pen: CanvasRenderingContext2D, run: Run, name: "loss" | "validation_loss", dash: number[], x: (epoch: number) => number, y: (loss: number) => number): void {
    const points = run.epochs.filter((it) => it[name] !== null && Number.isFinite(it[name])).map((it) => [x(it.epoch), y(it[name]!)]);
    pen.strokeStyle = pen.fillStyle = this.color(run); pen.lineWidth = 2; pen.setLineDash(dash);
    pen.beginPath();
    for (const [px, py] of points) pen.lineTo(px, py);
    pen.stroke();
    if (points.length > 1) return;
    for (const [px, py] of points) { pen.beginPath(); pen.setLineDash([]); pen.arc(px, py, 4, 0, 7); if (dash.length) pen.stroke(); else pen.fill(); }
  }
}

/** Four to seven round numbers that hold a range. */
function niceTicks(low: number, high: number): number[] {
  const raw = Math.max(high - low, 1e-6) / 4, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((it) => it * power).find((it) => it >= raw)!;
  const first = Math.floor(low / step), last = Math.max(Math.ceil(high / step), first + 1);
  return Array.from({ length: last - first + 1 }, (_, index) => (first + index) * step);
}
