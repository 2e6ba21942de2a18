// The page of a server: what is driven now, episodes and runs.
import { asked, askedTime, remember } from "./address";
import { Controls } from "./controls";
import { $ } from "./dom";
import { Episodes } from "./episodes";
import { toggleHelp } from "./help";
import { Keys } from "./keys";
import { Link, type State } from "./link";
import { Live } from "./live";
import { note } from "./notes";
import { Replay } from "./replay";
import { markChosen, rove } from "./roving";
import { Runs } from "./runs";
import { SERVER } from "./source";

const TABS = ["live", "episodes", "runs"] as const;
type Tab = (typeof TABS)[number];
const MOST_LOADS = 3; // of scenes in a row, where what is driven changes meanwhile

const send = (command: object): void => link.send(command);
const live = new Live(SERVER, send, (time) => replay.seek(time));
const controls = new Controls(send);
const replay = new Replay(SERVER, live, note);
const episodes = new Episodes((name) => { controls.giveBack(); choose("live"); void replay.open(name); }, (line) => note(line, true));
const runs = new Runs();
const slow = $<HTMLInputElement>("slow");
let state: State | undefined;
let loading: Promise<void> | undefined;
let wasLost = false;

remember({}); // no token
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
    if (!isLive) { wasLost = true; controls.setLost(); live.setLost(); keys.setDriving(false); }
    else if (slow.checked) sayLink(); // each connection begins as a full one
  },
});

const keys = new Keys({ hold: (command) => link.hold(command), giveBack: () => controls.giveBack() }, {
  Space: () => (replay.isOpen ? replay.toggle() : controls.pause()),
  ".": () => (replay.isOpen ? replay.stepBy(1) : controls.step()), ",": () => { if (replay.isOpen) replay.stepBy(-1); },
  Backspace: () => (replay.isOpen ? replay.stepBy(-Infinity) : controls.reset()), Escape: () => { if (replay.isOpen) replay.close(); },
  t: () => { if (!replay.isOpen) controls.wheel(); },
  Enter: () => { if (!replay.isOpen) controls.keep(); }, Delete: () => { if (!replay.isOpen) controls.drop(); },
  c: () => live.nextCamera(), "?": () => toggleHelp(), "1": () => choose("live"), "2": () => choose("episodes"), "3": () => choose("runs"),
});

function showState(told: State): void {
  const isFirst = !state;
  state = told;
  controls.show(told);
  live.setState(told);
  keys.setDriving(told.wheel === "yours");
  $("status").textContent = `live · page ${told.you}${told.pages > 1 ? ` of ${told.pages} open` : ""}`;
  remember({ town: told.town, policy: told.policy, seed: told.seed, speed: told.speed === 1 ? null : told.speed });
  if (isFirst) controls.begin().catch(complain);
  // The server may have been started anew, with another town and other runs.
  if (live.town !== told.town && !replay.isOpen) void loadScene();
  if (wasLost) { wasLost = false; refresh(); }
}

const complain = (error: Error): void => note(error.message, true);

/** What can be chosen, as it is by now. */
function refresh(): void { controls.refresh().catch(complain); }

function sayLink(): void { send({ op: "slow", on: slow.checked }); }

function choose(tab: Tab): void {
  for (const it of TABS) $(it).hidden = it !== tab;
  markChosen($("tabs"), (it) => it.id === `tab-${tab}`);
  remember({ tab: tab === "live" ? null : tab });
  const reading = tab === "episodes" ? episodes.load() : tab === "runs" ? runs.load() : undefined;
  reading?.catch(complain);
  if (tab !== "live") return;
  live.redraw();
  if (state) refresh();
}

/** Load the scene of what is driven, once at a time. */
function loadScene(): Promise<void> {
  return (loading ??= fetchScene().catch(complain).finally(() => (loading = undefined)));
}

async function fetchScene(): Promise<void> {
  for (let count = 0; count < MOST_LOADS; count++) {
    await live.loadScene();
    if (!state || replay.isOpen || live.town === state.town) return;
  }
}

/** Go on with what is driven now. */
async function showLive(): Promise<void> {
  if (state && live.town !== state.town) await loadScene();
  if (state) live.setState(state);
  send({ op: "watch" });
}

for (const it of TABS) $(`tab-${it}`).onclick = () => choose(it);
for (const it of ["town", "policy"]) $(it).onfocus = refresh;
rove($("tabs"));
markChosen($("tabs"), (it) => it.id === "tab-live");
$("help-open").onclick = () => toggleHelp();
addEventListener("live-again", () => void showLive());
await loadScene();
const tab = TABS.find((it) => it === asked("tab")), episode = asked("episode");
if (tab) choose(tab);
if (episode) void replay.open(episode, askedTime());
// For tests: what has been drawn so far.
Object.assign(window, { mjdrive: { live, replay, state: () => state } });
