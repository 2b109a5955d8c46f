// The requests that the dialogs for regions send, from what the user entered.

import { readNumber } from "../../core/locale";
import type { Cleanup, PieceRecords } from "../../core/protocol.gen";
import { texts } from "../../texts";

export const kOperations = ["sieve", "fill-holes", "majority", "open", "close", "border"] as const;
export type CleanupOperation = (typeof kOperations)[number];

export interface CleanupInput {
  operation: CleanupOperation;
  /** In cm², as typed. */
  area: string;
  erasesRegions: boolean;
  /** In mm, as typed. */
  radius: string;
  width: string;
  /** The id of the layer with the regions. Null: the layer itself. */
  from: number | null;
  /** The value of the regions, as typed. Empty: all values. */
  of: string;
  inside: boolean;
  /** The value of the line. Null: erase. */
  line: number | null;
}

export interface Refusal {
  problem: string;
  field: string;
}

const isRefusal = (value: number | Refusal): value is Refusal => typeof value !== "number";

function lengthOf(text: string, field: string): number | Refusal {
  const value = readNumber(text);
  return value > 0 ? value : { problem: texts.regions.bad_size, field };
}

function valueOf(text: string): { of?: number } | Refusal {
  if (text.trim() === "") return {};
  const value = readNumber(text);
  return Number.isFinite(value) ? { of: value } : { problem: texts.regions.bad_value, field: "of" };
}

export function cleanupOf(input: CleanupInput, apply: boolean): Cleanup | Refusal {
  const { operation } = input;
  if (operation === "sieve" || operation === "fill-holes") {
    const area = lengthOf(input.area, "area_cm2");
    if (isRefusal(area)) return area;
    const erases = operation === "sieve" && input.erasesRegions ? { erase_regions: true } : {};
    return { operation, area_cm2: area, ...erases, apply };
  }
  if (operation === "majority") {
    const radius = lengthOf(input.radius, "radius_mm");
    return isRefusal(radius) ? radius : { operation, radius_mm: radius, apply };
  }
  const width = lengthOf(input.width, "width_mm");
  if (isRefusal(width)) return width;
  const of = valueOf(input.of);
  if ("problem" in of) return of;
  if (operation !== "border") return { operation, width_mm: width, ...of, apply };
  return {
    operation,
    width_mm: width,
    ...(input.from === null ? {} : { from: input.from }),
    ...of,
    ...(input.inside && of.of !== undefined ? { inside: true } : {}),
    ...(input.line === null ? { erase: true } : { value: input.line }),
    apply,
  };
}

export interface PiecesInput {
  /** The id of the layer of records. */
  into: number;
  /** The value of the pieces, as typed. Empty: all values. */
  of: string;
  /** In cm², as typed. Empty: all pieces. */
  minArea: string;
  /** Slugs of columns. Empty: no column. */
  number: string;
  area: string;
  perimeter: string;
  /** Without `asLines`, the largest piece has the number 1 otherwise. */
  inReadingOrder: boolean;
  /** Measures the pieces as lines. Only then do the next columns count. */
  asLines: boolean;
  length: string;
  width: string;
  greatestWidth: string;
}

function linesOf({ length, width, greatestWidth }: PiecesInput): Partial<PieceRecords> {
  return {
    as_lines: true,
    ...(length ? { length_column: length } : {}),
    ...(width ? { width_column: width } : {}),
    ...(greatestWidth ? { greatest_width_column: greatestWidth } : {}),
  };
}

export function piecesOf(input: PiecesInput, apply: boolean): PieceRecords | Refusal {
  const of = valueOf(input.of);
  if ("problem" in of) return of;
  const isEmpty = input.minArea.trim() === "";
  const minArea = isEmpty ? 0 : readNumber(input.minArea);
  if (!(minArea >= 0)) return { problem: texts.regions.bad_size, field: "min_area_cm2" };
  return {
    into: input.into,
    ...of,
    ...(minArea > 0 ? { min_area_cm2: minArea } : {}),
    ...(input.number ? { number_column: input.number } : {}),
    ...(input.area ? { area_column: input.area } : {}),
    ...(input.perimeter ? { perimeter_column: input.perimeter } : {}),
    ...(input.asLines ? linesOf(input) : input.inReadingOrder ? { in_reading_order: true } : {}),
    apply,
  };
}
