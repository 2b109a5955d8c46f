// The place that a visitor tapped: for a record the kiosk opens its card; for a class or a measured
// value it shows the name at the place.

import { labelOf } from "../domain/cells";
import { formatNumber } from "../domain/measure";
import type { Picked, TourClassName } from "../core/protocol.gen";
import type { Layer } from "../core/types";

export interface TappedPlace {
  /** CSS pixels of the stage. */
  x: number;
  y: number;
  layer: number;
  value: number;
}

/**
 * The topmost layer with a record there, or else the topmost with any value. Null: no layer is
 * painted there.
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

/** The name of a layer in the visitor's language, or its original name. */
export const nameOfLayer = (layer: Pick<Layer, "name" | "labels">, language: string): string =>
  labelOf(layer, [language]);

/** Describes the place: the class, or a number with its unit, and the layer's name. */
export function wordsOfPlace(
  layer: Layer,
  value: number,
  language: string,
  names: readonly TourClassName[] = [], // of the tour
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
