// The live tab: what the server tells goes to the panels, what people want goes to the server.
import { asked, remember } from "./address";
import { BevPanel } from "./bev";
import { CAMERAS, type CameraName } from "./cameras";
import { ChartsPanel } from "./charts";
import type { Message } from "./codec";
import { $, COLORS, make, say } from "./dom";
import { showCounts } from "./infractions";
import { LandscapePanel } from "./landscape";
import type { Infraction, State } from "./link";
import { MapPanel } from "./map";
import { markChosen, rove } from "./roving";
import { endOf, rowsAfter } from "./rows";
import type { Source } from "./source";
import { View } from "./view";

const DRAW_MS = 100;
const ENOUGH = 0.95; // of the speed that is asked for; below it the simulation is late

export class Live {
  readonly bev = new BevPanel();
  readonly charts = new ChartsPanel();
  readonly landscape: LandscapePanel;
  readonly map: MapPanel;
  readonly view: View | null;
  panels = 0;
  poses = 0;
  town = "";
  isReplaying = false;
  private speed = 1;
  private latest?: Message; // the panel message that the panels show, or will show next
  private toldUntil = -Infinity; // time of the last step in charts and trail [s]
  private isDrawDue = false;
  private drawnAt = 0;
  private shownInfractions = "";

  constructor(private readonly source: Source, send: (command: object) => void, seek: (time: number) => void) {
    this.landscape = new LandscapePanel((acceleration, steering) => { if (!this.isReplaying) send({ op: "force", acceleration, steering }); });
    this.map = new MapPanel(seek);
    this.view = this.openView();
    this.addCameras();
    new ResizeObserver(() => this.redraw()).observe($("panels"));
  }

  /** Load the scene that is driven, or that of a town that is only looked at. */
  async loadScene(town?: string): Promise<void> {
    const scene = await this.source.scene(town);
    this.town = scene.head.town;
    this.view?.setTown(scene);
    this.map.setTown(scene);
    this.bev.setCar(scene.head.footprint);
    this.map.draw();
  }

  hear(message: Message): void {
    if (this.isReplaying) return;
    if (message.kind === "pose") this.hearPose(message);
    else if (message.kind === "panel") this.hearPanel(message);
    else if (message.kind === "history") {
      const rows = message.blobs.rows as Float32Array;
      this.map.setTrail(rows);
      this.charts.set(rows);
      // Told again because somebody else has come, it is the drive that is shown.
      if (!rows.length || endOf(rows) < this.toldUntil) {
        this.landscape.forget();
        this.charts.now = [];
        this.latest = undefined;
      }
      this.toldUntil = endOf(rows);
    }
  }

  setState(state: State): void {
    this.speed = state.speed;
    if (this.isReplaying) return;
    this.landscape.isPaused = state.paused;
    this.setInfractions(state.infractions);
    const yours = state.wheel === "yours", badge = $("badge");
    const who = yours ? "You drive" : state.wheel === "taken" ? `Page ${state.driver} drives` : `${state.policy} drives`;
    say($("who"), state.paused ? `${who} · paused` : who);
    say($("recorded"), yours && state.recorded ? ` · ${(state.recorded / 10).toFixed(0)} s recorded` : "");
    badge.classList.toggle("yours", yours);
    badge.classList.toggle("theirs", state.wheel === "taken");
    $("fault").hidden = !state.fault;
    say($("fault"), state.fault ? `The drive has stopped. ${state.fault}` : "");
  }

  /** Until the server is there again, nobody knows who drives. */
  setLost(): void {
    say($("who"), "No connection");
    say($("recorded"), "");
    $("badge").classList.remove("yours", "theirs");
  }

  setInfractions(infractions: Infraction[]): void {
    const key = JSON.stringify(infractions);
    if (key === this.shownInfractions) return;
    this.shownInfractions = key;
    this.map.setInfractions(infractions);
    this.map.draw();
    showCounts(infractions, (it) => this.map.pick(it));
  }

  showMotion(time: number, speed: number, acceleration: number, steering: number): void {
    say($("clock"), `${time.toFixed(1)} s`);
    say($("kmh"), Math.abs(speed * 3.6).toFixed(0));
    bar($("steer-bar"), -steering);
    bar($("pedal-bar"), acceleration);
    $("pedal-bar").style.background = acceleration >= 0 ? COLORS.acceleration : COLORS.car;
  }

  chooseCamera(name: CameraName): void {
    this.view?.choose(name);
    markChosen($("cameras"), (it) => it.textContent === name);
    remember({ camera: name === "chase" ? null : name });
  }

  nextCamera(): void {
    if (this.view) this.chooseCamera(CAMERAS[(CAMERAS.indexOf(this.view.cameras.name) + 1) % CAMERAS.length]);
  }

  redraw(): void { this.landscape.draw(); this.map.draw(); this.charts.draw(); }

  private hearPose({ head, blobs }: Message): void {
    this.poses++;
    this.view?.setPose(blobs.q as Float32Array);
    this.showMotion(head.t, head.speed, head.action[0], head.action[1]);
    this.landscape.isLate = head.rate < ENOUGH * this.speed;
    say($("rate"), `${head.rate.toFixed(2)}× real time`);
  }

  private hearPanel(message: Message): void {
    const fresh = rowsAfter(message.blobs.rows as Float32Array, this.toldUntil);
    this.panels++;
    this.toldUntil = Math.max(this.toldUntil, endOf(fresh));
    this.charts.add(fresh);
    this.map.extendTrail(fresh);
    this.view?.town?.showLights(message.blobs.lights as Uint8Array);
    this.latest = message;
    this.showSoon();
  }

  /** Ten times a second at most, and always the last. */
  private showSoon(): void {
    if (this.isDrawDue) return;
    this.isDrawDue = true;
    setTimeout(() => {
      this.isDrawDue = false;
      if (this.latest && !this.isReplaying) this.showDecision(this.latest);
    }, Math.max(0, this.drawnAt + DRAW_MS - performance.now()));
  }

  /** All panels at once, so that they belong to one decision. */
  private showDecision(message: Message): void {
    const { head, blobs, shapes } = message, isOpen = head.driven === null;
    this.drawnAt = performance.now();
    this.bev.show(blobs.bev, shapes.bev[1]);
    this.landscape.show(message);
    this.map.setLights(blobs.lights);
    this.map.move(head.x, head.y, head.yaw);
    this.map.draw();
    const commands = isOpen && head.by !== "hand" ? head.action : head.driven;
    this.charts.now = [head.t, head.x, head.y, head.speed, ...(commands ?? [NaN, NaN])];
    this.charts.draw();
    for (const panel of ["bev", "map", "charts"]) say($(`${panel}-tick`), `tick ${head.tick}`);
  }

  private openView(): View | null {
    try {
      return new View($<HTMLCanvasElement>("gl"), asked("noaa") === null);
    } catch {
      $("gl").hidden = $("cameras").hidden = true;
      $("no-gl").hidden = false;
      document.body.classList.add("flat");
      return null;
    }
  }

  private addCameras(): void {
    $("cameras").append(...CAMERAS.map((name) => {
      const button = make("button", { type: "button", textContent: name, role: "radio" });
      button.onclick = () => this.chooseCamera(name);
      return button;
    }));
    rove($("cameras"));
    this.chooseCamera(CAMERAS.find((it) => it === asked("camera")) ?? "chase");
  }
}

/** A bar from the middle; -1 to the left, 1 to the right. */
function bar(element: HTMLElement, value: number): void {
  element.style.left = `${50 + 50 * Math.min(value, 0)}%`;
  element.style.width = `${50 * Math.abs(value)}%`;
}
