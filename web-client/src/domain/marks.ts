// Lines and points of records on models. Cells of line and point columns store them.

import { formatPlace, typedNumber } from "../core/locale";
import { formatLength, metresPer } from "./measure";
import type { CellValue, Column, Mark, MarkPlace, Table } from "../core/protocol.gen";
import type { Model } from "../core/types";
import { dot, length, scale, subtract } from "../math/vector";

export type MarkKind = "line" | "point";

export const holdsMarks = (column: Pick<Column, "kind">): boolean =>
  column.kind === "line" || column.kind === "point";
export const markColumns = (table: Pick<Table, "columns">, kind: MarkKind): Column[] =>
  table.columns.filter((column) => column.kind === kind);

export const isListOfMarks = (value: CellValue | undefined): value is Mark[] =>
  Array.isArray(value) && typeof value[0] === "object";

/** Returns the marks in a cell. Values of other kinds have no marks. */
export const marksOf = (value: CellValue | undefined): Mark[] =>
  isListOfMarks(value) ? value : [];

/** Returns the length of a mark along its points, in the unit of its model. */
export function markLength({ coordinates }: Pick<Mark, "coordinates">): number {
  return coordinates
    .slice(1)
    .reduce((sum, place, index) => sum + length(subtract(place, coordinates[index]!)), 0);
}

export interface MarkSummary {
  here: number; // number of marks on the model
  elsewhere: number; // number of marks on other models
  metres: number; // length of the lines on the model
}

export function summaryOf(
  value: CellValue | undefined,
  model: Pick<Model, "id" | "unit">,
): MarkSummary {
  const marks = marksOf(value);
  const here = marks.filter((mark) => mark.model === model.id);
  const units = here.reduce((sum, mark) => sum + markLength(mark), 0);
  return {
    here: here.length,
    elsewhere: marks.length - here.length,
    metres: units * metresPer(model.unit),
  };
}

/** Describes a mark: "1.24 m" for a line, or "12.1, 4.25, 30" in the model's unit for a point. */
export function describeMark(mark: Mark, kind: MarkKind, model: Pick<Model, "unit">): string {
  if (kind === "line") return formatLength(markLength(mark) * metresPer(model.unit));
  return `${formatPlace(mark.coordinates[0]!.map((number) => typedNumber(Number(number.toPrecision(5)))))} ${model.unit}`;
}

// The longest step, as a multiple of the distance between neighboring pixels on a surface that
// faces the camera. Steps are longer only at viewing angles of at most 1.5° to the surface.
const kLongestStep = 40;

/**
 * Splits a line on a surface, given as the result at each step, into parts. A part ends at a step
 * without a hit. It also ends if the next point is far in front of or behind the last one, as at
 * the edge of a handle. `stepAt` returns the length of a pixel at a point of a surface that faces
 * the camera. This is the distance between two steps at that point.
 */
export function partsOfLine<T>(
  found: readonly (T | null)[],
  placeOf: (each: T) => MarkPlace,
  stepAt: (place: MarkPlace) => number,
): T[][] {
  const parts: T[][] = [];
  let last: MarkPlace | null = null;
  for (const each of found) {
    const place = each === null ? null : placeOf(each);
    if (each !== null && place) {
      if (!last || length(subtract(place, last)) > kLongestStep * stepAt(place)) parts.push([]);
      parts[parts.length - 1]!.push(each);
    }
    last = place;
  }
  return parts;
}

/**
 * Removes points whose distance from the remaining line is at most the tolerance at the point
 * (Ramer 1972, Douglas and Peucker 1973).
 */
export function simplifyLine(
  places: readonly MarkPlace[],
  toleranceAt: (place: MarkPlace) => number,
): MarkPlace[] {
  const kept = new Set([0, places.length - 1]);
  const parts: [number, number][] = [[0, places.length - 1]];
  for (let part = parts.pop(); part; part = parts.pop()) {
    const [first, last] = part;
    let [farthest, most] = [-1, 1];
    for (let at = first + 1; at < last; ++at) {
      const share =
        distanceToSegment(places[at]!, places[first]!, places[last]!) / toleranceAt(places[at]!);
      if (share > most) [farthest, most] = [at, share];
    }
    if (farthest < 0) continue;
    kept.add(farthest);
    parts.push([first, farthest], [farthest, last]);
  }
  return places.filter((_, index) => kept.has(index));
}

function distanceToSegment(place: MarkPlace, from: MarkPlace, to: MarkPlace): number {
  const along = subtract(to, from);
  const out = subtract(place, from);
  const squared = dot(along, along);
  const share = squared > 0 ? Math.min(1, Math.max(0, dot(out, along) / squared)) : 0;
  return length(subtract(out, scale(along, share)));
}
