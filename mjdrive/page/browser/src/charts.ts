// Speed and the two commands over time, one small chart below the other.
import { $, COLORS, fitted } from "./dom";
import { COLUMNS } from "./rows";

const SPAN_S = 20;
const LEFT = 34, RIGHT = 8, TITLE = 20, BOTTOM = 16;
const CHARTS = [
  { name: "speed", unit: "km/h", column: 3, factor: 3.6, low: 0, high: 36, color: COLORS.speed },
  { name: "acceleration", unit: "", column: 4, factor: 1, low: -1, high: 1, color: COLORS.acceleration },
  { name: "steering, left is up", unit: "", column: 5, factor: 1, low: -1, high: 1, color: COLORS.steering },
] as const;

interface Chart { name: string; unit: string; column: number; factor: number; low: number; high: number; color: string }

export class ChartsPanel {
  private readonly canvas = $<HTMLCanvasElement>("charts");
  private rows: number[] = [];

  /** The row of the moment that is shown; what is done then may be open. Later ones are not drawn. */
  now: ArrayLike<number> = [];

  set(rows: ArrayLike<number>): void { this.rows = Array.from(rows); }

  add(rows: Float32Array): void {
    this.rows.push(...rows);
    const surplus = this.rows.length - COLUMNS * 2000;
    if (surplus > 0) this.rows.splice(0, Math.ceil(surplus / COLUMNS) * COLUMNS);
  }

  /** Draw the last seconds before the moment that is shown. */
  draw(): void {
    const until = this.now[0] ?? this.rows[this.rows.length - COLUMNS] ?? 0;
    if (!this.canvas.clientWidth) return;
    const { pen, width, height } = fitted(this.canvas), each = (height - BOTTOM) / CHARTS.length;
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    CHARTS.forEach((chart, index) => this.drawOne(pen, this.scaled(chart, until), index * each + TITLE, each - TITLE, width, until));
    pen.fillStyle = COLORS.text; pen.textBaseline = "bottom";
    for (const [ago, align] of [[SPAN_S, "left"], [SPAN_S / 2, "center"], [0, "right"]] as const) {
      pen.textAlign = align;
      pen.fillText(ago ? `−${ago} s` : "now", LEFT + (1 - ago / SPAN_S) * (width - LEFT - RIGHT), height);
    }
  }

  /** A fast car gets a higher axis instead of a line that is cut off. */
  private scaled(chart: Chart, until: number): Chart {
    if (chart.low < 0) return chart;
    let most = chart.high;
    for (const [, value] of this.points(chart, until)) most = Math.max(most, value);
    return { ...chart, high: 12 * Math.ceil(most / 12) };
  }

  /** Times [s] and values until a time, the last seconds of it; of the decision that is shown, what is known. */
  private points({ column, factor }: Chart, until: number): [time: number, value: number][] {
    const found: [number, number][] = [], add = (time: number, value: number): void => {
      if (time >= until - SPAN_S && time <= until + 1e-6 && Number.isFinite(value)) found.push([time, factor * value]);
    };
    for (let at = 0; at < this.rows.length; at += COLUMNS) if (!(this.rows[at] >= this.now[0])) add(this.rows[at], this.rows[at + column]);
    if (this.now.length) add(this.now[0], this.now[column]);
    return found;
  }

  private drawOne(pen: CanvasRenderingContext2D, chart: Chart, top: number, height: number, width: number, until: number): void {
    const x = (time: number): number => LEFT + (1 - (until - time) / SPAN_S) * (width - LEFT - RIGHT);
    const y = (value: number): number => top + height * (1 - (value - chart.low) / (chart.high - chart.low));
    pen.strokeStyle = COLORS.grid; pen.lineWidth = 1;
    pen.fillStyle = COLORS.text; pen.textAlign = "right"; pen.textBaseline = "middle";
    pen.beginPath();
    for (const value of [chart.low, (chart.low + chart.high) / 2, chart.high]) {
      pen.moveTo(LEFT, y(value)); pen.lineTo(width - RIGHT, y(value));
      pen.fillText(String(value).replace("-", "−"), LEFT - 5, y(value));
    }
    pen.stroke();
    pen.strokeStyle = chart.color; pen.lineWidth = 1.6; pen.lineJoin = "round";
    pen.beginPath();
    const points = this.points(chart, until);
    for (const [time, value] of points) pen.lineTo(x(time), Math.min(Math.max(y(value), top), top + height));
    pen.stroke();
    this.drawTitle(pen, chart, points[points.length - 1]?.[1] ?? NaN, top, width);
  }

  private drawTitle(pen: CanvasRenderingContext2D, chart: Chart, last: number, top: number, width: number): void {
    pen.fillStyle = chart.color; pen.textBaseline = "bottom"; pen.textAlign = "left";
    pen.fillText(chart.name, LEFT, top - 4);
    if (!Number.isFinite(last)) return;
    const value = last.toFixed(chart.unit ? 0 : 2).replace(/^-(0(\.0+)?)$/, "$1").replace("-", "−");
    pen.textAlign = "right";
    pen.fillText(`${value} ${chart.unit}`.trim(), width - RIGHT, top - 4);
  }
}
