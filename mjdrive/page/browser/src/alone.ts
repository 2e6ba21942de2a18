// One recorded drive in a file of its own: the panels of the live page and the bar of its replays, without a server.
import { askedTime } from "./address";
import { $, say } from "./dom";
import { toggleHelp, type KeyList } from "./help";
import { Keys } from "./keys";
import { Live } from "./live";
import { note } from "./notes";
import { Replay } from "./replay";
import { inside, type Recording } from "./source";

const KEYS: KeyList = [
  ["Space", "play or pause"], [", . or ← →", "a step back, a step on"], ["Backspace", "to the start"], ["C", "next camera"], ["?", "this list"],
];
const MORE = "Click a pin on the map or above the bar to go there; drag in the view to look around with the orbit camera.";

const recording: Recording = JSON.parse($("drive").textContent!), source = inside(recording);
$("drive").remove(); // one copy is enough
const live = new Live(source, () => {}, (time) => replay.seek(time));
const replay = new Replay(source, live, note);
const help = (): void => toggleHelp(KEYS, MORE);

document.body.classList.add("alone");
say($("status"), "a recorded drive, all in this file");
$("help-open").onclick = help;
new Keys({ hold: () => {}, giveBack: () => {} }, {
  Space: () => replay.toggle(), Backspace: () => replay.stepBy(-Infinity),
  ".": () => replay.stepBy(1), ",": () => replay.stepBy(-1), ArrowRight: () => replay.stepBy(1), ArrowLeft: () => replay.stepBy(-1),
  c: () => live.nextCamera(), "?": help,
});
await replay.open("", askedTime() ?? 0); // with a time it leaves the focus alone: the page may be a frame of another one
Object.assign(window, { mjdrive: { live, replay } }); // for tests
