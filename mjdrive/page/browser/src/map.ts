// The town from above, with the trail of the car and where it broke the rules.
import type { Message } from "./codec";
import { $, COLORS, fitted, say } from "./dom";
import { described, drawPicked, drawPin, PIN_PX } from "./infractions";
import type { Infraction } from "./link";
import { COLUMNS } from "./rows";

const MARGIN = 10;
const LIGHTS = ["#37d67a", "#f5c542", "#ff5c4d"];
const LIGHT_PX = [1.5, 1.8, 2.2]; // size tells a red one, too, for those who see no red
const MOST_POINTS = 6000;
const FAINT = 0.4; // of a replay's way still to come

export class MapPanel {
  private readonly canvas = $<HTMLCanvasElement>("map");
  private readonly trail: number[] = [];
  private done = 1; // share of the trail that has been driven
  private town?: Message;
  private base?: HTMLCanvasElement;
  private infractions: Infraction[] = [];
  private picked?: Infraction;
  private lights: ArrayLike<number> = [];
  private car = { x: 0, y: 0, yaw: 0 };

  constructor(private readonly onPin: (time: number) => void) {
    this.canvas.onclick = (event) => { const pin = this.pinAt(event); if (pin) this.pick(pin); };
    this.canvas.onmousemove = (event) => {
      const pin = this.pinAt(event);
      this.canvas.style.cursor = pin ? "pointer" : "";
      this.describe(pin ?? this.picked);
    };
    this.canvas.onmouseleave = () => this.describe(this.picked);
  }

  /** Mark a pin, say what it is, and go to its time where one can. */
  pick(pin: Infraction): void {
    this.picked = pin;
    this.describe(pin);
    this.draw();
    this.onPin(pin[1]);
  }

  setTown(town: Message): void { this.town = town; this.base = undefined; }
  setLights(lights: ArrayLike<number>): void { this.lights = lights; }

  setInfractions(infractions: Infraction[]): void {
    this.infractions = infractions;
    this.picked = infractions.find((it) => String(it) === String(this.picked));
    this.describe(this.picked);
  }

  setTrail(rows: Float32Array): void {
    this.trail.length = 0;
    this.done = 1;
    this.extendTrail(rows);
  }

  extendTrail(rows: Float32Array): void {
    for (let at = 0; at < rows.length; at += COLUMNS) this.trail.push(rows[at + 1], rows[at + 2]);
    while (this.trail.length > 2 * MOST_POINTS) this.thinOut();
  }

  /** Put the car somewhere; in a replay only a share of the trail has been driven by then, the rest is drawn faint. */
  move(x: number, y: number, yaw: number, done = 1): void {
    this.car = { x, y, yaw };
    this.done = done;
  }

  /** A page left open over night must draw no slower in the morning. */
  private thinOut(): void {
    let kept = 0;
    for (let at = 0; at < this.trail.length; at += 4) { this.trail[kept++] = this.trail[at]; this.trail[kept++] = this.trail[at + 1]; }
    this.trail.length = kept;
  }

  draw(): void {
    if (!this.town || !this.canvas.clientWidth) return;
    const { pen, width, height } = fitted(this.canvas), to = this.projection(width, height);
    if (!this.base || this.base.width !== this.canvas.width || this.base.height !== this.canvas.height) this.base = this.drawnRoads(width, height);
    pen.save(); pen.resetTransform(); pen.drawImage(this.base, 0, 0); pen.restore();
    this.drawLights(pen, to);
    this.drawTrail(pen, to);
    for (const it of this.infractions) drawPin(pen, to.x(it[2]), to.y(it[3]), it[0]);
    this.drawCar(pen, to);
    if (this.picked) drawPicked(pen, to.x(this.picked[2]), to.y(this.picked[3]));
  }

  private describe(pin?: Infraction): void { say($("map-say"), pin ? described(pin) : ""); }

  /** The way so far ends at the car. */
  private drawTrail(pen: CanvasRenderingContext2D, to: Projection): void {
    const end = 2 * Math.round(this.done * this.trail.length / 2), { x, y } = this.car;
    const line = (from: number, until: number): void => {
      for (let at = from; at < until; at += 2) pen.lineTo(to.x(this.trail[at]), to.y(this.trail[at + 1]));
    };
    pen.strokeStyle = COLORS.trail; pen.lineWidth = 2; pen.lineJoin = "round";
    pen.beginPath(); line(0, end); pen.lineTo(to.x(x), to.y(y)); pen.stroke();
    pen.globalAlpha = FAINT;
    pen.beginPath(); line(end, this.trail.length); pen.stroke();
    pen.globalAlpha = 1;
  }

  private drawnRoads(width: number, height: number): HTMLCanvasElement {
    const base = document.createElement("canvas"), ratio = this.canvas.width / width, to = this.projection(width, height);
    base.width = this.canvas.width; base.height = this.canvas.height;
    const pen = base.getContext("2d")!, { lane_points, lane_ends, lane_widths } = this.town!.blobs;
    pen.scale(ratio, ratio);
    pen.fillStyle = COLORS.land; pen.fillRect(0, 0, width, height);
    pen.strokeStyle = COLORS.road; pen.lineCap = pen.lineJoin = "round";
    lane_ends.forEach((end: number, lane: number) => {
      pen.lineWidth = Math.max(1.5, lane_widths[lane] * to.scale);
      pen.beginPath();
      for (let at = lane ? lane_ends[lane - 1] : 0; at < end; at += 3) pen.lineTo(to.x(lane_points[2 * at]), to.y(lane_points[2 * at + 1]));
      pen.lineTo(to.x(lane_points[2 * end - 2]), to.y(lane_points[2 * end - 1]));
      pen.stroke();
    });
    return base;
  }

  private drawLights(pen: CanvasRenderingContext2D, to: Projection): void {
    const places = this.town!.blobs.light_places;
    for (let light = 0; light < this.lights.length && 2 * light < places.length; light++) {
      pen.fillStyle = LIGHTS[this.lights[light]];
      pen.beginPath(); pen.arc(to.x(places[2 * light]), to.y(places[2 * light + 1]), LIGHT_PX[this.lights[light]], 0, 7); pen.fill();
    }
  }

  private drawCar(pen: CanvasRenderingContext2D, to: Projection): void {
    pen.save();
    pen.translate(to.x(this.car.x), to.y(this.car.y)); pen.rotate(-this.car.yaw);
    pen.fillStyle = COLORS.car; pen.strokeStyle = "#fff"; pen.lineWidth = 1.5;
    pen.beginPath(); pen.moveTo(8, 0); pen.lineTo(-5, 5); pen.lineTo(-2.5, 0); pen.lineTo(-5, -5); pen.closePath(); pen.stroke(); pen.fill();
    pen.restore();
  }

  private pinAt(event: MouseEvent): Infraction | undefined {
    if (!this.town) return undefined;
    const to = this.projection(this.canvas.clientWidth, this.canvas.clientHeight);
    return this.infractions.find((it) => Math.hypot(to.x(it[2]) - event.offsetX, to.y(it[3]) - PIN_PX - event.offsetY) < PIN_PX);
  }

  private projection(width: number, height: number): Projection {
    const [left, bottom, right, top] = this.town!.head.bounds;
    const scale = Math.min((width - 2 * MARGIN) / (right - left), (height - 2 * MARGIN) / (top - bottom));
    return {
      scale, x: (x) => width / 2 + (x - (left + right) / 2) * scale, y: (y) => height / 2 - (y - (bottom + top) / 2) * scale,
    };
  }
}

interface Projection { scale: number; x(x: number): number; y(y: number): number }
