// The viewed rows of a table, with an order and a filter. Rows are requested in pages. An old page
// stays until the new one arrives, which avoids flicker.

import { ApiError } from "../../net/api-error";
import type { RecordQuery } from "../../net/records";
import { sameValue } from "../../domain/cells";
import { marksOf } from "../../domain/marks";
import type { RecordList, TableRecord } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";

export const kPageRows = 100;
const kSearchedRows = 1000; // number of rows per request during a search for a record
const kMostKeptPages = 500;
const kMostAtOnce = 2;

interface Page {
  rows: TableRecord[];
  generation: number; // the generation of the request
}

export interface RecordRowsHost {
  ask(query: RecordQuery): Promise<RecordList>;
  changed(): void;
  /**
   * Call this after a change to a record's lines or points. Until the next response, its measures
   * on the model are unknown.
   */
  measuresOutdated(): void;
}

export class RecordRows {
  total = 0;
  loaded = false; // whether rows were loaded at least once
  /** The problem of the filter or of the server. */
  problem: ProblemBody | null = null;

  private _sortby = "";
  private _filter = "";
  private readonly _pages = new Map<number, Page>();
  private _generation = 0;
  private _asked = new Set<number>(); // the pages that this generation has requested
  private _wanted: [number, number] = [0, 0];
  private _replaces = false; // the next response has another order and replaces all pages

  constructor(private readonly _host: RecordRowsHost) {}

  get sortby(): string {
    return this._sortby;
  }
  get filter(): string {
    return this._filter;
  }

  /** Whether the loaded rows match the filter. */
  get settled(): boolean {
    return this.loaded && !this._replaces && !this.problem;
  }

  row(index: number): TableRecord | null {
    return this._pages.get(Math.floor(index / kPageRows))?.rows[index % kPageRows] ?? null;
  }

  /** Requests the rows from `first` to `last`. */
  want(first: number, last: number): void {
    this._wanted = [
      Math.floor(Math.max(0, first) / kPageRows),
      Math.floor(Math.max(0, last) / kPageRows),
    ];
    this.pump();
  }

  setQuery(query: { sortby?: string; filter?: string }): void {
    const { sortby = this._sortby, filter = this._filter } = query;
    if (sortby === this._sortby && filter === this._filter) return;
    this._sortby = sortby;
    this._filter = filter;
    this._replaces = true;
    this.refresh();
  }

  /** Call this after records were added, removed or changed. Viewed rows are requested again. */
  refresh(): void {
    this._generation += 1;
    this._asked = new Set();
    this.problem = null;
    this.pump();
    this._host.changed();
  }

  find(key: number): TableRecord | null {
    const index = this.indexOf(key);
    return index === null ? null : this.row(index);
  }

  /** Returns the record's index among the loaded rows. */
  indexOf(key: number): number | null {
    for (const [page, { rows }] of this._pages) {
      const at = rows.findIndex((row) => row.key === key);
      if (at >= 0) return page * kPageRows + at;
    }
    return null;
  }

  /** Returns the record's index among all rows, or null if the rows do not contain it. */
  async locate(key: number): Promise<number | null> {
    const { _generation } = this;
    for (let offset = 0; ; offset += kSearchedRows) {
      const here = this.indexOf(key);
      if (here !== null) return here;
      if (offset > 0 && offset >= this.total) return null;
      const { records, total } = await this._host.ask({
        sortby: this._sortby,
        filter: this._filter,
        limit: kSearchedRows,
        offset,
      });
      if (_generation !== this._generation) return this.locate(key);
      this.takeTotal(total);
      for (let at = 0; at < records.length; at += kPageRows) {
        this._pages.set((offset + at) / kPageRows, {
          rows: records.slice(at, at + kPageRows),
          generation: _generation,
        });
      }
      this._host.changed();
    }
  }

  /** Replaces a loaded record by its latest version. */
  put(record: TableRecord): void {
    for (const page of this._pages.values()) {
      const at = page.rows.findIndex((row) => row.key === record.key);
      if (at < 0) continue;
      const before = page.rows[at]!;
      if (record.version < before.version) return; // the response arrived late
      // responses for the table have no measures, because these depend on layer and model
      const { area_m2: areaM2, length_m: lengthM, point_count: pointCount } = before;
      const measures = Object.fromEntries(
        Object.entries({ area_m2: areaM2, length_m: lengthM, point_count: pointCount }).filter(
          ([, value]) => value !== undefined,
        ),
      );
      page.rows = page.rows.map((row) =>
        row === before ? { ...record, ...(record.area_m2 === undefined ? measures : {}) } : row,
      );
      this._host.changed();
      if (record.area_m2 === undefined && !sameMarks(before, record)) this._host.measuresOutdated();
      return;
    }
  }

  private pump(): void {
    const [first, last] = this._wanted;
    for (let page = first; page <= last; ++page) {
      if (this._asked.size >= kMostAtOnce || this.problem) return;
      // the page is after the last row
      const known = this.loaded && !this._replaces && page > 0 && page * kPageRows >= this.total;
      if (known || this._asked.has(page) || this._pages.get(page)?.generation === this._generation)
        continue;
      void this.load(page);
    }
  }

  private async load(page: number): Promise<void> {
    const { _generation } = this;
    this._asked.add(page);
    try {
      const query = {
        sortby: this._sortby,
        filter: this._filter,
        limit: kPageRows,
        offset: page * kPageRows,
      };
      const { records, total } = await this._host.ask(query);
      if (_generation !== this._generation) return;
      if (this._replaces) this._pages.clear();
      this._replaces = false;
      this.takeTotal(total);
      this._pages.delete(page); // inserted again as the newest page
      this._pages.set(page, { rows: records, generation: _generation });
      for (const old of this._pages.keys()) {
        if (this._pages.size <= kMostKeptPages) break;
        this._pages.delete(old);
      }
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (_generation === this._generation) this.problem = error.problem;
    } finally {
      if (_generation === this._generation) this._asked.delete(page);
    }
    this._host.changed();
    this.pump();
  }

  private takeTotal(total: number): void {
    this.total = total;
    this.loaded = true;
    for (const page of this._pages.keys()) if (page * kPageRows >= total) this._pages.delete(page);
  }
}

function sameMarks(before: TableRecord, now: TableRecord): boolean {
  const slugs = new Set([...Object.keys(before.values), ...Object.keys(now.values)]);
  return [...slugs].every((slug) =>
    sameValue(marksOf(before.values[slug]), marksOf(now.values[slug])),
  );
}
