// Converts values of records to text and back. The server validates values. This file contains only
// the rules that a field needs.

import { personLanguages, readNumber, typedNumber } from "../core/locale";
import { isListOfMarks } from "./marks";
import type { CellValue, Column, Labels, Table, TableRecord } from "../core/protocol.gen";

/** Returns the language tag and its more general tags in lower case, such as "es-mx" and "es". */
function kindsOfLanguage(language: string): string[] {
  const tags: string[] = [];
  for (
    let tag = language.toLowerCase();
    tag !== "";
    tag = tag.slice(0, Math.max(0, tag.lastIndexOf("-")))
  )
    tags.push(tag);
  return tags;
}

/**
 * Returns the name in the first of the user's languages that has a name. The language "es-MX" also
 * matches a name in "es".
 */
export function labelOf(
  thing: { name: string; labels: Labels },
  languages: readonly string[] = personLanguages(),
): string {
  const labels = new Map(
    Object.entries(thing.labels).map(([tag, label]) => [tag.toLowerCase(), label]),
  );
  for (const tag of languages.flatMap(kindsOfLanguage)) {
    const label = labels.get(tag);
    if (label) return label;
  }
  return thing.name;
}

/**
 * Returns the description in the first of the user's languages that has one, as labelOf() does for
 * names.
 */
export const descriptionIn = (
  thing: { description: string; descriptions: Labels },
  languages?: readonly string[],
): string => labelOf({ name: thing.description, labels: thing.descriptions }, languages);

export const isNumber = (column: Column): boolean =>
  column.kind === "integer" || column.kind === "numeric";
export const holdsFiles = (column: Column): boolean =>
  column.kind === "picture" || column.kind === "document";
export const namesRecords = (column: Column): boolean =>
  column.kind === "term" || column.kind === "relation";

/** Returns the keys of the records that a term or relation points to. */
export function namedKeys(value: CellValue | undefined): number[] {
  if (isListOfMarks(value)) return [];
  if (Array.isArray(value)) return value;
  return typeof value === "number" ? [value] : [];
}

/**
 * Returns the value as text, for display and input. Cells that point to records show labels
 * instead. For lines and points, the text is their count.
 */
export function cellText(value: CellValue | undefined): string {
  if (value === null || value === undefined) return "";
  if (typeof value === "number") return typedNumber(value);
  if (!Array.isArray(value)) return String(value);
  return isListOfMarks(value) ? String(value.length) : value.join(" ");
}

export const sameValue = (a: CellValue | undefined, b: CellValue | undefined): boolean =>
  JSON.stringify(a ?? null) === JSON.stringify(b ?? null);

export type Parsed = { value: CellValue } | { wrong: "number" | "whole" };

/** Parses the text that a user typed into a field of the column. An empty text means no value. */
export function parseCell(column: Pick<Column, "kind">, text: string): Parsed {
  const typed = column.kind === "text" ? text : text.trim();
  if (typed === "") return { value: null };
  switch (column.kind) {
    case "integer":
    case "numeric": {
      const number = readNumber(typed);
      if (!Number.isFinite(number)) return { wrong: "number" };
      return column.kind === "integer" && !Number.isInteger(number)
        ? { wrong: "whole" }
        : { value: number };
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

type Naming = Pick<Table, "columns" | "kind" | "title_column">;
/**
 * Returns the name of a record in another table. Returns null if the name is unknown or not loaded
 * yet.
 */
export type NameOfKey = (table: number, key: number) => string | null;

/** Whether values of the column can be a record's name. */
export const canBeTitle = ({ kind }: Pick<Column, "kind">): boolean =>
  kind !== "relation" &&
  kind !== "picture" &&
  kind !== "document" &&
  kind !== "line" &&
  kind !== "point" &&
  kind !== "boolean";

/**
 * Returns the column whose values identify records for users: the chosen column, or otherwise the
 * best one. Returns null if no column can identify them.
 */
export function labelColumn(table: Pick<Table, "columns" | "title_column">): Column | null {
  const chosen = table.columns.find(({ id }) => id === table.title_column);
  return chosen && canBeTitle(chosen) ? chosen : bestLabelColumn(table);
}

function bestLabelColumn(table: Pick<Table, "columns">): Column | null {
  const texts = table.columns.filter((column) => column.kind === "text");
  return (
    texts.find((column) => column.required && column.unique) ??
    texts.find((column) => column.unique || column.required) ??
    // a term in the first column names the subject of an observation; later columns may name its
    // author
    table.columns.slice(0, 1).find(({ kind }) => kind === "term") ??
    texts[0] ??
    table.columns.find((column) => column.unique && !namesRecords(column)) ??
    null
  );
}

/**
 * Returns the columns that can name a record, the best first. For terms, these are the labels in
 * the user's languages, then the label without a language, then the code.
 */
export function namingColumns(table: Naming, languages?: readonly string[]): Column[] {
  const last = [labelColumn(table) ?? [], bestLabelColumn(table) ?? []].flat();
  if (table.kind !== "terms") return [...new Set(last)];
  const slugs = (languages ?? personLanguages())
    .flatMap(kindsOfLanguage)
    .map((tag) => `label-${tag}`);
  const labels = [...slugs, "label"].map(
    (slug) => table.columns.find((column) => column.kind === "text" && column.slug === slug) ?? [],
  );
  return [...new Set([...labels, last].flat())];
}

/**
 * Returns the name of the record, or an empty text. `nameOf` returns the name of the term that a
 * cell points to. Without `nameOf`, another column provides the name.
 */
export function labelOfRecord(
  table: Naming,
  record: Pick<TableRecord, "values">,
  languages?: readonly string[],
  nameOf: NameOfKey = () => null,
): string {
  for (const column of namingColumns(table, languages)) {
    const value = record.values[column.slug];
    const name =
      column.kind === "term"
        ? namedKeys(value)
            .map((key) => nameOf(column.target ?? 0, key) ?? "")
            .join("")
        : cellText(value);
    if (name !== "") return name;
  }
  return "";
}

/** Returns the file number of the record's first image. */
export function firstPicture(
  table: Pick<Table, "columns">,
  { values }: Pick<TableRecord, "values">,
): number | null {
  return (
    table.columns
      .filter(({ kind }) => kind === "picture")
      .flatMap(({ slug }) => namedKeys(values[slug]))[0] ?? null
  );
}

/** Returns the columns that describe the record in words, except the one that names it. */
export function tellingColumns(table: Naming, { values }: Pick<TableRecord, "values">): Column[] {
  const [name] = namingColumns(table);
  return table.columns.filter(
    (column) =>
      column !== name && column.kind !== "picture" && cellText(values[column.slug]) !== "",
  );
}
