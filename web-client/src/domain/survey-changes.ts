// What became of the classes of a layer between two surveys, as a table, and the statistics of a
// layer in all surveys of an object.

import type {
  LayerChanges,
  Survey,
  SurveyLayerStatistics,
  SurveyStatistics,
} from "../core/protocol.gen";
import type { Model } from "../core/types";
import { metresPer } from "./measure";

/** A class, or null where nothing is painted, or the surface without a counterpart. */
export type ChangeKey = number | null | "unmatched";

export interface ChangeTable {
  rows: ChangeKey[]; // in the earlier survey
  columns: ChangeKey[]; // in the later survey
  areaM2: number[][]; // by row, then by column
}

/**
 * Adds the areas without a counterpart to the table. The last row contains the painted areas of the
 * later survey that the earlier survey does not cover, and the last column the reverse.
 */
export function changeTable(changes: LayerChanges): ChangeTable {
  const { table, unmatched_now: fresh, unmatched_then: lost } = changes;
  const keys = (
    known: readonly (number | null)[],
    more: readonly { value: number }[],
    unmatched: boolean,
  ): ChangeKey[] => {
    const values = [
      ...new Set([
        ...known.filter((key): key is number => key !== null),
        ...more.map(({ value }) => value),
      ]),
    ].sort((a, b) => a - b);
    return [
      ...values,
      ...(known.includes(null) ? [null] : []),
      ...(unmatched ? ["unmatched" as const] : []),
    ];
  };
  const rows = keys(table.rows, lost, fresh.length > 0);
  const columns = keys(table.columns, fresh, lost.length > 0);
  const areaOf = (list: LayerChanges["unmatched_now"], key: ChangeKey): number =>
    list.find(({ value }) => value === key)?.area_m2 ?? 0;
  const area = (row: ChangeKey, column: ChangeKey): number => {
    if (row === "unmatched") return areaOf(fresh, column);
    if (column === "unmatched") return areaOf(lost, row);
    return table.area_m2[table.rows.indexOf(row)]?.[table.columns.indexOf(column)] ?? 0;
  };
  return { rows, columns, areaM2: rows.map((row) => columns.map((column) => area(row, column))) };
}

export const sumOf = (numbers: readonly number[]): number =>
  numbers.reduce((sum, each) => sum + each, 0);

/** Returns the earlier and the later of two surveys of an object, whose surveys are sorted. */
export function inOrder(all: readonly Survey[], a: Survey, b: Survey): [Survey, Survey] {
  const place = ({ model }: Survey): number => all.findIndex((each) => each.model === model);
  return place(a) <= place(b) ? [a, b] : [b, a];
}

/** Guesses how far two scans differ: 1/500 of the object's size, in millimeters. */
export function likelyToleranceMm(model: Pick<Model, "bounds" | "unit">): number {
  const { min, max } = model.bounds;
  const diagonal = Math.hypot(...[0, 1, 2].map((axis) => max[axis]! - min[axis]!));
  return Number(((diagonal * metresPer(model.unit) * 1000) / 500).toPrecision(2));
}

/** A class of the surveys. Classes with the same name are the same class. */
export interface NamedClass {
  name: string;
  key: number; // in the earliest survey with this class
}

/** Returns the classes that occur in any survey: the largest first, and not more than `most`. */
export function classesOf(all: readonly SurveyStatistics[], most: number): NamedClass[] {
  const found = new Map<string, NamedClass & { area: number }>();
  for (const { statistics } of all)
    for (const { class: name, key } of statistics?.classes ?? []) {
      const known = found.get(name) ?? { name, key, area: 0 };
      const area = Math.max(known.area, classArea(statistics!, name) ?? 0);
      found.set(name, { ...known, area });
    }
  return [...found.values()]
    .sort((a, b) => b.area - a.area || a.key - b.key)
    .slice(0, most)
    .map(({ name, key }) => ({ name, key }));
}

/** Returns the area of a class in a survey. Undefined if the server lists no classes. */
export const classArea = ({ classes }: SurveyLayerStatistics, name: string): number | undefined =>
  classes && sumOf(classes.filter((each) => each.class === name).map(({ area_m2: area }) => area));

/** Returns the time of a date such as 2019, 2019-05 or 2019-05-01, in milliseconds. */
export const timeOf = (date: string): number => {
  const [year, month = 1, day = 1] = date.split("-").map(Number);
  return Date.UTC(year!, month - 1, day);
};

/** A curve over dates. Null: no value, so that the curve has a gap. */
export interface DatedCurve {
  color: string;
  values: readonly (number | null)[];
}

export interface DatedPlot {
  paths: { color: string; d: string; points: [number, number][] }[];
  least: number; // the value at the lower edge
  most: number; // the value at the upper edge
}

/** Returns the curves in a window of pixels. The vertical axis begins at 0 or below. */
export function datedPlot(
  dates: readonly string[],
  curves: readonly DatedCurve[],
  width: number,
  height: number,
): DatedPlot {
  const times = dates.map(timeOf);
  const [first, last] = [Math.min(...times), Math.max(...times)];
  const known = curves.flatMap(({ values }) => values).filter((value) => value !== null);
  const most = Math.max(0, ...known);
  const least = Math.min(0, ...known);
  const x = (time: number): number =>
    last > first ? ((time - first) / (last - first)) * width : width / 2;
  const y = (value: number): number =>
    most > least ? height - ((value - least) / (most - least)) * height : height;
  const paths = curves.map(({ color, values }) => {
    let d = "";
    const points: [number, number][] = [];
    values.forEach((value, i) => {
      if (value === null) return;
      const point: [number, number] = [x(times[i]!), y(value)];
      d += `${i > 0 && values[i - 1] !== null ? "L" : "M"}${point.map((at) => at.toFixed(1)).join(" ")}`;
      points.push(point);
    });
    return { color, d, points };
  });
  return { paths, least, most };
}
