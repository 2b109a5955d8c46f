// Counts the records of a table for each value of a column.

import type { FilterValue } from "./column-filter";
import type { CellValue, RecordList } from "../core/protocol.gen";
import type { RecordQuery } from "../net/records";

const kPage = 1000; // the server's limit for one request
const kMostCounted = 20_000; // a larger count would take too long

export interface ValueCounts {
  ofValue: Map<FilterValue, number>;
  /** The number of records without a value. */
  empty: number;
  /** The smallest and largest value, for numbers and texts. */
  least: FilterValue | null;
  greatest: FilterValue | null;
  /** The number of records that were read, of `total` records. */
  counted: number;
  total: number;
}

/**
 * Returns the values of a cell. In a cell with several records, each record is a separate value.
 */
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
