// How the drives of each policy went, side by side: one row a policy and town, mean and spread over its drives.
import { make } from "./dom";
import { table, type Column } from "./table";

export type Drive = Record<string, any>;
interface Evaluation { policy: string; town: string; drives: Drive[]; km: number }

const KINDS: [key: string, title: string][] = [
  ["red_lights", "Red lights"], ["collisions", "Collisions"], ["kerb_strikes", "Kerbs"],
  ["road_departures", "Off road"], ["wrong_ways", "Wrong way"], ["standstills", "Stuck"],
];

export function evaluationTable(drives: Drive[]): Node {
  if (!drives.length) {
    return make("div", { className: "empty" }, make("strong", { textContent: "No drive yet." }), " ", make("code", { textContent: "mjdrive drive --policy da-ibc --episodes 5" }), " makes some.");
  }
  const columns: Column<Evaluation>[] = [
    { title: "Policy", value: (it) => it.policy }, { title: "Town", value: (it) => it.town },
    { title: "Drives", value: (it) => it.drives.length, numeric: true },
    { title: "Flawless", value: (it) => it.drives.filter(isFlawless).length / it.drives.length, show: (it) => `${it.drives.filter(isFlawless).length} of ${it.drives.length}`, numeric: true },
    { title: "Score", value: (it) => mean(scores(it)), show: (it) => spread(scores(it)), numeric: true },
    { title: "Distance [m]", value: (it) => mean(it.drives.map((one) => one.distance_m)), show: (it) => spread(it.drives.map((one) => one.distance_m)), numeric: true },
    ...KINDS.map(([key, title]) => ({
      title: `${title} [1/km]`, numeric: true, value: (it: Evaluation) => perKm(it, key),
      show: (it: Evaluation) => { const rate = perKm(it, key); return Number.isNaN(rate) ? "–" : rate ? make("strong", { textContent: rate.toFixed(2) }) : "0"; },
    })),
  ];
  return table(grouped(drives), columns, "Evaluation of drives");
}

function grouped(drives: Drive[]): Evaluation[] {
  const groups = new Map<string, Evaluation>();
  for (const drive of drives) {
    const key = `${drive.policy} ${drive.town}`;
    const group: Evaluation = groups.get(key) ?? { policy: drive.policy, town: drive.town, drives: [], km: 0 };
    group.drives.push(drive);
    group.km += drive.distance_m / 1000;
    groups.set(key, group);
  }
  return [...groups.values()].sort((a, b) => (a.town + a.policy < b.town + b.policy ? -1 : 1));
}

const scores = (it: Evaluation): number[] => it.drives.map((one) => one.score);
const isFlawless = (drive: Drive): boolean => KINDS.every(([key]) => !drive[key]);
const perKm = (it: Evaluation, key: string): number =>
  it.drives.some((one) => one[key] === undefined) || !it.km ? NaN : it.drives.reduce((sum, one) => sum + one[key], 0) / it.km;
const mean = (values: number[]): number => values.reduce((sum, it) => sum + it, 0) / values.length;

function spread(values: number[]): string {
  const middle = mean(values);
  if (values.length < 2) return middle.toFixed(0);
  const deviation = Math.sqrt(values.reduce((sum, it) => sum + (it - middle) ** 2, 0) / (values.length - 1));
  return `${middle.toFixed(0)} ± ${deviation.toFixed(0)}`;
}
