// What somebody changed in the dialog of a column.

import { same_value } from "../../domain/cells";
import { rows_of } from "../../core/languages";
import type { CellValue, Column, ColumnKind, ColumnPatch, Labels } from "../../core/protocol.gen";

export interface ColumnWanted {
  name: string;
  labels: Labels;
  kind: ColumnKind;
  unit: string;
  required: boolean;
  unique: boolean;
  comment: string;
  choices: string[];
  target: number | null;
  minimum: number | null;
  maximum: number | null;
}

export const kColumnKinds: readonly ColumnKind[] = [
  "text",
  "integer",
  "numeric",
  "boolean",
  "date",
  "timestamp",
  "period",
  "enumeration",
  "url",
  "term",
  "relation",
  "line",
  "point",
];

export const has_limits = (kind: ColumnKind): boolean => kind === "integer" || kind === "numeric";
export const has_target = (kind: ColumnKind): boolean => kind === "term" || kind === "relation";

/** Only what suits the kind. */
export function of_kind(wanted: ColumnWanted): ColumnPatch {
  const { name, labels, kind, required, unique, comment } = wanted;
  return {
    name,
    labels,
    kind,
    required,
    unique,
    comment,
    ...(has_limits(kind)
      ? { unit: wanted.unit, minimum: wanted.minimum, maximum: wanted.maximum }
      : {}),
    ...(kind === "enumeration" ? { choices: wanted.choices } : {}),
    ...(has_target(kind) && wanted.target !== null ? { target: wanted.target } : {}),
  };
}

/** Only what differs: what this person left alone is not theirs to set. */
export function column_changes(column: Column, wanted: ColumnWanted): ColumnPatch {
  const now: Record<string, unknown> = { unit: "", minimum: null, maximum: null, ...column };
  const entries = Object.entries(of_kind(wanted)).filter(([member, value]) =>
    member === "labels"
      ? !same_labels(wanted.labels, column.labels)
      : !same_value(value as CellValue, (now[member] ?? null) as CellValue),
  );
  return Object.fromEntries(entries);
}

/** In whatever order. */
const same_labels = (a: Labels, b: Labels): boolean =>
  JSON.stringify(rows_of(a)) === JSON.stringify(rows_of(b));
