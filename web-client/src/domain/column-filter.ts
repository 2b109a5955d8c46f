// Converts the choices in a column's filter to a condition in CQL2 text, the language that filters
// records, and back. Only the text is stored. The functions recognize the conditions that they
// built, and keep all other conditions that a user typed.

import { nameInText } from "./completion";
import type { Column } from "../core/protocol.gen";

export type FilterValue = string | number | boolean;

export type ColumnFilter =
  | { is: "one_of"; values: readonly FilterValue[]; empty: boolean }
  /**
   * The range includes both ends. An empty text leaves an end open. Numbers are formatted as in
   * JavaScript, times as in the table.
   */
  | { is: "range"; from: string; to: string }
  | { is: "contains"; text: string }
  | { is: "empty" }
  | { is: "filled" };

export type FilterKind = ColumnFilter["is"];

const isNumber = ({ kind }: Pick<Column, "kind">): boolean =>
  kind === "integer" || kind === "numeric";
const isTime = ({ kind }: Pick<Column, "kind">): boolean =>
  kind === "date" || kind === "timestamp" || kind === "period";
const isText = ({ kind }: Pick<Column, "kind">): boolean => kind === "text" || kind === "url";

/** Returns the kinds of filter for a column, the most common first. */
export function filterKinds(column: Pick<Column, "kind">): FilterKind[] {
  const kinds: FilterKind[] = [];
  if (isNumber(column) || isTime(column)) kinds.push("range");
  if (!["picture", "document", "line", "point", "timestamp"].includes(column.kind))
    kinds.push("one_of");
  if (isText(column)) kinds.push("contains");
  return [...kinds, "filled", "empty"];
}

// ── one condition ────────────────────────────────────────────────────────────────────────────────

const quoted = (text: string): string => `'${text.replaceAll("'", "''")}'`;
const literal = (value: FilterValue): string =>
  typeof value === "string" ? quoted(value) : String(value);
const patternOf = (text: string): string => quoted(`%${text.replaceAll(/[\\%_]/g, "\\$&")}%`);

/**
 * Returns the filter's condition. Returns an empty text for a filter without a condition, which
 * matches all records.
 */
export function conditionOf(column: Pick<Column, "slug" | "kind">, filter: ColumnFilter): string {
  const name = nameInText(column.slug);
  switch (filter.is) {
    case "empty":
      return `${name} is null`;
    case "filled":
      return `${name} is not null`;
    case "contains":
      return filter.text === "" ? "" : `casei(${name}) like casei(${patternOf(filter.text)})`;
    case "range": {
      const [from, to] = [filter.from, filter.to].map((end) =>
        end === "" || isNumber(column) ? end : quoted(end),
      );
      if (from && to) return `${name} between ${from} and ${to}`;
      return from ? `${name} >= ${from}` : to ? `${name} <= ${to}` : "";
    }
    case "one_of": {
      const { values } = filter;
      const listed = values.map(literal).join(", ");
      const any =
        values.length === 0
          ? ""
          : column.kind === "relation"
            ? `a_overlaps(${name}, (${listed}))`
            : values.length === 1
              ? `${name} = ${listed}`
              : `${name} in (${listed})`;
      if (!filter.empty) return any;
      return any === "" ? `${name} is null` : `(${any} or ${name} is null)`;
    }
  }
}

const kLiteral = String.raw`-?\d+(?:\.\d+)?(?:e[-+]?\d+)?|'(?:[^']|'')*'|true|false`;

const valueFor = (text: string): FilterValue => {
  if (text.startsWith("'")) return text.slice(1, -1).replaceAll("''", "'");
  return text === "true" || text === "false" ? text === "true" : Number(text);
};
const endOf = (text: string): string => String(valueFor(text));
const valuesIn = (list: string): FilterValue[] =>
  (list.match(new RegExp(kLiteral, "g")) ?? []).map(valueFor);

/**
 * Converts a condition from conditionOf() back to the column's filter. Returns null for all other
 * conditions.
 */
export function filterOf(
  column: Pick<Column, "slug" | "kind">,
  condition: string,
): ColumnFilter | null {
  const name = nameInText(column.slug).replaceAll(/[.*+?^${}()|[\]\\]/g, "\\$&");
  const match = (form: string): RegExpExecArray | null => new RegExp(`^${form}$`).exec(condition);
  if (match(`${name} is null`)) return { is: "empty" };
  if (match(`${name} is not null`)) return { is: "filled" };
  const contains = match(String.raw`casei\(${name}\) like casei\('%((?:[^']|'')*)%'\)`);
  if (contains)
    return {
      is: "contains",
      text: contains[1]!.replaceAll("''", "'").replaceAll(/\\([\\%_])/g, "$1"),
    };
  if (isNumber(column) || isTime(column)) {
    const between = match(`${name} between (${kLiteral}) and (${kLiteral})`);
    if (between) return { is: "range", from: endOf(between[1]!), to: endOf(between[2]!) };
    const from = match(`${name} >= (${kLiteral})`);
    if (from) return { is: "range", from: endOf(from[1]!), to: "" };
    const to = match(`${name} <= (${kLiteral})`);
    if (to) return { is: "range", from: "", to: endOf(to[1]!) };
  }
  const list = `(?:${kLiteral})(?:, (?:${kLiteral}))*`;
  const any = `(?:${name} = (${kLiteral})|${name} in \\((${list})\\)|a_overlaps\\(${name}, \\((${list})\\)\\))`;
  const oneOf = match(any);
  if (oneOf)
    return {
      is: "one_of",
      values: valuesIn(oneOf.slice(1).find((part) => part !== undefined)!),
      empty: false,
    };
  const orEmpty = match(`\\(${any} or ${name} is null\\)`);
  if (orEmpty)
    return {
      is: "one_of",
      values: valuesIn(orEmpty.slice(1).find((part) => part !== undefined)!),
      empty: true,
    };
  return null;
}

// ── the text ─────────────────────────────────────────────────────────────────────────────────────

/**
 * Splits a filter at each top-level "and". Conditions joined by "or" are one condition, in
 * parentheses.
 */
export function conditionsOf(filter: string): string[] {
  const text = filter.trim();
  if (text === "") return [];
  const parts: string[] = [];
  let depth = 0;
  let begun = 0;
  let between = false; // the "and" of "between" does not join conditions
  for (const { 0: token, index } of text.matchAll(
    /'(?:[^']|'')*'|"[^"]*"|[()]|[\p{L}_][\p{L}\p{N}_.-]*/gu,
  )) {
    if (token === "(") depth += 1;
    else if (token === ")") depth -= 1;
    if (depth !== 0) continue;
    const word = token.toLowerCase();
    if (word === "or" || word === "case") return [`(${text})`];
    if (word === "between") between = true;
    if (word !== "and") continue;
    if (between) between = false;
    else {
      parts.push(text.slice(begun, index).trim());
      begun = index + token.length;
    }
  }
  return [...parts, text.slice(begun).trim()].filter((part) => part !== "");
}

/**
 * Returns the column's choice in the filter. Conditions that a user typed in another form are
 * ignored.
 */
export const chosenIn = (
  filter: string,
  column: Pick<Column, "slug" | "kind">,
): ColumnFilter | null =>
  conditionsOf(filter)
    .map((part) => filterOf(column, part))
    .find((found) => found !== null) ?? null;

/** Returns the filter with a new choice for the column, or without a choice if `choice` is null. */
export function withChoice(
  filter: string,
  column: Pick<Column, "slug" | "kind">,
  choice: ColumnFilter | null,
): string {
  const others = conditionsOf(filter).filter((part) => filterOf(column, part) === null);
  const own = choice ? conditionOf(column, choice) : "";
  if (own === "" && others.length === 1) return withoutParentheses(others[0]!);
  return [...others, own].filter((part) => part !== "").join(" and ");
}

/** Removes the parentheses around a condition that is now the only one of the filter. */
function withoutParentheses(condition: string): string {
  const inner = condition.startsWith("(") && condition.endsWith(")") ? condition.slice(1, -1) : "";
  return inner !== "" && conditionsOf(inner)[0] === condition ? inner : condition;
}
