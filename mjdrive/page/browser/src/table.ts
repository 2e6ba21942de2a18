// Tables that can be sorted by a click on a heading.
import { make } from "./dom";

export interface Column<Row> { title: string; value(row: Row): string | number; show?(row: Row): string | Node; numeric?: boolean }

export function table<Row>(rows: Row[], columns: Column<Row>[], label: string): HTMLTableElement {
  const body = make("tbody"), headings = columns.map((column) => make("th", { scope: "col", className: column.numeric ? "number" : "" }));
  let by = -1, falls = false;
  const fill = (): void => {
    const sorted = by < 0 ? rows : [...rows].sort((one, other) => {
      const [a, b] = [columns[by].value(one), columns[by].value(other)];
      return (a < b ? -1 : a > b ? 1 : 0) * (falls ? -1 : 1);
    });
    body.replaceChildren(...sorted.map((row) => make("tr", {}, ...columns.map((column) =>
      make("td", { className: column.numeric ? "number" : "" }, column.show?.(row) ?? String(column.value(row)))))));
    headings.forEach((it, index) => (it.ariaSort = index !== by ? "none" : falls ? "descending" : "ascending"));
  };
  headings.forEach((heading, index) => {
    const button = make("button", { type: "button", textContent: columns[index].title });
    button.onclick = () => { falls = by === index && !falls; by = index; fill(); };
    heading.append(columns[index].title ? button : "");
  });
  fill();
  const element = make("table", {}, make("thead", {}, make("tr", {}, ...headings)), body);
  element.setAttribute("aria-label", label);
  return element;
}
