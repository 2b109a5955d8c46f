// Values of records as people read and write them. The server judges what a value may be; here is
// only what a field needs.

import { personLanguages, readNumber, typedNumber } from "../core/locale";
import { isListOfMarks } from "./marks";
import type { CellValue, Column, Labels, Table, TableRecord } from "../core/protocol.gen";

/** The language and those that it is a kind of, in lower case: "es-mx", "es". */
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
 * What it is called in the first of the person's languages that it has a name in: of "es-MX" also
 * the name in "es".
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

/** The same of what is said of it. */
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

/** Keys of the records that a term or a relation names. */
export function namedKeys(value: CellValue | undefined): number[] {
  if (isListOfMarks(value)) return [];
  if (Array.isArray(value)) return value;
  return typeof value === "number" ? [value] : [];
}

/**
 * As it is typed and shown; what names records is shown by their labels instead, and of lines and
 * points how many there are.
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

/** What was typed into a field of the column; nothing is no value. */
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
/** What a record of another table is called; null: it is not known, or not yet. */
export type NameOfKey = (table: number, key: number) => string | null;

/** Whether what a record has in the column can be what it is called. */
export const canBeTitle = ({ kind }: Pick<Column, "kind">): boolean =>
  kind !== "relation" &&
  kind !== "picture" &&
  kind !== "document" &&
  kind !== "line" &&
  kind !== "point" &&
  kind !== "boolean";

/**
 * The column that tells records apart for people: the one that they chose, or the best one; null
 * where no column does.
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
    // what an observation is of, and not who made it
    table.columns.slice(0, 1).find(({ kind }) => kind === "term") ??
    texts[0] ??
    table.columns.find((column) => column.unique && !namesRecords(column)) ??
    null
  );
}

/**
 * The columns that may name a record, the best first: of terms their labels in the person's
 * languages, the label of none, and the code.
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
 * What the record is called; empty where it has no name. `nameOf`: of what a term names; without
 * it another column says the name.
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

/** The first one that the record has: the number of its file. */
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

/** Those that say something of the record in words: not the one that names it, nor pictures. */
export function tellingColumns(table: Naming, { values }: Pick<TableRecord, "values">): Column[] {
  const [name] = namingColumns(table);
  return table.columns.filter(
    (column) =>
      column !== name && column.kind !== "picture" && cellText(values[column.slug]) !== "",
  );
}
