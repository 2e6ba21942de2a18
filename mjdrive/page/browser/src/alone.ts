// One recorded drive in a file of its own: the panels of the live page and the bar of its replays, without a server.
import { asked } from "./address";
import { $, say } from "./dom";
import { toggleHelp, type Keys as Help } from "./help";
import { Keys } from "./keys";
import { Live } from "./live";
import { note } from "./notes";
import { Replay } from "./replay";
import { inside, type Recording } from "./source";

const HELP: Help = [
  ["Space", "play or pause"], [", . or ← →", "a step back, a step on"], ["Backspace", "to the start"], ["C", "next camera"], ["?", "this list"],
];
const MORE = "Click a pin on the map or above the bar to go there; drag in the view to look around with the orbit camera.";

const recording: Recording = JSON.parse($("drive").textContent!), source = inside(recording);
const live = new Live(source, () => {}, (time) => replay.seek(time));
const replay = new Replay(source, live, note);
const help = (): void => toggleHelp(HELP, MORE);
const time = asked("t");

document.body.classList.add("alone");
say($("status"), "a recorded drive, all in this file");
$("help-open").onclick = help;
new Keys({ hold: () => {}, giveBack: () => {} }, {
  Space: () => replay.toggle(), Backspace: () => replay.stepBy(-Infinity),
  ".": () => replay.stepBy(1), ",": () => replay.stepBy(-1), ArrowRight: () => replay.stepBy(1), ArrowLeft: () => replay.stepBy(-1),
  c: () => live.nextCamera(), "?": help,
});
await replay.open(recording.title, time === null || Number.isNaN(Number(time)) ? undefined : Number(time));
Object.assign(window, { mjdrive: { live, replay } }); // for tests
