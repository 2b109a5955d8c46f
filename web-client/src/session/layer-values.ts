// Describes values of layers in words.

import { holdsFractions, valueRange, type Layer } from "../core/types";
import { formatNumber } from "../domain/measure";
import { texts } from "../texts";

/**
 * Returns the reason why a value cannot be painted in the layer, in plain words. Returns null if it
 * can be painted.
 */
export function valueProblem(layer: Layer, value: number): string | null {
  if (!Number.isFinite(value)) return texts.brush.bad_value;
  if (!holdsFractions(layer.type) && !Number.isInteger(value)) return texts.brush.whole_number;
  const [low, high] = valueRange(layer.type);
  if (value < low || value > high)
    return texts.brush.out_of_range(formatNumber(low), formatNumber(high));
  return null;
}

/** Returns names of records, or null for unknown names. */
export interface RecordLabels {
  label(table: number, key: number): string | null;
  /** Returns the name of a term in the user's language, or null if the table is not a term list. */
  term(table: number, key: number): string | null;
}

/**
 * Describes a value by its term, the label of its class, the name of its record, or the number with
 * its unit.
 */
export function describeValue(
  layer: Layer,
  value: number,
  records: RecordLabels | null = null,
): string {
  const term = layer.table === undefined ? null : (records?.term(layer.table, value) ?? null);
  if (term !== null) return term;
  const byValue = layer.palette.mode === "categorical" && !layer.palette.column;
  const label = byValue ? layer.palette.points.find((p) => p.at === value)?.label : "";
  if (label) return label;
  if (layer.kind === "database") {
    return (
      (layer.table === undefined ? null : records?.label(layer.table, value)) ??
      texts.layers.record_number(value)
    );
  }
  if (layer.palette.mode === "categorical") return texts.layers.class_number(value);
  return `${formatNumber(value, 4)}${layer.unit ? ` ${layer.unit}` : ""}`;
}
