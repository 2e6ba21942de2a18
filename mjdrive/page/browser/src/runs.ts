// The runs tab: training curves of several runs over each other, and how drives of each policy went.
import { askedAll, remember } from "./address";
import { fetchJson } from "./codec";
import { Curves, type Epoch, type Run } from "./curves";
import { $, make } from "./dom";
import { evaluationTable, type Drive } from "./evaluations";
import { table } from "./table";

/** Okabe and Ito's colours, made a little lighter for a dark ground: told apart by those who see no red or no green, too. */
const PALETTE = ["#56b4e9", "#e69f00", "#2fc49a", "#f0e442", "#e08bbd", "#f0743a", "#b4bcc6", "#8a9bff"];
const FIRST_SHOWN = 8;

export class Runs {
  private runs: Run[] = [];
  private chosen?: Set<string>; // until there are runs to choose from
  private readonly curves = make("div", { className: "curves" });
  private readonly list = make("div", { className: "block" });
  private readonly evaluations = make("div", { className: "block" });

  constructor() {
    $("runs").append(make("div", { className: "scroll stack" },
      make("h2", { textContent: "Training runs" }), this.curves,
      make("p", { id: "curves-say", className: "quiet", textContent: "Loss by epoch, in the unit of each method; dashed or hollow: of the pairs held out." }), this.list,
      make("h2", { textContent: "Evaluation of drives" }), this.evaluations));
  }

  async load(): Promise<void> {
    const [all, drives] = await Promise.all([fetchJson<Run[]>("api/runs"), fetchJson<Drive[]>("api/drives")]);
    this.runs = all.filter((it) => !it.error);
    this.evaluations.replaceChildren(evaluationTable(drives));
    $("curves-say").hidden = this.curves.hidden = !this.runs.length;
    if (!all.length) return this.list.replaceChildren(make("div", { className: "empty" }, make("strong", { textContent: "No training run yet." }), " ", make("code", { textContent: "mjdrive train da-ibc" }), " makes one."));
    if (this.runs.length) this.chosen ??= new Set(askedAll("run") ?? this.firstShown);
    this.list.replaceChildren(this.table(), ...unreadable(all.filter((it) => it.error)));
    this.show();
  }

  private table(): Node {
    return table(this.runs, [
      { title: "", value: (it) => (this.chosen?.has(it.name) ? 0 : 1), show: (it) => this.switch(it) },
      { title: "Run", value: (it) => it.name }, { title: "Method", value: (it) => it.method },
      { title: "Seed", value: (it) => it.seed, numeric: true },
      { title: "Epochs", value: (it) => it.epochs.length, numeric: true },
      { title: "Last loss", value: (it) => last(it)?.loss ?? NaN, show: (it) => digits(last(it)?.loss), numeric: true },
      { title: "Held out", value: (it) => last(it)?.validation_loss ?? NaN, show: (it) => digits(last(it)?.validation_loss), numeric: true },
      { title: "Time [min]", value: (it) => minutes(it), show: (it) => minutes(it).toFixed(0), numeric: true },
    ], "Training runs");
  }

  private switch(run: Run): Node {
    const box = make("input", { type: "checkbox", checked: this.chosen?.has(run.name) ?? false, ariaLabel: `Show ${run.name}` });
    const label = make("label", { className: "swatch" }, box);
    label.style.setProperty("--swatch", this.color(run));
    box.onchange = () => { if (box.checked) this.chosen?.add(run.name); else this.chosen?.delete(run.name); this.rememberChosen(); this.show(); };
    return label;
  }

  private get firstShown(): string[] { return this.runs.slice(0, FIRST_SHOWN).map((it) => it.name); }

  /** Which runs are shown, if not those that are shown at first; an empty name means none. */
  private rememberChosen(): void {
    const names = this.runs.map((it) => it.name).filter((it) => this.chosen?.has(it));
    remember({ run: String(names) === String(this.firstShown) ? null : names.length ? names : [""] });
  }

  private color(run: Run): string { return PALETTE[this.runs.indexOf(run) % PALETTE.length]; }

  private show(): void {
    const shown = this.runs.filter((it) => this.chosen?.has(it.name) && it.epochs.length);
    const methods = [...new Set(shown.map((it) => it.method))];
    this.curves.replaceChildren(...methods.map((method) => new Curves(method, shown.filter((it) => it.method === method), (run) => this.color(run)).element));
  }
}

const unreadable = (broken: Run[]): Node[] => broken.map((it) => make("p", { className: "quiet" }, make("strong", { textContent: it.name }), ` ${it.error}`));
const last = (run: Run): Epoch | undefined => run.epochs[run.epochs.length - 1];
const digits = (value: number | null | undefined): string => (value == null ? "–" : value.toFixed(3).replace("-", "−"));
const minutes = (run: Run): number => run.epochs.reduce((sum, it) => sum + it.duration_s, 0) / 60;
