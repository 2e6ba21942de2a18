// What the keys do.
import { $, make } from "./dom";

export type KeyList = [names: string, what: string][];

const DRIVING: KeyList = [
  ["T", "take the wheel, or give it back"], ["W A S D or arrows", "drive, while you have the wheel"], ["Shift", "brake hard"],
  ["Enter Delete", "keep what you drove as a demonstration, or drop it"], ["Space", "pause or go on"], [".", "one decision"],
  ["Backspace", "start the drive again"], [", . Escape", "in a replay: a step back, a step on, back to live"],
  ["C", "next camera"], ["1 2 3", "live, episodes, runs"], ["?", "this list"],
];
const MORE = "While it is paused, click the landscape to take that action for one step, or focus it and use the arrow keys and Enter. A gamepad drives, too: left stick and triggers. The wheel goes back by itself when the page loses the focus.";

/** Open or close the list of keys, those of the live page if none are given. */
export function toggleHelp(keys: KeyList = DRIVING, more = MORE): void {
  const dialog = $<HTMLDialogElement>("help");
  if (!dialog.childElementCount) {
    const list = make("dl", {}, ...keys.flatMap(([names, what]) => [make("dt", {}, ...names.split(" ").map((it) => (it === "or" ? " or " : make("kbd", { textContent: it })))), make("dd", { textContent: what })]));
    const close = make("button", { textContent: "Close" });
    close.onclick = () => dialog.close();
    dialog.append(make("h2", { id: "help-title", textContent: "Keyboard" }), list,
      make("p", { className: "quiet", textContent: more }), close);
  }
  if (dialog.open) dialog.close();
  else dialog.showModal();
}
