// The row of controls above the live view, and who may use it: one page is in control, the others can ask.
import { asked, remember } from "./address";
import { fetchJson } from "./codec";
import { $, make, options, say } from "./dom";
import type { State } from "./link";

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];
const STEPS_A_SECOND = 10;

export class Controls {
  private state?: State;
  private isLost = true; // until the server has said who is who
  private shownRoles = "";
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
    // Not left focused: Enter would press it again instead of keeping the recording.
    $("wheel").onclick = () => { this.wheel(); $("wheel").blur(); $("gl").focus(); };
    $("keep").onclick = () => this.keep();
    $("drop").onclick = () => this.drop();
    $("controls").onsubmit = (event) => event.preventDefault();
  }

  /** Fill the lists, and ask for what the address asks for. */
  async begin(): Promise<void> {
    await this.refresh();
    const speed = Number(asked("speed"));
    if (this.isMine && SPEEDS.includes(speed) && speed !== this.state?.speed) this.send({ op: "speed", factor: speed });
    const wanted: Record<string, unknown> = {};
    if (asked("town")) wanted.town = asked("town");
    if (asked("policy")) wanted.policy = asked("policy");
    if (/^\d+$/.test(asked("seed") ?? "")) wanted.seed = Number(asked("seed"));
    const differs = Object.entries(wanted).some(([name, value]) => this.state?.[name as keyof State] !== value);
    if (differs && this.isMine) this.load(wanted);
  }

  /** Towns and policies as they are by now: runs come and go while a page is open. */
  async refresh(): Promise<void> {
    const { towns, policies } = await fetchJson<{ towns: string[]; policies: string[] }>("api/catalogue");
    fill(this.town, towns, this.state?.town);
    fill(this.policy, policies, this.state?.policy);
  }

  /** The connection is lost: nothing that is pressed would be heard. */
  setLost(): void {
    this.isLost = true;
    this.shownRoles = "";
    $("roles").hidden = true;
    this.enable();
  }

  show(state: State): void {
    this.state = state;
    this.isLost = false;
    choose(this.town, state.town);
    choose(this.policy, state.policy);
    if (document.activeElement !== this.seed) this.seed.value = String(state.seed);
    this.factor.value = String(state.speed);
    say($("pause"), state.paused ? "Play" : "Pause");
    const wheel = $<HTMLButtonElement>("wheel");
    say(wheel, state.wheel === "yours" ? "Give the wheel back" : state.wheel === "taken" ? "The wheel is taken" : "Take the wheel");
    wheel.setAttribute("aria-pressed", String(state.wheel === "yours"));
    $("recording").hidden = state.recorded === 0;
    say($("keep"), `Keep ${(state.recorded / STEPS_A_SECOND).toFixed(0)} s as a demonstration`);
    this.enable();
    this.showRoles(state);
  }

  pause(): void { this.send({ op: "pause", on: !this.state?.paused }); }
  step(): void { this.send({ op: "step" }); }
  reset(): void { this.send({ op: "reset" }); }
  wheel(): void { this.send({ op: "wheel", on: this.state?.wheel !== "yours" }); }
  giveBack(): void { if (this.state?.wheel === "yours") this.send({ op: "wheel", on: false }); }
  keep(): void { if (this.state?.recorded) this.send({ op: "keep" }); }
  drop(): void { if (this.state?.recorded) this.send({ op: "drop" }); }

  get isMine(): boolean { return this.state === undefined || this.state.operator === this.state.you; }

  private enable(): void {
    const isMine = this.isMine && !this.isLost;
    for (const it of $("controls").querySelectorAll<HTMLButtonElement>("button, select, input")) it.disabled = !isMine;
    $<HTMLButtonElement>("wheel").disabled = !isMine || this.state?.wheel === "taken";
  }

  private showRoles(state: State): void {
    const { you, operator, asking } = state, key = JSON.stringify([you, operator, asking]);
    if (key === this.shownRoles) return;
    this.shownRoles = key;
    const button = (text: string, on: boolean): HTMLElement => {
      const made = make("button", { type: "button", textContent: text });
      made.onclick = () => this.send({ op: "control", on });
      return made;
    };
    const box = $("roles");
    box.hidden = this.isMine && !asking.length;
    if (this.isMine) box.replaceChildren(`Page ${asking[0]} asks for control.`, button("Hand over", false), button("Keep it", true));
    else if (asking.includes(you)) box.replaceChildren(`You watch. Page ${operator} has been asked for control.`, button("Never mind", false));
    else box.replaceChildren(`You watch; page ${operator} is in control.`, button("Ask for control", true));
  }

  private load(values: Record<string, unknown>): void {
    this.send({ op: "load", ...values });
    remember(values as Record<string, string | number>);
  }
}

const namesIn = (select: HTMLSelectElement): string[] => [...select.options].map((it) => it.value);

/** Names to choose from; a list that is open is left alone where it has not changed. What is driven is there, whatever was deleted since. */
function fill(select: HTMLSelectElement, names: string[], chosen: string | undefined): void {
  const all = chosen === undefined ? names : [...new Set([...names, chosen])];
  if (String(all) !== String(namesIn(select))) options(select, all.map((it) => [it, it]), chosen ?? "");
}

/** Show what is driven, also where that came into the list since it was read. */
function choose(select: HTMLSelectElement, name: string): void {
  if (!namesIn(select).includes(name)) fill(select, namesIn(select), name);
  select.value = name;
}
