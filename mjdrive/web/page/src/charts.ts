// Speed and the two commands over time, one small chart below the other.
import { $, COLORS, fitted } from "./dom";

const SPAN_S = 20;
const LEFT = 34, RIGHT = 8, GAP = 10;
const CHARTS = [
  { name: "speed", unit: "km/h", column: 3, factor: 3.6, low: 0, high: 36, color: COLORS.speed },
  { name: "acceleration", unit: "", column: 4, factor: 1, low: -1, high: 1, color: COLORS.acceleration },
  { name: "steering", unit: "", column: 5, factor: 1, low: -1, high: 1, color: COLORS.steering },
] as const;
const COLUMNS = 6;

export class ChartsPanel {
  private readonly canvas = $<HTMLCanvasElement>("charts");
  private rows: number[] = [];

  set(rows: ArrayLike<number>): void { this.rows = Array.from(rows); }

  add(row: number[]): void {
    this.rows.push(...row);
    const surplus = this.rows.length - COLUMNS * 2000;
    if (surplus > 0) this.rows.splice(0, Math.ceil(surplus / COLUMNS) * COLUMNS);
  }

  /** Draw the last seconds before a time [s]; the newest if none is given. */
  draw(until = this.rows.length ? this.rows[this.rows.length - COLUMNS] : 0): void {
    if (!this.canvas.clientWidth) return;
    const { pen, width, height } = fitted(this.canvas), each = (height - GAP) / CHARTS.length;
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    CHARTS.forEach((chart, index) => this.drawOne(pen, chart, index * each + GAP, each - GAP, width, until));
  }

  private drawOne(pen: CanvasRenderingContext2D, chart: (typeof CHARTS)[number], top: number, height: number, width: number, until: number): void {
    const x = (time: number): number => LEFT + (1 - (until - time) / SPAN_S) * (width - LEFT - RIGHT);
    const y = (value: number): number => top + height * (1 - (value - chart.low) / (chart.high - chart.low));
    pen.strokeStyle = COLORS.grid; pen.lineWidth = 1;
    pen.beginPath();
    for (const value of [chart.low, (chart.low + chart.high) / 2, chart.high]) { pen.moveTo(LEFT, y(value)); pen.lineTo(width - RIGHT, y(value)); }
    pen.stroke();
    pen.fillStyle = COLORS.text; pen.textAlign = "right"; pen.textBaseline = "middle";
    for (const value of [chart.low, chart.high]) pen.fillText(String(value), LEFT - 5, y(value));
    pen.strokeStyle = chart.color; pen.lineWidth = 1.6; pen.lineJoin = "round";
    pen.beginPath();
    let last = NaN;
    for (let at = 0; at < this.rows.length; at += COLUMNS) {
      const time = this.rows[at];
      if (time < until - SPAN_S || time > until + 1e-6) continue;
      last = chart.factor * this.rows[at + chart.column];
      pen.lineTo(x(time), Math.min(Math.max(y(last), top), top + height));
    }
    pen.stroke();
    pen.fillStyle = chart.color; pen.textAlign = "left"; pen.textBaseline = "top";
    const value = Number.isFinite(last) ? ` ${last.toFixed(chart.unit ? 0 : 2).replace(/^-(0(\.0+)?)$/, "$1")} ${chart.unit}` : "";
    pen.fillText(chart.name + value, LEFT + 4, top + 2);
  }
}
