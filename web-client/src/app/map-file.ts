// Files that are painted over a layer: what kind one is, and how it is asked for.

export type MapKind = "readings" | "polygons" | "picture";
export const kAlong = ["-z", "+z", "-y", "+y", "-x", "+x"] as const;
export type Along = (typeof kAlong)[number];

/** By the file's name; null: none of these. */
export function map_kind(filename: string): MapKind | null {
  const extension = /\.([a-z]+)$/i.exec(filename)?.[1]?.toLowerCase() ?? "";
  if (["csv", "tsv", "txt"].includes(extension)) return "readings";
  if (["geojson", "json"].includes(extension)) return "polygons";
  if (["png", "jpg", "jpeg"].includes(extension)) return "picture";
  return null;
}

/** Names of number-valued properties that every feature of a GeoJSON text has; none where it cannot be read. */
export function number_attributes(text: string): string[] {
  try {
    const { features } = JSON.parse(text) as { features?: { properties?: Record<string, unknown> | null }[] };
    const [first, ...rest] = (features ?? []).map(({ properties }) => properties ?? {});
    return Object.keys(first ?? {}).filter((name) => [first!, ...rest].every((each) => typeof each[name] === "number"));
  } catch {
    return [];
  }
}

/** The six numbers of a world file, parted by commas; null: there are not six. */
export function world_numbers(text: string): string | null {
  const numbers = text.trim().split(/[\s,;]+/);
  return numbers.length === 6 && numbers.every((each) => each !== "" && Number.isFinite(Number(each))) ? numbers.join(",") : null;
}
