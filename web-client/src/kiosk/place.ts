// The point that a visitor tapped. For a record, the kiosk opens the record's card. For a class or
// a measured value, the kiosk shows its name at the point.

import { labelOf } from "../domain/cells";
import { formatNumber } from "../domain/measure";
import type { Picked, TourClassName } from "../core/protocol.gen";
import type { Layer } from "../core/types";

export interface TappedPlace {
  /** The position on the stage in CSS pixels. */
  x: number;
  y: number;
  layer: number;
  value: number;
}

/**
 * Returns the topmost layer with a record at the point, or otherwise the topmost layer with any
 * value. Returns null if no layer has a value at the point.
 */
export function layerThere(
  seen: readonly Layer[],
  { values }: Pick<Picked, "values">,
): { layer: Layer; value: number } | null {
  const painted = seen.flatMap((layer) => {
    const found = values?.[layer.slug];
    return found?.valid && found.value !== undefined ? [{ layer, value: found.value }] : [];
  });
  return painted.find(({ layer }) => layer.table !== undefined) ?? painted[0] ?? null;
}

/** Returns the name of a layer in the visitor's language, or its original name. */
export const nameOfLayer = (layer: Pick<Layer, "name" | "labels">, language: string): string =>
  labelOf(layer, [language]);

/** Describes the point: the class, or the number with its unit, and the name of the layer. */
export function wordsOfPlace(
  layer: Layer,
  value: number,
  language: string,
  names: readonly TourClassName[] = [], // from the tour
): { title: string; about: string } {
  const about = nameOfLayer(layer, language);
  const { mode, points } = layer.palette;
  if (mode !== "categorical")
    return { title: `${formatNumber(value, 3)}${layer.unit ? ` ${layer.unit}` : ""}`, about };
  const title =
    names.find((each) => each.value === value)?.names[language] ||
    (points.find(({ at }) => at === value)?.label ?? "");
  return title === "" || title === about ? { title: title || about, about: "" } : { title, about };
}
