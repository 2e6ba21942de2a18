// The episodes tab: what was driven, by whom, and how; a click replays it in the live view.
import { asked, remember } from "./address";
import { fetchJson } from "./codec";
import { $, make } from "./dom";
import { table } from "./table";

interface Episode {
  name: string; error?: string; town: string; policy: string; seed: number; source: string;
  steps: number; duration: number; distance: number; infractions: number;
}

export class Episodes {
  private rows: Episode[] = [];
  private readonly filter = make("input", { type: "search", placeholder: "Filter by town, policy, name …", ariaLabel: "Filter episodes" });
  private readonly list = make("div", { className: "scroll" });

  constructor(private readonly replay: (name: string) => void, private readonly note: (line: string) => void) {
    this.filter.value = asked("filter") ?? "";
    this.filter.oninput = () => { remember({ filter: this.filter.value.trim() }); this.show(); };
    $("episodes").append(make("div", { className: "bar" }, make("h2", { textContent: "Episodes" }), this.filter), this.list);
  }

  async load(): Promise<void> {
    if (!this.rows.length) this.list.replaceChildren(make("p", { className: "quiet", textContent: "Reading …" }));
    this.rows = await fetchJson<Episode[]>("api/episodes");
    this.show();
  }

  private show(): void {
    const words = this.filter.value.toLowerCase().split(/\s+/);
    const whole = this.rows.filter((it) => !it.error), broken = this.rows.filter((it) => it.error);
    const found = whole.filter((it) => words.every((word) => `${it.name} ${it.town} ${it.policy} ${it.source}`.toLowerCase().includes(word)));
    if (!this.rows.length) {
      this.list.replaceChildren(make("div", { className: "empty" }, make("strong", { textContent: "No episode yet." }),
        " Drives of ", make("code", { textContent: "mjdrive drive" }), ", demonstrations of ", make("code", { textContent: "mjdrive collect" }), " and what you drive here by hand are listed on this tab."));
      return;
    }
    this.list.replaceChildren(this.table(found), make("p", { className: "quiet", textContent: `${found.length} of ${whole.length} episodes` }),
      ...(broken.length ? [unreadable(broken)] : []));
  }

  private table(found: Episode[]): Node {
    if (!found.length) return make("div", { className: "empty" }, "No episode has all of these words.");
    return table(found, [
      { title: "Episode", value: (it) => it.name, show: (it) => this.link(it) },
      { title: "Town", value: (it) => it.town }, { title: "Policy", value: (it) => it.policy },
      { title: "Source", value: (it) => it.source, show: (it) => make("span", { className: `chip ${it.source}`, textContent: it.source }) },
      { title: "Seed", value: (it) => it.seed, numeric: true },
      { title: "Time [s]", value: (it) => it.duration, show: (it) => it.duration.toFixed(1), numeric: true },
      { title: "Distance [m]", value: (it) => it.distance, show: (it) => it.distance.toFixed(0), numeric: true },
      { title: "Infractions", value: (it) => it.infractions, show: (it) => (it.infractions ? make("strong", { textContent: String(it.infractions) }) : "0"), numeric: true },
      { title: "", value: () => "", show: (it) => make("span", { className: "actions" }, exporter(it), this.deleter(it)) },
    ], "Episodes");
  }

  private link({ name }: Episode): Node {
    const button = make("button", { type: "button", className: "link", textContent: name, title: "Replay" });
    button.onclick = () => this.replay(name);
    return button;
  }

  private deleter({ name }: Episode): Node | string {
    if (!name.startsWith("drives/")) return "";
    const button = make("button", { type: "button", className: "danger", textContent: "Delete", ariaLabel: `Delete ${name}` });
    button.onclick = async () => {
      if (!confirm(`Delete ${name} for good?`)) return;
      try {
        await fetchJson(`api/episode/delete?name=${encodeURIComponent(name)}`, true);
        await this.load();
      } catch (error) { this.note((error as Error).message); }
    };
    return button;
  }
}

/** The file itself, under a name that says where it comes from. */
const exporter = ({ name }: Episode): Node =>
  make("a", { className: "link", textContent: "Export", ariaLabel: `Export ${name}`, href: `api/episode/file?name=${encodeURIComponent(name)}`, download: `${name.replaceAll("/", "-")}.hdf5` });

const unreadable = (broken: Episode[]): Node =>
  make("details", { className: "quiet" }, make("summary", { textContent: `${broken.length} ${broken.length > 1 ? "files" : "file"} cannot be read` }),
    make("ul", {}, ...broken.map((it) => make("li", {}, make("strong", { textContent: it.name }), ` ${it.error}`))));
