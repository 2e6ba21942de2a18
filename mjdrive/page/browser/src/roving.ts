// Tabs and radios: the Tab key stops at the chosen one, arrow keys go on to the next and choose it.

type Move = (at: number, count: number) => number;
const on: Move = (at, count) => (at + 1) % count, back: Move = (at, count) => (at + count - 1) % count;
const MOVES: Record<string, Move> = {
  ArrowRight: on, ArrowDown: on, ArrowLeft: back, ArrowUp: back, Home: () => 0, End: (_, count) => count - 1,
};

const items = (group: HTMLElement): HTMLElement[] => [...group.querySelectorAll<HTMLElement>("[role=tab], [role=radio]")];

/** Let arrow keys go through a group. */
export function rove(group: HTMLElement): void {
  group.addEventListener("keydown", (event) => {
    const all = items(group), at = all.indexOf(event.target as HTMLElement), move = MOVES[event.key];
    if (at < 0 || !move || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const next = all[move(at, all.length)];
    next.focus();
    next.click();
  });
}

/** Say which one of a group is chosen. */
export function markChosen(group: HTMLElement, isChosen: (item: HTMLElement) => boolean): void {
  for (const it of items(group)) {
    it.setAttribute(it.role === "tab" ? "aria-selected" : "aria-checked", String(isChosen(it)));
    it.tabIndex = isChosen(it) ? 0 : -1;
  }
}
