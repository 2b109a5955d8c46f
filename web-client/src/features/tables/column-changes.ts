// The changes that a user made in the dialog of a column.

import { sameValue } from "../../domain/cells";
import { rowsOf } from "../../core/languages";
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

export const hasLimits = (kind: ColumnKind): boolean => kind === "integer" || kind === "numeric";
export const hasTarget = (kind: ColumnKind): boolean => kind === "term" || kind === "relation";

/** Returns only the members that apply to the kind. */
export function ofKind(wanted: ColumnWanted): ColumnPatch {
  const { name, labels, kind, required, unique, comment } = wanted;
  return {
    name,
    labels,
    kind,
    required,
    unique,
    comment,
    ...(hasLimits(kind)
      ? { unit: wanted.unit, minimum: wanted.minimum, maximum: wanted.maximum }
      : {}),
    ...(kind === "enumeration" ? { choices: wanted.choices } : {}),
    ...(hasTarget(kind) && wanted.target !== null ? { target: wanted.target } : {}),
  };
}

/** Returns only the members that differ, which keeps other users' changes to the other members. */
export function columnChanges(column: Column, wanted: ColumnWanted): ColumnPatch {
  const now: Record<string, unknown> = { unit: "", minimum: null, maximum: null, ...column };
  const entries = Object.entries(ofKind(wanted)).filter(([member, value]) =>
    member === "labels"
      ? !sameLabels(wanted.labels, column.labels)
      : !sameValue(value as CellValue, (now[member] ?? null) as CellValue),
  );
  return Object.fromEntries(entries);
}

/** Compares labels in any order. */
const sameLabels = (a: Labels, b: Labels): boolean =>
  JSON.stringify(rowsOf(a)) === JSON.stringify(rowsOf(b));
