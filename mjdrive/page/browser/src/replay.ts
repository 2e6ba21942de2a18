// An episode on the live view's panels; the scrubber is this page's own, others go on watching what they watch.
import { remember } from "./address";
import type { Message } from "./codec";
import { $, make, options, say } from "./dom";
import { described, look } from "./infractions";
import type { Infraction } from "./link";
import type { Live } from "./live";
import { COLUMNS } from "./rows";
import type { Source } from "./source";

const STEP_MS = 100;
const SPEEDS = [0.5, 1, 2, 4];
const REMEMBER_STEPS = 10; // browsers stop pages that rewrite their address at every frame

export class Replay {
  private episode?: Message;
  private step = 0;
  private isPlaying = false;
  private lastFrame = 0;
  private due = 0;
  private isFetching = false;
  private readonly bar = make("input", { type: "range", min: "0", step: "1", value: "0", ariaLabel: "Time in the episode" });
  private readonly play = make("button", { type: "button", textContent: "Play", title: "Space" });
  private readonly factor = make("select", { ariaLabel: "Speed of the replay" });
  private readonly time = make("output", { className: "time", ariaLabel: "Time in the episode", ariaLive: "off" });
  private readonly marks = make("div", { className: "marks" });

  constructor(private readonly source: Source, private readonly live: Live, private readonly note: (line: string, isError: boolean) => void) {
    $("live-again").onclick = () => this.close();
    this.play.onclick = () => this.toggle();
    this.bar.oninput = () => this.go(Number(this.bar.value));
    options(this.factor, SPEEDS.map((it) => [String(it), `${it}×`]), "1");
    $("replay").append(this.play, this.factor, make("div", { className: "track" }, this.bar, this.marks), this.time);
  }

  get isOpen(): boolean { return this.episode !== undefined; }

  /** Show an episode from its start, or from a time [s]. */
  async open(name: string, from?: number): Promise<void> {
    try {
      const episode = await this.source.episode(name);
      if (episode.head.town !== this.live.town) await this.live.loadScene(episode.head.town);
      this.episode = episode;
    } catch (error) { remember({ episode: null, t: null }); return this.note((error as Error).message, true); }
    const { head, blobs } = this.episode;
    this.live.isReplaying = true;
    document.body.classList.add("replaying");
    $("replay").hidden = $("replaying").hidden = false;
    $("badge").hidden = $("fault").hidden = true;
    this.live.landscape.forget("An episode keeps what was seen and done, not what was thought.");
    this.live.map.setTrail(blobs.rows as Float32Array);
    this.live.charts.set(blobs.rows);
    this.live.setInfractions(head.infractions as Infraction[]);
    say($("replay-title"), `${head.policy} in ${head.town}, seed ${head.seed}`);
    $("replay-title").title = head.name;
    this.bar.max = String(this.length - 1);
    this.mark(head.infractions as Infraction[]);
    remember({ episode: name });
    if (from === undefined) this.go(0);
    else this.seek(from);
    if (from === undefined) this.play.focus(); // what was clicked has gone
  }

  close(): void {
    this.episode = undefined;
    this.isPlaying = this.live.isReplaying = false;
    document.body.classList.remove("replaying");
    $("replay").hidden = $("replaying").hidden = true;
    $("badge").hidden = false;
    say(this.play, "Play");
    this.live.landscape.forget();
    this.live.charts.now = [];
    remember({ episode: null, t: null });
    dispatchEvent(new Event("live-again"));
  }

  toggle(): void {
    if (!this.isOpen) return;
    this.isPlaying = !this.isPlaying;
    if (this.isPlaying && this.step >= this.length - 1) this.step = 0;
    say(this.play, this.isPlaying ? "Pause" : "Play");
    this.lastFrame = performance.now();
    if (this.isPlaying) requestAnimationFrame(this.frame);
    else this.rememberTime();
  }

  /** Go to a time [s] of the episode. */
  seek(time: number): void {
    if (this.isOpen) this.go(Math.round((time - this.row(0)[0]) * 1000 / STEP_MS));
  }

  stepBy(steps: number): void { if (this.isOpen) this.go(this.step + steps); }

  private get length(): number { return this.episode!.blobs.rows.length / COLUMNS; }

  private row(step: number): Float32Array { return (this.episode!.blobs.rows as Float32Array).subarray(COLUMNS * step, COLUMNS * (step + 1)); }

  private frame = (time: number): void => {
    if (!this.isPlaying || !this.isOpen) return;
    this.due += Number(this.factor.value) * (time - this.lastFrame) / STEP_MS;
    this.lastFrame = time;
    const steps = Math.floor(this.due);
    this.due -= steps;
    if (steps) this.go(this.step + steps);
    if (this.step >= this.length - 1) this.toggle();
    else requestAnimationFrame(this.frame);
  };

  private go(step: number): void {
    this.step = Math.min(Math.max(step, 0), this.length - 1);
    const row = this.row(this.step), pose = this.slice("poses") as Float32Array, lights = this.slice("lights") as Uint8Array;
    this.bar.value = String(this.step);
    this.bar.ariaValueText = `${row[0].toFixed(1)} s`;
    this.live.view?.setPose(pose, !this.isPlaying);
    this.live.view?.town?.showLights(lights);
    this.live.showMotion(row[0], row[3], row[4], row[5]);
    this.live.map.setLights(lights);
    this.live.map.move(row[1], row[2], yaw(pose), (this.step + 1) / this.length);
    this.live.map.draw();
    this.live.charts.now = row;
    this.live.charts.draw();
    say(this.time, `${row[0].toFixed(1)} s`);
    for (const panel of ["map", "charts"]) say($(`${panel}-tick`), `step ${this.step}`);
    if (!this.isPlaying || this.step % REMEMBER_STEPS === 0) this.rememberTime();
    void this.fetchView();
  }

  private rememberTime(): void { if (this.isOpen) remember({ t: this.row(this.step)[0].toFixed(1) }); }

  /** What belongs to the step that is shown. */
  private slice(name: "poses" | "lights"): ArrayLike<number> {
    const all = this.episode!.blobs[name], each = all.length / this.length;
    return all.subarray(each * this.step, each * (this.step + 1));
  }

  /** Fetch what the policy saw here; while one is on its way, the next waits. */
  private async fetchView(): Promise<void> {
    if (this.isFetching || !this.episode) return;
    this.isFetching = true;
    const wanted = this.step, { name } = this.episode.head;
    try {
      const { blobs, shapes } = await this.source.view(name, wanted);
      if (this.isOpen) { this.live.bev.show(blobs.bev, shapes.bev[1]); say($("bev-tick"), `step ${wanted}`); }
    } catch (error) { this.note((error as Error).message, true); } finally { this.isFetching = false; }
    if (this.isOpen && this.step !== wanted) void this.fetchView();
  }

  private mark(infractions: Infraction[]): void {
    const first = this.row(0)[0], last = this.row(this.length - 1)[0];
    this.marks.replaceChildren(...infractions.map((it) => {
      const [letter, color] = look(it[0]), words = described(it);
      const mark = make("button", { type: "button", textContent: letter, title: words, ariaLabel: `Go to ${words}` });
      mark.style.left = `${100 * (it[1] - first) / Math.max(last - first, 0.1)}%`;
      mark.style.background = color;
      mark.onclick = () => this.seek(it[1]);
      return mark;
    }));
  }
}

/** Heading of the car: its body's quaternion is turned about the vertical. */
const yaw = (pose: Float32Array): number => 2 * Math.atan2(pose[6], pose[3]);
