// The records of a table in an order and by a filter, as far as somebody has looked at them. Rows
// are asked for in pages; what was seen stays until its newer state is here, so that nothing
// flickers.

import { ApiError, type RecordQuery } from "../../net/api";
import { same_value } from "../../domain/cells";
import { marks_of } from "../../domain/marks";
import type { RecordList, TableRecord } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";

export const kPageRows = 100;
const kSearchedRows = 1000; // asked for at once while a record is looked for
const kMostKeptPages = 500;
const kMostAtOnce = 2;

interface Page {
  rows: TableRecord[];
  generation: number; // of the question that it answers
}

export interface RecordRowsHost {
  ask(query: RecordQuery): Promise<RecordList>;
  changed(): void;
  /** A record has other lines or points than before: what it measures on the model is not known. */
  measures_outdated(): void;
}

export class RecordRows {
  total = 0;
  loaded = false; // once
  /** Why there is no answer: of the filter, or of the server. */
  problem: ProblemBody | null = null;

  private sortby_ = "";
  private filter_ = "";
  private readonly pages_ = new Map<number, Page>();
  private generation_ = 0;
  private asked_ = new Set<number>(); // pages of this generation that are on their way
  private wanted_: [number, number] = [0, 0];
  private replaces_ = false; // the next answer is of another order: what is shown goes with it

  constructor(private readonly host_: RecordRowsHost) {}

  get sortby(): string {
    return this.sortby_;
  }
  get filter(): string {
    return this.filter_;
  }

  /** What is here answers the filter. */
  get settled(): boolean {
    return this.loaded && !this.replaces_ && !this.problem;
  }

  row(index: number): TableRecord | null {
    return this.pages_.get(Math.floor(index / kPageRows))?.rows[index % kPageRows] ?? null;
  }

  /** Rows that are to be shown, from first to last. */
  want(first: number, last: number): void {
    this.wanted_ = [
      Math.floor(Math.max(0, first) / kPageRows),
      Math.floor(Math.max(0, last) / kPageRows),
    ];
    this.pump();
  }

  set_query(query: { sortby?: string; filter?: string }): void {
    const { sortby = this.sortby_, filter = this.filter_ } = query;
    if (sortby === this.sortby_ && filter === this.filter_) return;
    this.sortby_ = sortby;
    this.filter_ = filter;
    this.replaces_ = true;
    this.refresh();
  }

  /** Records came, went or changed: all is asked for again as it is looked at. */
  refresh(): void {
    this.generation_ += 1;
    this.asked_ = new Set();
    this.problem = null;
    this.pump();
    this.host_.changed();
  }

  find(key: number): TableRecord | null {
    const index = this.index_of(key);
    return index === null ? null : this.row(index);
  }

  /** Where the record is among the rows that are here. */
  index_of(key: number): number | null {
    for (const [page, { rows }] of this.pages_) {
      const at = rows.findIndex((row) => row.key === key);
      if (at >= 0) return page * kPageRows + at;
    }
    return null;
  }

  /** Where the record is among all rows; null where it is not one of them. */
  async locate(key: number): Promise<number | null> {
    const { generation_ } = this;
    for (let offset = 0; ; offset += kSearchedRows) {
      const here = this.index_of(key);
      if (here !== null) return here;
      if (offset > 0 && offset >= this.total) return null;
      const { records, total } = await this.host_.ask({
        sortby: this.sortby_,
        filter: this.filter_,
        limit: kSearchedRows,
        offset,
      });
      if (generation_ !== this.generation_) return this.locate(key);
      this.take_total(total);
      for (let at = 0; at < records.length; at += kPageRows) {
        this.pages_.set((offset + at) / kPageRows, {
          rows: records.slice(at, at + kPageRows),
          generation: generation_,
        });
      }
      this.host_.changed();
    }
  }

  /** The newest state of a record, in the place where its row is. */
  put(record: TableRecord): void {
    for (const page of this.pages_.values()) {
      const at = page.rows.findIndex((row) => row.key === record.key);
      if (at < 0) continue;
      const before = page.rows[at]!;
      if (record.version < before.version) return; // told before, and late
      // the table's own answers do not know the layer, or its model
      const { area_m2, length_m, point_count } = before;
      const measures = Object.fromEntries(
        Object.entries({ area_m2, length_m, point_count }).filter(
          ([, value]) => value !== undefined,
        ),
      );
      page.rows = page.rows.map((row) =>
        row === before ? { ...record, ...(record.area_m2 === undefined ? measures : {}) } : row,
      );
      this.host_.changed();
      if (record.area_m2 === undefined && !same_marks(before, record))
        this.host_.measures_outdated();
      return;
    }
  }

  private pump(): void {
    const [first, last] = this.wanted_;
    for (let page = first; page <= last; ++page) {
      if (this.asked_.size >= kMostAtOnce || this.problem) return;
      // past the end
      const known = this.loaded && !this.replaces_ && page > 0 && page * kPageRows >= this.total;
      if (known || this.asked_.has(page) || this.pages_.get(page)?.generation === this.generation_)
        continue;
      void this.load(page);
    }
  }

  private async load(page: number): Promise<void> {
    const { generation_ } = this;
    this.asked_.add(page);
    try {
      const query = {
        sortby: this.sortby_,
        filter: this.filter_,
        limit: kPageRows,
        offset: page * kPageRows,
      };
      const { records, total } = await this.host_.ask(query);
      if (generation_ !== this.generation_) return;
      if (this.replaces_) this.pages_.clear();
      this.replaces_ = false;
      this.take_total(total);
      this.pages_.delete(page); // the newest is the last
      this.pages_.set(page, { rows: records, generation: generation_ });
      for (const old of this.pages_.keys()) {
        if (this.pages_.size <= kMostKeptPages) break;
        this.pages_.delete(old);
      }
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (generation_ === this.generation_) this.problem = error.problem;
    } finally {
      if (generation_ === this.generation_) this.asked_.delete(page);
    }
    this.host_.changed();
    this.pump();
  }

  private take_total(total: number): void {
    this.total = total;
    this.loaded = true;
    for (const page of this.pages_.keys()) if (page * kPageRows >= total) this.pages_.delete(page);
  }
}

function same_marks(before: TableRecord, now: TableRecord): boolean {
  const slugs = new Set([...Object.keys(before.values), ...Object.keys(now.values)]);
  return [...slugs].every((slug) =>
    same_value(marks_of(before.values[slug]), marks_of(now.values[slug])),
  );
}
