// How many records of a table hold each value of a column.

import type { FilterValue } from "./column-filter";
import type { CellValue, RecordList } from "../core/protocol.gen";
import type { RecordQuery } from "../net/records";

const kPage = 1000; // the most that the server gives at once
const kMostCounted = 20_000; // beyond it a person would wait

export interface ValueCounts {
  ofValue: Map<FilterValue, number>;
  /** Records without a value. */
  empty: number;
  /** Of numbers and texts, as they are ordered. */
  least: FilterValue | null;
  greatest: FilterValue | null;
  /** Records that were looked at, of all. */
  counted: number;
  total: number;
}

/** Each record that a cell names is a value of its own. */
const valuesInCell = (value: CellValue | undefined): FilterValue[] =>
  value === null || value === undefined
    ? []
    : Array.isArray(value)
      ? value.filter((each): each is number => typeof each === "number")
      : [value];

export async function countValues(
  ask: (query: RecordQuery) => Promise<RecordList>,
  slug: string,
): Promise<ValueCounts> {
  const counts: ValueCounts = {
    ofValue: new Map(),
    empty: 0,
    least: null,
    greatest: null,
    counted: 0,
    total: 0,
  };
  do {
    const { records, total } = await ask({ limit: kPage, offset: counts.counted });
    counts.total = total;
    if (records.length === 0) break;
    counts.counted += records.length;
    for (const { values } of records) {
      const held = valuesInCell(values[slug]);
      if (held.length === 0) counts.empty += 1;
      for (const value of new Set(held)) {
        counts.ofValue.set(value, (counts.ofValue.get(value) ?? 0) + 1);
        if (counts.least === null || value < counts.least) counts.least = value;
        if (counts.greatest === null || value > counts.greatest) counts.greatest = value;
      }
    }
  } while (counts.counted < Math.min(counts.total, kMostCounted));
  return counts;
}
