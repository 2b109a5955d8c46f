// Values of records as people read and write them. The server judges what a value may be; here is only what a field needs.

import type { CellValue, Column, Labels, Table, TableRecord } from "./protocol.gen";

/** What it is called in the first of the person's languages that it has a name in: of "es-MX" also the name in "es". */
export function label_of(thing: { name: string; labels: Labels }, languages: readonly string[] = navigator.languages): string {
  for (const language of languages) {
    for (let tag = language; tag !== ""; tag = tag.slice(0, Math.max(0, tag.lastIndexOf("-")))) {
      const label = thing.labels[tag];
      if (label) return label;
    }
  }
  return thing.name;
}

export const is_number = (column: Column): boolean => column.kind === "integer" || column.kind === "numeric";
export const holds_files = (column: Column): boolean => column.kind === "picture" || column.kind === "document";
export const names_records = (column: Column): boolean => column.kind === "term" || column.kind === "relation";

/** Keys of the records that a term or a relation names. */
export function named_keys(value: CellValue | undefined): number[] {
  if (Array.isArray(value)) return value;
  return typeof value === "number" ? [value] : [];
}

/** As it is typed and shown; what names records is shown by their labels instead. */
export function cell_text(value: CellValue | undefined): string {
  if (value === null || value === undefined) return "";
  return Array.isArray(value) ? value.join(" ") : String(value);
}

export const same_value = (a: CellValue | undefined, b: CellValue | undefined): boolean =>
  JSON.stringify(a ?? null) === JSON.stringify(b ?? null);

export type Parsed = { value: CellValue } | { wrong: "number" | "whole" };

/** What was typed into a field of the column; nothing is no value. */
export function parse_cell(column: Pick<Column, "kind">, text: string): Parsed {
  const typed = column.kind === "text" ? text : text.trim();
  if (typed === "") return { value: null };
  switch (column.kind) {
    case "integer":
    case "numeric": {
      // A comma may part thousands or decimals: nothing is guessed.
      const number = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(typed) ? Number(typed) : Number.NaN;
      if (!Number.isFinite(number)) return { wrong: "number" };
      return column.kind === "integer" && !Number.isInteger(number) ? { wrong: "whole" } : { value: number };
    }
    case "boolean":
      return { value: typed === "true" };
    case "term":
      return { value: Number(typed) };
    case "relation":
    case "picture":
    case "document":
      return { value: typed.split(/\s+/).map(Number) };
    default:
      return { value: typed };
  }
}

/** The column that tells records apart for people; null where no column does. */
export function label_column(table: Pick<Table, "columns">): Column | null {
  const texts = table.columns.filter((column) => column.kind === "text");
  return (
    texts.find((column) => column.required && column.unique) ??
    texts.find((column) => column.unique || column.required) ??
    texts[0] ??
    table.columns.find((column) => column.unique && !names_records(column)) ??
    null
  );
}

/** What the record is called; empty where it has no name. */
export function label_of_record(table: Pick<Table, "columns">, record: Pick<TableRecord, "values">): string {
  const column = label_column(table);
  return column ? cell_text(record.values[column.slug]) : "";
}
