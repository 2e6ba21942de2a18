// The row of controls above the live view.
import { asked, remember } from "./address";
import { fetchJson } from "./codec";
import { $, options, say } from "./dom";
import type { State } from "./link";

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];

export class Controls {
  private state?: State;
  private readonly town = $<HTMLSelectElement>("town");
  private readonly policy = $<HTMLSelectElement>("policy");
  private readonly seed = $<HTMLInputElement>("seed");
  private readonly factor = $<HTMLSelectElement>("speed-factor");

  constructor(private readonly send: (command: object) => void) {
    options(this.factor, SPEEDS.map((it) => [String(it), `${it}×`]), "1");
    this.town.onchange = () => this.load({ town: this.town.value });
    this.policy.onchange = () => this.load({ policy: this.policy.value });
    this.seed.onchange = () => { if (this.seed.checkValidity() && this.seed.value) this.load({ seed: Number(this.seed.value) }); };
    this.factor.onchange = () => send({ op: "speed", factor: Number(this.factor.value) });
    $("pause").onclick = () => this.pause();
    $("step").onclick = () => this.step();
    $("reset").onclick = () => this.reset();
    $("wheel").onclick = () => { this.wheel(); $("gl").focus(); };
    $("keep").onclick = () => this.keep();
    $("controls").onsubmit = (event) => event.preventDefault();
  }

  /** Fill the lists, and ask for what the address asks for. */
  async begin(): Promise<void> {
    const { towns, policies } = await fetchJson<{ towns: string[]; policies: string[] }>("api/catalogue");
    options(this.town, towns.map((it) => [it, it]), this.state?.town ?? "");
    options(this.policy, policies.map((it) => [it, it]), this.state?.policy ?? "");
    if (this.state) this.show(this.state);
    const wanted: Record<string, unknown> = {};
    if (asked("town")) wanted.town = asked("town");
    if (asked("policy")) wanted.policy = asked("policy");
    if (/^\d+$/.test(asked("seed") ?? "")) wanted.seed = Number(asked("seed"));
    const differs = Object.entries(wanted).some(([name, value]) => this.state?.[name as keyof State] !== value);
    if (differs) this.load(wanted);
  }

  show(state: State): void {
    this.state = state;
    this.town.value = state.town;
    this.policy.value = state.policy;
    if (document.activeElement !== this.seed) this.seed.value = String(state.seed);
    this.factor.value = String(state.speed);
    say($("pause"), state.paused ? "Play" : "Pause");
    const wheel = $<HTMLButtonElement>("wheel");
    say(wheel, state.wheel === "yours" ? "Give the wheel back" : state.wheel === "taken" ? "The wheel is taken" : "Take the wheel");
    wheel.disabled = state.wheel === "taken";
    wheel.setAttribute("aria-pressed", String(state.wheel === "yours"));
    $("keep").hidden = state.recorded === 0;
    say($("keep"), `Keep ${(state.recorded / 10).toFixed(0)} s as a demonstration`);
  }

  pause(): void { this.send({ op: "pause", on: !this.state?.paused }); }
  step(): void { this.send({ op: "step" }); }
  reset(): void { this.send({ op: "reset" }); }
  wheel(): void { this.send({ op: "wheel", on: this.state?.wheel !== "yours" }); }
  keep(): void { if (this.state?.recorded) this.send({ op: "keep" }); }

  private load(values: Record<string, unknown>): void {
    this.send({ op: "load", ...values });
    remember(values as Record<string, string | number>);
  }
}
