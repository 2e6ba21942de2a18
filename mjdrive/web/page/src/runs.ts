// The runs tab: training curves of several runs over each other, and how drives of each policy went.
import { fetchJson } from "./codec";
import { $, COLORS, fitted, make } from "./dom";
import { table } from "./table";

interface Epoch { epoch: number; loss: number; validation_loss: number | null; duration_s: number }
interface Run { name: string; error?: string; method: string; seed: number; epochs: Epoch[] }

const PALETTE = ["#6cb8ff", "#f2c14e", "#8fd694", "#ff6b57", "#c792ea", "#4dd0c4"];

export class Runs {
  private runs: Run[] = [];
  private readonly chosen = new Set<string>();
  private readonly canvas = make("canvas", { role: "img", ariaLabel: "Loss of each epoch" });
  private readonly list = make("div", { className: "scroll" });

  constructor() {
    $("runs").append(make("div", { className: "bar" }, make("h2", { textContent: "Training runs" })), make("figure", {}, this.canvas,
      make("figcaption", { textContent: "Loss by epoch [nats]; dashed: of the pairs held out. A loss compares runs of one method only." })), this.list);
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  async load(): Promise<void> {
    this.runs = (await fetchJson<Run[]>("api/runs")).filter((it) => !it.error);
    this.canvas.parentElement!.hidden = !this.runs.length;
    if (!this.runs.length) {
      this.list.replaceChildren(make("div", { className: "empty" }, make("strong", { textContent: "No training run yet." }), " ", make("code", { textContent: "mjdrive train da-ibc" }), " makes one."));
      return;
    }
    for (const it of this.runs.slice(0, PALETTE.length)) this.chosen.add(it.name);
    this.list.replaceChildren(table(this.runs, [
      { title: "", value: (it) => (this.chosen.has(it.name) ? 0 : 1), show: (it) => this.switch(it) },
      { title: "Run", value: (it) => it.name }, { title: "Method", value: (it) => it.method },
      { title: "Seed", value: (it) => it.seed, numeric: true },
      { title: "Epochs", value: (it) => it.epochs.length, numeric: true },
      { title: "Last loss", value: (it) => last(it)?.loss ?? NaN, show: (it) => last(it)?.loss.toFixed(3) ?? "–", numeric: true },
      { title: "Held out", value: (it) => last(it)?.validation_loss ?? NaN, show: (it) => last(it)?.validation_loss?.toFixed(3) ?? "–", numeric: true },
      { title: "Minutes", value: (it) => minutes(it), show: (it) => minutes(it).toFixed(0), numeric: true },
    ], "Training runs"));
    this.draw();
  }

  private switch(run: Run): Node {
    const box = make("input", { type: "checkbox", checked: this.chosen.has(run.name), ariaLabel: `Show ${run.name}` });
    const label = make("label", { className: "swatch" }, box);
    label.style.setProperty("--swatch", this.color(run));
    box.onchange = () => { if (box.checked) this.chosen.add(run.name); else this.chosen.delete(run.name); this.draw(); };
    return label;
  }

  private color(run: Run): string { return PALETTE[this.runs.indexOf(run) % PALETTE.length]; }

  private draw(): void {
    const shown = this.runs.filter((it) => this.chosen.has(it.name) && it.epochs.length);
    if (!this.canvas.clientWidth || !this.runs.length) return;
    const { pen, width, height } = fitted(this.canvas), left = 44, bottom = 26, top = 8;
    const values = shown.flatMap((it) => it.epochs.flatMap((epoch) => [epoch.loss, epoch.validation_loss ?? epoch.loss]));
    const low = Math.min(0, ...values), high = Math.max(1e-6, ...values), most = Math.max(2, ...shown.map((it) => it.epochs.length));
    const x = (epoch: number): number => left + (epoch - 1) / (most - 1) * (width - left - 12);
    const y = (loss: number): number => top + (1 - (loss - low) / (high - low)) * (height - top - bottom);
    pen.clearRect(0, 0, width, height);
    pen.font = "12px system-ui, sans-serif"; pen.lineWidth = 1;
    for (let tick = 0; tick <= 4; tick++) {
      const value = low + (high - low) * tick / 4;
      pen.strokeStyle = COLORS.grid; pen.beginPath(); pen.moveTo(left, y(value)); pen.lineTo(width - 12, y(value)); pen.stroke();
      pen.fillStyle = COLORS.text; pen.textAlign = "right"; pen.textBaseline = "middle"; pen.fillText(value.toFixed(2), left - 6, y(value));
    }
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (let epoch = 1; epoch <= most; epoch += Math.max(1, Math.ceil(most / 12))) pen.fillText(String(epoch), x(epoch), height - bottom + 8);
    for (const run of shown) for (const [name, dash] of [["loss", []], ["validation_loss", [5, 4]]] as const) {
      pen.strokeStyle = this.color(run); pen.lineWidth = 2; pen.setLineDash([...dash]); pen.beginPath();
      for (const epoch of run.epochs) if (epoch[name] !== null) pen.lineTo(x(epoch.epoch), y(epoch[name]!));
      pen.stroke();
    }
    pen.setLineDash([]);
  }
}

const last = (run: Run): Epoch | undefined => run.epochs[run.epochs.length - 1];
const minutes = (run: Run): number => run.epochs.reduce((sum, it) => sum + it.duration_s, 0) / 60;
