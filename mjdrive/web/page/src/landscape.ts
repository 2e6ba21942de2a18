// What the policy thinks of all actions: steering across, as it turns (left is left), acceleration upwards.
import type { Message } from "./codec";
import { $, COLORS, fitted, make, say } from "./dom";

const MARGIN = { left: 30, bottom: 24, top: 6, right: 6 };
const ITERATION_COLORS = ["rgba(255,255,255,.35)", "rgba(120,220,255,.6)", "rgba(150,255,150,.95)"];

export class LandscapePanel {
  private readonly canvas = $<HTMLCanvasElement>("energy");
  private readonly field = make("canvas");
  private readonly line = $("energy-say");
  private readonly iterations = make("div", { className: "switches" });
  private pixels?: Uint8Array;
  private points?: Int8Array;
  private size = 0;
  private numIterations = 0;
  private shown = -1; // iteration; -1 is all
  private head: Record<string, any> = {};
  private landscapeTick = -1;
  isPaused = false;

  constructor(private readonly force: (acceleration: number, steering: number) => void) {
    this.canvas.after(this.iterations);
    this.canvas.onmousemove = (event) => this.hover(event);
    this.canvas.onmouseleave = () => this.tell();
    this.canvas.onclick = (event) => { const at = this.at(event); if (at && this.isPaused) this.force(at.acceleration, at.steering); };
  }

  forget(): void { this.pixels = this.points = undefined; this.draw(); }

  show({ head, blobs, shapes }: Message): void {
    this.head = head;
    if (blobs.density) {
      this.pixels = blobs.density as Uint8Array;
      this.size = shapes.density[0];
      this.landscapeTick = head.tick;
      this.paint();
    }
    this.points = blobs.points as Int8Array | undefined;
    this.setIterations(this.points ? shapes.points[0] : 0);
    this.draw();
    this.tell();
  }

  draw(): void {
    const { pen, width, height } = fitted(this.canvas), box = this.box(width, height);
    pen.clearRect(0, 0, width, height);
    pen.fillStyle = "#12161b";
    pen.fillRect(box.x, box.y, box.width, box.height);
    if (this.pixels) { pen.imageSmoothingEnabled = true; pen.drawImage(this.field, box.x, box.y, box.width, box.height); }
    this.drawAxes(pen, box);
    this.drawPoints(pen, box);
    if (this.head.action) this.drawChosen(pen, box);
  }

  private paint(): void {
    if (this.field.width !== this.size) this.field.width = this.field.height = this.size;
    const image = new ImageData(this.size, this.size), last = this.size - 1;
    for (let row = 0; row < this.size; row++) for (let column = 0; column < this.size; column++) {
      const value = this.pixels![(last - row) * this.size + (last - column)] / 255; // row down, left is positive steering
      image.data.set([...magma(value), 255], 4 * (row * this.size + column));
    }
    this.field.getContext("2d")!.putImageData(image, 0, 0);
  }

  private drawAxes(pen: CanvasRenderingContext2D, box: Box): void {
    pen.strokeStyle = "rgba(255,255,255,.18)";
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(box.x + box.width / 2, box.y); pen.lineTo(box.x + box.width / 2, box.y + box.height);
    pen.moveTo(box.x, box.y + box.height / 2); pen.lineTo(box.x + box.width, box.y + box.height / 2);
    pen.stroke();
    pen.fillStyle = COLORS.text;
    pen.font = "11px system-ui, sans-serif";
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (const [text, share] of [["left", 0.06], ["steering", 0.5], ["right", 0.93]] as const) pen.fillText(text, box.x + share * box.width, box.y + box.height + 6);
    pen.save();
    pen.translate(box.x - 18, 0); pen.rotate(-Math.PI / 2);
    for (const [text, share] of [["gas", 0.08], ["acceleration", 0.5], ["brake", 0.9]] as const) pen.fillText(text, -(box.y + share * box.height), -2);
    pen.restore();
  }

  private drawPoints(pen: CanvasRenderingContext2D, box: Box): void {
    if (!this.points) return;
    const each = this.points.length / this.numIterations;
    for (let iteration = 0; iteration < this.numIterations; iteration++) {
      if (this.shown >= 0 && this.shown !== iteration) continue;
      pen.fillStyle = ITERATION_COLORS[Math.round((iteration / Math.max(1, this.numIterations - 1)) * 2)];
      for (let at = iteration * each; at < (iteration + 1) * each; at += 2) {
        const [x, y] = place(box, this.points[at] / 127, this.points[at + 1] / 127);
        pen.fillRect(x - 1, y - 1, 2, 2);
      }
    }
  }

  private drawChosen(pen: CanvasRenderingContext2D, box: Box): void {
    const [x, y] = place(box, this.head.action[0], this.head.action[1]);
    for (const [width, color] of [[4, "rgba(0,0,0,.7)"], [2, COLORS.chosen]] as const) {
      pen.strokeStyle = color; pen.lineWidth = width;
      pen.beginPath(); pen.arc(x, y, 6, 0, 7); pen.stroke();
    }
  }

  private setIterations(count: number): void {
    if (count === this.numIterations) return;
    this.numIterations = count;
    this.shown = -1;
    const names = ["all", ...Array.from({ length: count }, (_, index) => `${index + 1}`)];
    this.iterations.replaceChildren(...(count ? ["search", ...names.map((name, index) => {
      const button = make("button", { type: "button", textContent: name, ariaPressed: String(index === 0) });
      button.onclick = () => {
        this.shown = index - 1;
        this.iterations.querySelectorAll("button").forEach((it) => (it.ariaPressed = String(it === button)));
        this.draw();
      };
      return button;
    })] : []));
  }

  private tell(): void {
    const [acceleration, steering] = this.head.action ?? [0, 0];
    const stale = this.pixels && this.landscapeTick !== this.head.tick ? `, landscape of tick ${this.landscapeTick}` : "";
    const none = this.pixels ? "" : " · an expert weighs no alternatives";
    say(this.line, `chosen: ${signed(acceleration)} acceleration, ${signed(steering)} steering${stale}${none}`);
  }

  private hover(event: MouseEvent): void {
    const at = this.at(event);
    if (!at || !this.pixels) return this.tell();
    const row = Math.round((at.acceleration + 1) / 2 * (this.size - 1)), column = Math.round((at.steering + 1) / 2 * (this.size - 1));
    const below = (1 - this.pixels[row * this.size + column] / 255) * 12;
    const hint = this.isPaused ? " · click to take it" : "";
    say(this.line, `${signed(at.acceleration)}, ${signed(at.steering)}: ${below >= 11.9 ? "12 nats or more" : below.toFixed(1) + " nats"} below the best${hint}`);
  }

  private at(event: MouseEvent): { acceleration: number; steering: number } | null {
    const box = this.box(this.canvas.clientWidth, this.canvas.clientHeight);
    const steering = 1 - 2 * (event.offsetX - box.x) / box.width, acceleration = 1 - 2 * (event.offsetY - box.y) / box.height;
    return Math.abs(steering) <= 1 && Math.abs(acceleration) <= 1 ? { acceleration, steering } : null;
  }

  private box(width: number, height: number): Box {
    return { x: MARGIN.left, y: MARGIN.top, width: width - MARGIN.left - MARGIN.right, height: height - MARGIN.top - MARGIN.bottom };
  }
}

interface Box { x: number; y: number; width: number; height: number }

const place = (box: Box, acceleration: number, steering: number): [number, number] =>
  [box.x + (1 - steering) / 2 * box.width, box.y + (1 - acceleration) / 2 * box.height];
const signed = (value: number): string => (value >= 0 ? "+" : "−") + Math.abs(value).toFixed(2);

const MAGMA = [[9, 10, 20], [58, 20, 104], [140, 41, 129], [222, 73, 104], [254, 159, 109], [252, 253, 191]];
function magma(value: number): number[] {
  const at = Math.min(value, 0.9999) * (MAGMA.length - 1), low = Math.floor(at), share = at - low;
  return MAGMA[low].map((from, index) => from + share * (MAGMA[low + 1][index] - from));
}
