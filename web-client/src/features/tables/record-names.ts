// What the records of a table are called: for relations, legends and the brush. Asked for once
// somebody needs a name, all at once, since a search over them must not wait; of very large tables
// the first ones.

import { ApiError, type Api } from "../../net/api";
import { label_column, label_of_record, type NameOfKey } from "../../domain/cells";
import { person_languages } from "../../core/locale";
import type { Table, TableRecord } from "../../core/protocol.gen";

export interface NamedRecord {
  key: number;
  label: string; // may be empty
}

const kAtOnce = 1000;
export const kMostNames = 20_000;
const kMostFound = 60;

/**
 * Of other tables of the project: their terms' places in the list, and what their records are
 * called.
 */
export interface OtherNames {
  name_of: NameOfKey;
  /** By key; null: the table is no list of terms, as far as is known. */
  places(table: number): ReadonlyMap<number, number> | null;
}
const kNoOthers: OtherNames = { name_of: () => null, places: () => null };

const collator = new Intl.Collator([...person_languages()], { numeric: true });

export class RecordNames {
  private records_ = new Map<number, Pick<TableRecord, "values">>(); // of what names them
  private sorted_: NamedRecord[] | null = null;
  private state_: "unasked" | "loading" | "loaded" = "unasked";
  private again_ = false;
  private complete_ = false; // every record is in names_

  constructor(
    private readonly api_: Api,
    private readonly table_: () => Table,
    private readonly changed_: () => void,
    private readonly others_: OtherNames = kNoOthers,
  ) {}

  /** Null: there is no such record, or its name is not known yet. */
  label(key: number): string | null {
    this.want();
    const record = this.records_.get(key);
    return (record && this.name(record)) || null;
  }

  /** Whether it is known that there is no such record. */
  lacks(key: number): boolean {
    this.want();
    return this.complete_ && !this.records_.has(key);
  }

  /**
   * By the tree of the list, or the alphabet of the person's language. Where names begin with the
   * text first, then where they hold it; by key, too.
   */
  search(text: string): NamedRecord[] {
    this.want();
    const wanted = text.trim().toLowerCase();
    const begins: NamedRecord[] = [];
    const holds: NamedRecord[] = [];
    for (const { key, label } of this.in_order()) {
      const name = label.toLowerCase();
      if (name.startsWith(wanted) || String(key) === wanted) begins.push({ key, label });
      else if (
        holds.length < kMostFound &&
        (name.includes(wanted) || String(key).startsWith(wanted))
      )
        holds.push({ key, label });
      if (begins.length >= kMostFound) break;
    }
    return [...begins, ...holds].slice(0, kMostFound);
  }

  get loading(): boolean {
    return this.state_ === "loading";
  }

  put(record: TableRecord): void {
    if (this.state_ === "unasked") return;
    this.records_.set(record.key, record);
    this.reorder();
    this.changed_();
  }
  remove(key: number): void {
    if (!this.records_.delete(key)) return;
    this.reorder();
    this.changed_();
  }
  /** What they are called by, or sorted by, may be another. */
  reorder(): void {
    this.sorted_ = null;
  }
  /** Many changed, or the column that names them. */
  refresh(): void {
    if (this.state_ === "loading") this.again_ = true;
    else if (this.state_ === "loaded") void this.load();
  }

  private name(record: Pick<TableRecord, "values">): string {
    return label_of_record(this.table_(), record, undefined, this.others_.name_of);
  }

  private in_order(): NamedRecord[] {
    if (this.sorted_) return this.sorted_;
    const table = this.table_();
    const title = label_column(table);
    const own = table.kind === "terms" ? this.others_.places(table.id) : null;
    const of_title = !own && title?.kind === "term" ? this.others_.places(title.target ?? 0) : null;
    const place = (key: number): number => {
      const named = of_title ? this.records_.get(key)?.values[title!.slug] : undefined;
      return (
        own?.get(key) ?? (typeof named === "number" ? of_title!.get(named) : undefined) ?? Infinity
      );
    };
    const named = [...this.records_].map(([key, record]) => ({
      key,
      label: this.name(record),
      place: place(key),
    }));
    const nameless = ({ label }: NamedRecord): number => Number(label === ""); // they come last
    named.sort((a, b) =>
      a.place === b.place
        ? nameless(a) - nameless(b) || collator.compare(a.label, b.label) || a.key - b.key
        : a.place - b.place,
    );
    return (this.sorted_ = named.map(({ key, label }) => ({ key, label })));
  }

  private want(): void {
    if (this.state_ === "unasked") void this.load();
  }

  private async load(): Promise<void> {
    this.state_ = "loading";
    try {
      do {
        this.again_ = false;
        const table = this.table_();
        const names = new Map<number, Pick<TableRecord, "values">>();
        let complete = false;
        for (let offset = 0; offset < kMostNames; offset += kAtOnce) {
          const sortby = label_column(table)?.slug ?? "key";
          const { records, total } = await this.api_.records(
            { table: table.id },
            { sortby, limit: kAtOnce, offset },
          );
          for (const record of records) names.set(record.key, record);
          complete = offset + kAtOnce >= total;
          if (complete) break;
        }
        this.records_ = names;
        this.reorder();
        this.complete_ = complete;
      } while (this.again_);
      this.state_ = "loaded";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.state_ = "loaded"; // the numbers stand for them; the next event asks again
    }
    this.changed_();
  }
}
