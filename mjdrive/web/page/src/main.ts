import "./style.css";
import { asked, remember } from "./address";
import { Controls } from "./controls";
import { $ } from "./dom";
import { Episodes } from "./episodes";
import { toggleHelp } from "./help";
import { Keys } from "./keys";
import { Link, type State } from "./link";
import { Live } from "./live";
import { Replay } from "./replay";
import { Runs } from "./runs";

const TABS = ["live", "episodes", "runs"] as const;
type Tab = (typeof TABS)[number];
const NOTE_MS = 6000;

const send = (command: object): void => link.send(command);
const live = new Live(send, (time) => replay.seek(time));
const controls = new Controls(send);
const replay = new Replay(live, note);
const episodes = new Episodes((name) => { choose("live"); void replay.open(name); }, (line) => note(line, true));
const runs = new Runs();
const slow = $<HTMLInputElement>("slow");
let state: State | undefined;

slow.checked = asked("link") === "slow";
slow.onchange = () => { sayLink(); remember({ link: slow.checked ? "slow" : null }); };

const link = new Link({
  message: (message) => live.hear(message),
  state: showState,
  note,
  scene: () => { if (!replay.isOpen) void loadScene(); },
  status: (line, isLive) => {
    $("status").textContent = line;
    document.body.classList.toggle("lost", !isLive);
    if (isLive && slow.checked) sayLink(); // each connection begins as a full one
  },
});

const keys = new Keys({ hold: (command) => link.hold(command), giveBack: () => controls.giveBack() }, {
  Space: () => (replay.isOpen ? replay.toggle() : controls.pause()),
  ".": () => (replay.isOpen ? replay.stepBy(1) : controls.step()), ",": () => { if (replay.isOpen) replay.stepBy(-1); },
  Backspace: () => (replay.isOpen ? replay.stepBy(-Infinity) : controls.reset()), Escape: () => { if (replay.isOpen) replay.close(); },
  t: () => controls.wheel(), Enter: () => controls.keep(), Delete: () => controls.drop(),
  c: () => live.nextCamera(), "?": toggleHelp, "1": () => choose("live"), "2": () => choose("episodes"), "3": () => choose("runs"),
});

function showState(told: State): void {
  const isFirst = !state;
  state = told;
  controls.show(told);
  live.setState(told);
  keys.setDriving(told.wheel === "yours");
  $("status").textContent = `live · page ${told.you}${told.pages > 1 ? ` of ${told.pages} open` : ""}`;
  if (isFirst) void controls.begin().catch((error: Error) => note(error.message, true));
}

function sayLink(): void { send({ op: "slow", on: slow.checked }); }

function note(line: string, isError: boolean): void {
  const box = $("note");
  box.hidden = false;
  box.classList.toggle("error", isError);
  box.firstElementChild!.textContent = line;
  clearTimeout(Number(box.dataset.timer));
  if (!isError) box.dataset.timer = String(setTimeout(() => (box.hidden = true), NOTE_MS));
}

function choose(tab: Tab): void {
  for (const it of TABS) {
    $(it).hidden = it !== tab;
    $(`tab-${it}`).setAttribute("aria-selected", String(it === tab));
  }
  remember({ tab: tab === "live" ? null : tab });
  const loading = tab === "episodes" ? episodes.load() : tab === "runs" ? runs.load() : undefined;
  loading?.catch((error: Error) => note(error.message, true));
  if (tab === "live") live.redraw();
}

async function loadScene(): Promise<void> {
  try {
    await live.loadScene();
  } catch (error) { note((error as Error).message, true); }
}

/** Go on with what is driven now. */
async function showLive(): Promise<void> {
  if (state && live.town !== state.town) await loadScene();
  if (state) live.setState(state);
  send({ op: "watch" });
}

for (const it of TABS) $(`tab-${it}`).onclick = () => choose(it);
$("help-open").onclick = toggleHelp;
$("note").querySelector("button")!.onclick = () => ($("note").hidden = true);
addEventListener("live-again", () => void showLive());
await loadScene();
const [tab, episode, time] = [TABS.find((it) => it === asked("tab")), asked("episode"), asked("t")];
if (tab) choose(tab);
if (episode) void replay.open(episode, time === null || Number.isNaN(Number(time)) ? undefined : Number(time));
// For tests: what has been drawn so far.
Object.assign(window, { mjdrive: { live, replay, state: () => state } });
