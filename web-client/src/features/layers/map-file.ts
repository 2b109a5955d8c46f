// Files that can be painted into a layer: their kinds, and the parameters of the request.

import { readNumber, typedNumber } from "../../core/locale";
import type { MapColor, MapContents } from "../../core/types";

export const kTableEndings = ["csv", "tsv", "txt"] as const;
export const kPictureEndings = [
  "tif",
  "tiff",
  "png",
  "jpg",
  "jpeg",
  "tfw",
  "tifw",
  "pgw",
  "jgw",
  "wld",
  "zip",
] as const;
export const kMapEndings = [
  "geojson",
  "json",
  "shp",
  "dbf",
  "prj",
  "cpg",
  "shx",
  ...kPictureEndings,
] as const;

/** Returns the value for the `accept` attribute of a file field. */
export const accepted = (endings: readonly string[]): string =>
  endings.map((ending) => `.${ending}`).join(",");

const endingOf = (name: string): string => /\.([a-z]+)$/i.exec(name)?.[1]?.toLowerCase() ?? "";

/**
 * Returns "table" for a table of numbers, "map" for a map that the server inspects, or null if
 * another kind of file is included.
 */
export function fileKind(names: readonly string[]): "table" | "map" | null {
  const endings = names.map(endingOf);
  if (endings.length === 1 && (kTableEndings as readonly string[]).includes(endings[0]!))
    return "table";
  return endings.length > 0 &&
    endings.every((each) => (kMapEndings as readonly string[]).includes(each))
    ? "map"
    : null;
}

/** Returns the name of the first file whose kind is not supported. */
export const unknownFile = (names: readonly string[]): string =>
  names.find((name) => fileKind([name]) === null) ?? names[0] ?? "";

/**
 * Returns "readings" or "vertices", according to the first line of a table. Readings have
 * coordinates. Vertex values have one number for each vertex.
 */
export function tableKind(text: string): "readings" | "vertices" {
  const names = (text.trimStart().split(/\r?\n/, 1)[0] ?? "")
    .split(/[,;\t]/)
    .map((name) => name.replace(/["\s]/g, "").toLowerCase());
  return ["x", "y", "z", "value"].every((name) => names.includes(name)) ? "readings" : "vertices";
}

/** Returns the six numbers of a world file, separated by commas, or null for other texts. */
export function worldNumbers(text: string): string | null {
  const numbers = text.trim().split(/[\s,;]+/);
  return numbers.length === 6 &&
    numbers.every((each) => each !== "" && Number.isFinite(Number(each)))
    ? numbers.join(",")
    : null;
}

/** The way to read numbers from a picture. */
export type PictureMode = "luminance" | "band" | "colors";

/** Returns the modes that the picture allows, with the most likely one first. */
export function pictureModes(contents: MapContents): PictureMode[] {
  const modes: PictureMode[] = [];
  if (contents.bands !== undefined && !contents.is_rgb) modes.push("band");
  if (contents.has_colors && contents.is_rgb && (contents.colors?.length ?? 0) > 1)
    modes.push("colors");
  if (contents.has_colors) modes.push("luminance");
  if (contents.bands !== undefined && contents.is_rgb) modes.push("band");
  if (contents.has_colors && !contents.is_rgb && (contents.colors?.length ?? 0) > 1)
    modes.push("colors");
  return modes;
}

export interface ColorRow {
  color: string; // in the format "#rrggbb"
  share: number;
  used: boolean;
  value: string; // as the user typed it
}

/**
 * Returns the detected colors, and assigns the values to them in order. The paper's color gets no
 * value.
 */
export function colorRows(colors: readonly MapColor[], values: readonly number[]): ColorRow[] {
  let next = 0;
  let above = Math.max(0, ...values);
  return colors.map(({ color, share, background }) => {
    const value = background ? "" : typedNumber(values[next++] ?? ++above);
    return { color, share, used: !background, value };
  });
}

/**
 * Returns a text such as `{"#c02020":1}`, or null if a used color has no number or no color is
 * used.
 */
export function colorKeys(rows: readonly ColorRow[]): string | null {
  const used = rows.filter((row) => row.used);
  if (used.length === 0 || used.some((row) => Number.isNaN(readNumber(row.value)))) return null;
  return JSON.stringify(Object.fromEntries(used.map((row) => [row.color, readNumber(row.value)])));
}
