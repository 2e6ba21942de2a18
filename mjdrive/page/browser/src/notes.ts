// A line for people, at the top of the page; errors stay until they are dismissed.
import { $ } from "./dom";

const NOTE_MS = 6000;

export function note(line: string, isError: boolean): void {
  const box = $("note");
  box.hidden = false;
  box.classList.toggle("error", isError);
  box.firstElementChild!.textContent = line;
  clearTimeout(Number(box.dataset.timer));
  if (!isError) box.dataset.timer = String(setTimeout(() => (box.hidden = true), NOTE_MS));
}

$("note").querySelector("button")!.onclick = () => ($("note").hidden = true);
