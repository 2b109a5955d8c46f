// Files that are painted into a layer: their kinds, and the parameters of the request.

import type { UploadFile } from "../../net/upload";
import { readNumber, typedNumber } from "../../core/locale";
import type { MapColor, MapContents } from "../../core/types";

export const kAlong = ["-z", "+z", "-y", "+y", "-x", "+x"] as const;
export type Along = (typeof kAlong)[number];

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

/** For the `accept` of a file field. */
export const accepted = (endings: readonly string[]): string =>
  endings.map((ending) => `.${ending}`).join(",");

const endingOf = (name: string): string => /\.([a-z]+)$/i.exec(name)?.[1]?.toLowerCase() ?? "";

/** A table of numbers, or a map that the server inspects; null: other files are included. */
export function fileKind(names: readonly string[]): "table" | "map" | null {
  const endings = names.map(endingOf);
  if (endings.length === 1 && (kTableEndings as readonly string[]).includes(endings[0]!))
    return "table";
  return endings.length > 0 &&
    endings.every((each) => (kMapEndings as readonly string[]).includes(each))
    ? "map"
    : null;
}

/** The first file of another kind. */
export const unknownFile = (names: readonly string[]): string =>
  names.find((name) => fileKind([name]) === null) ?? names[0] ?? "";

/** Decides by the first line of a table: measured places, or one number for each vertex. */
export function tableKind(text: string): "readings" | "vertices" {
  const names = (text.trimStart().split(/\r?\n/, 1)[0] ?? "")
    .split(/[,;\t]/)
    .map((name) => name.replace(/["\s]/g, "").toLowerCase());
  return ["x", "y", "z", "value"].every((name) => names.includes(name)) ? "readings" : "vertices";
}

export const asUploads = (files: readonly File[]): UploadFile[] =>
  files.map((file) => ({ file, path: file.name }));

/** The six numbers of a world file, separated by commas; null: not six numbers. */
export function worldNumbers(text: string): string | null {
  const numbers = text.trim().split(/[\s,;]+/);
  return numbers.length === 6 &&
    numbers.every((each) => each !== "" && Number.isFinite(Number(each)))
    ? numbers.join(",")
    : null;
}

/** How a picture gives numbers. */
export type PictureMode = "luminance" | "band" | "colors";

/** The modes that the picture allows, the most likely first. */
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
  color: string; // "#rrggbb"
  share: number;
  used: boolean;
  value: string; // as typed
}

/** The colors found, each with the next of these values; the paper's color has none. */
export function colorRows(colors: readonly MapColor[], values: readonly number[]): ColorRow[] {
  let next = 0;
  let above = Math.max(0, ...values);
  return colors.map(({ color, share, background }) => {
    const value = background ? "" : typedNumber(values[next++] ?? ++above);
    return { color, share, used: !background, value };
  });
}

/** `{"#c02020":1}`; null: a used color has no number, or no color is used. */
export function colorKeys(rows: readonly ColorRow[]): string | null {
  const used = rows.filter((row) => row.used);
  if (used.length === 0 || used.some((row) => Number.isNaN(readNumber(row.value)))) return null;
  return JSON.stringify(Object.fromEntries(used.map((row) => [row.color, readNumber(row.value)])));
}
