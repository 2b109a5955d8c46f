// What lies where a visitor tapped: of a record its card tells more; of everything else the class,
// or what was measured, is named beside the place.

import { labelOf } from "../domain/cells";
import { formatNumber } from "../domain/measure";
import type { Picked } from "../core/protocol.gen";
import type { Layer } from "../core/types";

export interface TappedPlace {
  /** CSS pixels of the stage. */
  x: number;
  y: number;
  layer: number;
  value: number;
}

/**
 * The topmost of the layers that holds a record there, or else the topmost that holds anything.
 * Null: none is painted there.
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

/** What a layer is called in the visitor's language, or as its makers call it. */
export const nameOfLayer = (layer: Pick<Layer, "name" | "labels">, language: string): string =>
  labelOf(layer, [language]);

/** What the place is, in words: the class, or a number with its unit; and what that is about. */
export function wordsOfPlace(
  layer: Layer,
  value: number,
  language: string,
): { title: string; about: string } {
  const about = nameOfLayer(layer, language);
  const { mode, points } = layer.palette;
  if (mode !== "categorical")
    return { title: `${formatNumber(value, 3)}${layer.unit ? ` ${layer.unit}` : ""}`, about };
  const title = points.find(({ at }) => at === value)?.label ?? "";
  return title === "" || title === about ? { title: title || about, about: "" } : { title, about };
}
