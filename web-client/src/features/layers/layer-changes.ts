// The changes that a user made in the dialog of a layer.

import { rowsOf } from "../../core/languages";
import { samePalette } from "../../domain/palette";
import type { Labels, LayerBlend, Visibility } from "../../core/protocol.gen";
import type { Layer, LayerPatch, Palette } from "../../core/types";

export interface LayerWanted {
  name: string;
  unit: string;
  description: string;
  labels: Labels;
  descriptions: Labels;
  group: string; // empty for no group
  palette: Palette;
  blend: LayerBlend;
  visibility: Visibility;
  expression?: string; // only for a computed layer
  recompute?: "manual" | "automatic";
}

/** Returns only the members that differ, so other users' changes to the other members are kept. */
export function layerChanges(
  layer: Layer,
  {
    name,
    unit,
    description,
    labels,
    descriptions,
    group,
    palette,
    blend,
    visibility,
    expression,
    recompute,
  }: LayerWanted,
): LayerPatch {
  const change: LayerPatch = {};
  if (name !== layer.name) change.name = name;
  if (unit !== layer.unit) change.unit = unit;
  if (description !== layer.description) change.description = description;
  if (!sameWords(labels, layer.labels)) change.labels = labels;
  if (!sameWords(descriptions, layer.descriptions)) change.descriptions = descriptions;
  if (group !== (layer.group ?? "")) change.group = group;
  if (!samePalette(palette, layer.palette)) change.palette = palette;
  if (blend !== (layer.blend ?? "normal")) change.blend = blend;
  if (visibility !== layer.visibility) change.visibility = visibility;
  if (expression !== undefined && expression !== layer.expression) change.expression = expression;
  if (recompute !== undefined && recompute !== layer.recompute) change.recompute = recompute;
  return change;
}

const sameWords = (a: Labels, b: Labels): boolean =>
  JSON.stringify(rowsOf(a)) === JSON.stringify(rowsOf(b));
