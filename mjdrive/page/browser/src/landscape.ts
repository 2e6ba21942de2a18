// What the policy thinks of all actions: steering across, as it turns (left is left), acceleration upwards. Everything in the
// panel belongs to one decision, whose tick is in its caption; where there was no time for its landscape, none is shown.
import type { Message } from "./codec";
import { $, fitted, make, say } from "./dom";
import { boxOf, DEPTH_NATS, drawAxes, drawMark, drawPoints, drawScale, paint, spotAt, type Spot } from "./landscape_drawing";

const KEY_STEP = 1 / 32;
const MOVES: Record<string, [number, number]> = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1] };

interface Thought { tick: number; pixels?: Uint8Array; size: number; points?: Int8Array; chosen?: Spot; driven?: Spot }

export class LandscapePanel {
  private readonly canvas = $<HTMLCanvasElement>("energy");
  private readonly field = make("canvas");
  private readonly line = $("energy-say");
  private readonly iterations = make("div", { className: "switches", role: "group", ariaLabel: "Iteration of the search" });
  private thought: Thought = { tick: -1, size: 0 };
  private numIterations = 0;
  private shown = -1; // iteration; -1 is all
  private cross: Spot | null = null;
  private why = "";
  isPaused = false;
  isLate = false;

  constructor(private readonly force: (acceleration: number, steering: number) => void) {
    this.canvas.after(this.iterations);
    this.canvas.onmousemove = (event) => this.look(this.spot(event));
    this.canvas.onmouseleave = this.canvas.onblur = () => this.look(null);
    this.canvas.onclick = (event) => this.take(this.spot(event));
    this.canvas.onkeydown = (event) => this.press(event);
  }

  /** Show nothing until the next decision, and say why. */
  forget(why = ""): void {
    this.thought = { tick: -1, size: 0 };
    this.why = why;
    this.setIterations(0);
    say($("energy-tick"), "");
    this.draw();
    this.tell();
  }

  show({ head, blobs, shapes }: Message): void {
    const spot = (action: number[] | null): Spot | undefined => (action ? { acceleration: action[0], steering: action[1] } : undefined);
    this.thought = {
      tick: head.tick, chosen: spot(head.action), driven: isOther(head) ? spot(head.driven) : undefined,
      pixels: blobs.density as Uint8Array | undefined, size: blobs.density ? shapes.density[0] : 0, points: blobs.points as Int8Array | undefined,
    };
    if (this.thought.pixels) paint(this.field, this.thought.pixels, this.thought.size);
    this.setIterations(blobs.points ? shapes.points[0] : 0);
    say($("energy-tick"), `tick ${head.tick}`);
    this.draw();
    this.tell();
  }

  draw(): void {
    const { pen, width, height } = fitted(this.canvas), box = boxOf(width, height), { pixels, points, chosen, driven } = this.thought;
    if (box.width < 1) return;
    pen.clearRect(0, 0, width, height);
    pen.fillStyle = "#12161b";
    pen.fillRect(box.x, box.y, box.width, box.height);
    if (pixels) { pen.imageSmoothingEnabled = true; pen.drawImage(this.field, box.x, box.y, box.width, box.height); }
    drawAxes(pen, box);
    drawScale(pen, box);
    if (points) drawPoints(pen, box, points, this.numIterations, this.shown);
    if (driven) drawMark(pen, box, driven, "square");
    if (chosen) drawMark(pen, box, chosen, "ring");
    if (this.cross) drawMark(pen, box, this.cross, "cross");
  }

  private setIterations(count: number): void {
    if (count === this.numIterations) return;
    this.numIterations = count;
    this.shown = -1;
    const names = ["all", ...Array.from({ length: count }, (_, index) => `${index + 1}`)];
    this.iterations.replaceChildren(...(count ? ["search ", ...names.map((name, index) => {
      const button = make("button", { type: "button", textContent: name, ariaPressed: String(index === 0), ariaLabel: index ? `Iteration ${name}` : "All iterations" });
      button.onclick = () => {
        this.shown = index - 1;
        this.iterations.querySelectorAll("button").forEach((it) => (it.ariaPressed = String(it === button)));
        this.draw();
      };
      return button;
    })] : []));
  }

  private press(event: KeyboardEvent): void {
    const move = MOVES[event.key];
    if (!this.isPaused || !(move || event.key === "Enter" || event.key === "Escape")) return;
    event.preventDefault(); // else the same key would drive
    if (event.key === "Enter") return this.take(this.cross);
    const from = this.cross ?? this.thought.chosen ?? { acceleration: 0, steering: 0 };
    const bound = (value: number): number => Math.min(Math.max(value, -1), 1);
    this.look(move ? { acceleration: bound(from.acceleration + KEY_STEP * move[0]), steering: bound(from.steering + KEY_STEP * move[1]) } : null);
  }

  private take(spot: Spot | null): void { if (spot && this.isPaused) this.force(spot.acceleration, spot.steering); }

  private look(spot: Spot | null): void {
    this.cross = spot;
    this.draw();
    this.tell();
  }

  private tell(): void {
    const { pixels, size, chosen, driven } = this.thought;
    if (this.cross) {
      const hint = this.isPaused ? " · click or Enter takes it" : " · pause to take it";
      return say(this.line, `${words(this.cross)}${pixels ? ": " + below(pixels, size, this.cross) : ""}${hint}`);
    }
    const none = this.isLate ? "The simulation is late, so no landscape is made; pause to see one." : "This policy names one action and weighs no others.";
    const marks = [chosen ? `○ chosen: ${words(chosen)}` : "", driven ? `□ driven: ${words(driven)}` : ""].filter(Boolean).join(" · ");
    say(this.line, [this.why, marks, pixels || this.why || !chosen ? "" : none].filter(Boolean).join(" · "));
  }

  private spot(event: MouseEvent): Spot | null {
    return spotAt(boxOf(this.canvas.clientWidth, this.canvas.clientHeight), event.offsetX, event.offsetY);
  }
}

/** Whether something else was done than the policy chose: by hand, or forced. */
const isOther = ({ by, driven, action }: Record<string, any>): boolean => by === "hand" || String(driven) !== String(action);
const signed = (value: number): string => (value >= 0 ? "+" : "−") + Math.abs(value).toFixed(2);
const words = ({ acceleration, steering }: Spot): string => `acceleration ${signed(acceleration)}, steering ${signed(steering)}`;

function below(pixels: Uint8Array, size: number, { acceleration, steering }: Spot): string {
  const row = Math.round((acceleration + 1) / 2 * (size - 1)), column = Math.round((steering + 1) / 2 * (size - 1));
  const nats = (1 - pixels[row * size + column] / 255) * DEPTH_NATS;
  return `${nats >= DEPTH_NATS - 0.1 ? `${DEPTH_NATS} nats or more` : `${nats.toFixed(1)} nats`} below the best`;
}
