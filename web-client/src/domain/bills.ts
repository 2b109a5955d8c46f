// The items of a bill of quantities: their order, their ordinal numbers, and the numbers that users
// type. The items of a draft contain decimal numbers as typed in the page's language.

import { readNumber, withDecimalSign } from "../core/locale";
import type { Bill, BillItem, BillRule, BillSize } from "../core/protocol.gen";

export interface BillDraft {
  name: string;
  currency: string;
  items: readonly BillItem[];
}

export type ItemKind = NonNullable<BillItem["kind"]>;
export type Measure = BillRule["measure"];

export const kMeasures: readonly Measure[] = ["area", "length", "count", "volume"];
/** The usual units of positions. `null`: only hand measurements. */
export const kUnits: readonly { unit: string; measure: Measure | null }[] = [
  { unit: "m2", measure: "area" },
  { unit: "m", measure: "length" },
  { unit: "m3", measure: "volume" },
  { unit: "St", measure: "count" },
  { unit: "psch", measure: null },
];
/** Returns the measure that the rules of a position with this unit have, if the page knows it. */
export const measureOf = (unit: string): Measure | null =>
  kUnits.find((each) => each.unit === unit)?.measure ?? null;
export const kUnitOfMeasure: Readonly<Record<Measure, string>> = {
  area: "m²",
  length: "m",
  count: "",
  volume: "m³",
};

// ── the tree ─────────────────────────────────────────────────────────────────────────────────────

export const isGroup = (item: BillItem): boolean => item.kind === "group";
export const levelOf = (number: string): number => number.split(".").length;
export const parentOf = (number: string): string => number.split(".").slice(0, -1).join(".");
const isWithin = (number: string, group: string): boolean => number.startsWith(`${group}.`);

/** Returns the index after the item and its descendants. */
export function endOf(items: readonly BillItem[], index: number): number {
  const { number } = items[index]!;
  let end = index + 1;
  while (end < items.length && isWithin(items[end]!.number, number)) end += 1;
  return end;
}

/** Returns the indices of the items that are not inside a collapsed group. */
export function visibleItems(items: readonly BillItem[], collapsed: ReadonlySet<string>): number[] {
  const found: number[] = [];
  for (let index = 0; index < items.length;) {
    found.push(index);
    index = collapsed.has(items[index]!.number) ? endOf(items, index) : index + 1;
  }
  return found;
}

/** Returns the last part of a number as digits, or null if it has other characters. */
function countIn(number: string): number | null {
  const last = number.split(".").at(-1)!;
  return /^\d{1,9}$/.test(last) ? Number(last) : null;
}

/**
 * Returns a free number in the group `parent` ("" for the top level), after `before` and, if
 * possible, before `after`.
 */
function freeNumber(
  items: readonly BillItem[],
  parent: string,
  kind: ItemKind,
  before: string | null,
  after: string | null,
): string {
  const [step, width] = kind === "group" ? [1, 2] : [10, 4];
  const used = new Set(items.map(({ number }) => number));
  const full = (n: number): string =>
    (parent === "" ? "" : `${parent}.`) + String(n).padStart(width, "0");
  const low = before === null ? 0 : countIn(before);
  const high = after === null ? null : countIn(after);
  if (low !== null && high !== null && high - low > 1) {
    const between = full(low + Math.floor((high - low) / 2));
    if (!used.has(between)) return between;
  }
  const siblings = items.filter(({ number }) => parentOf(number) === parent);
  const highest = Math.max(0, ...siblings.map(({ number }) => countIn(number) ?? 0));
  let next = Math.floor(highest / step) * step + step;
  while (used.has(full(next))) next += step;
  return full(next);
}

export interface Inserted {
  items: readonly BillItem[];
  /** The index of the new item. */
  index: number;
}

/**
 * Inserts an empty item. A position follows the selected position, or is the last one of the
 * selected group. A group follows the selected group, or the group of the selected position.
 */
export function inserted(
  items: readonly BillItem[],
  selected: number | null,
  kind: ItemKind,
): Inserted {
  const at = selected === null ? null : (items[selected] ?? null);
  let index = items.length;
  let parent = "";
  let before: string | null = null;
  if (at && kind === "position" && isGroup(at)) {
    index = endOf(items, selected!);
    parent = at.number;
  } else if (at && kind === "position") {
    index = selected! + 1;
    parent = parentOf(at.number);
    before = at.number;
  } else if (at) {
    const own = isGroup(at) ? at.number : parentOf(at.number);
    const group = items.findIndex(({ number }) => number === own);
    if (group >= 0) {
      index = endOf(items, group);
      parent = parentOf(own);
      before = own;
    }
  }
  const following = items[index];
  const after = following && parentOf(following.number) === parent ? following.number : null;
  const number = freeNumber(items, parent, kind, before, after);
  const item: BillItem = kind === "group" ? { number, kind } : { number, unit: "m2" };
  const numbered = after !== null && (countIn(number) ?? 0) > (countIn(after) ?? 0);
  // A number that is higher than all others belongs at the end of the group.
  if (numbered) index = endOfGroup(items, parent);
  return { items: [...items.slice(0, index), item, ...items.slice(index)], index };
}

function endOfGroup(items: readonly BillItem[], parent: string): number {
  const group = items.findIndex(({ number }) => number === parent);
  return group < 0 ? items.length : endOf(items, group);
}

/** Removes an item with its descendants. */
export const removed = (items: readonly BillItem[], index: number): readonly BillItem[] => [
  ...items.slice(0, index),
  ...items.slice(endOf(items, index)),
];

/**
 * Replaces an item. If its number changes, the numbers of its descendants begin with the new one,
 * and an item that enters another group moves to the end of that group.
 */
export function replaced(items: readonly BillItem[], index: number, item: BillItem): Inserted {
  const old = items[index]!.number;
  const end = endOf(items, index);
  const block = items.slice(index, end).map((each, at) => {
    if (at === 0) return item;
    return { ...each, number: item.number + each.number.slice(old.length) };
  });
  const others = [...items.slice(0, index), ...items.slice(end)];
  const parent = parentOf(item.number);
  const stays =
    parent === parentOf(old) || !others.some((each) => isGroup(each) && each.number === parent);
  const at = stays ? index : endOfGroup(others, parent);
  return { items: [...others.slice(0, at), ...block, ...others.slice(at)], index: at };
}

// ── decimal numbers ──────────────────────────────────────────────────────────────────────────────

/**
 * Converts a typed number to the form of the contract, such as "1250.50". Returns null if it is
 * invalid, ambiguous, or has too many digits.
 */
export function decimalOf(typed: string): string | null {
  const text = typed.trim();
  if (Number.isNaN(readNumber(text))) return null;
  const plain = text
    .replace(",", ".")
    .replace(/^\+/, "")
    .replace(/^(-?)\./, "$10.")
    .replace(/\.$/, "");
  return /^-?[0-9]{1,11}(\.[0-9]{1,6})?$/.test(plain) ? plain : null;
}

type Convert = (decimal: string, field: string) => string;

/** Converts the decimal numbers of an item. `field` is the path in the item. Omits empty ones. */
function withDecimals(item: BillItem, convert: Convert): BillItem {
  const each = <T extends object, K extends keyof T>(
    of: T,
    keys: readonly K[],
    path: string,
  ): T => {
    const made = { ...of };
    for (const key of keys) {
      const decimal = of[key] as string | undefined;
      if (decimal === undefined) continue;
      if (decimal.trim() === "") delete made[key];
      else made[key] = convert(decimal, `${path}${String(key)}`) as T[K];
    }
    return made;
  };
  const made = each(item, ["quantity", "unit_price"], "");
  if (made.rounding) made.rounding = each(made.rounding, ["smallest"], "rounding.");
  if (made.rules)
    made.rules = made.rules.map((rule, i) => {
      const path = `rules[${i}].`;
      const next = each(rule, ["factor", "overmeasured_up_to"], path);
      if (next.depth) next.depth = each(next.depth, ["metres"], `${path}depth.`);
      if (next.size) next.size = each(next.size, ["over", "up_to"], `${path}size.`);
      if (next.size && !hasLimit(next.size)) delete next.size;
      if (next.where?.trim() === "") delete next.where;
      return next;
    });
  return made;
}

const hasLimit = ({ over, up_to: upTo }: BillSize): boolean =>
  over !== undefined || upTo !== undefined;

export const draftOf = ({ name, currency, items }: Bill): BillDraft => ({
  name,
  currency,
  items: items.map((item) => withDecimals(item, withDecimalSign)),
});

/** The body that saves the draft, or the field with a number that is not valid. */
export function bodyOf(
  draft: BillDraft,
): { body: BillDraft & { items: BillItem[] } } | { wrong: string } {
  let wrong = "";
  const items = draft.items.map((item, i) =>
    withDecimals(item, (typed, field) => {
      const decimal = decimalOf(typed);
      if (decimal === null) wrong ||= `items[${i}].${field}`;
      return decimal ?? typed;
    }),
  );
  return wrong ? { wrong } : { body: { name: draft.name.trim(), currency: draft.currency, items } };
}

/** Splits a field of a problem, such as "items[3].rules[0].where". `index` is null outside items. */
export function placeOf(field: string): { index: number | null; within: string } {
  const found = /^items\[(\d+)\]\.?(.*)$/.exec(field);
  return found ? { index: Number(found[1]), within: found[2]! } : { index: null, within: field };
}

/** Formats a decimal number of the server with the decimal sign of the page. */
export const shownDecimal = (decimal: string): string => withDecimalSign(decimal);
