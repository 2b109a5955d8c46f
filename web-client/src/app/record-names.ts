// What the records of a table are called: for relations, legends and the brush. Asked for once somebody needs a name, all at once,
// since a search over them must not wait; of very large tables the first ones.

import { ApiError, type Api } from "../core/api";
import { label_column, label_of_record } from "../core/cells";
import type { Table, TableRecord } from "../core/protocol.gen";

export interface NamedRecord {
  key: number;
  label: string; // may be empty
}

const kAtOnce = 1000;
export const kMostNames = 20_000;
const kMostFound = 60;

export class RecordNames {
  private names_ = new Map<number, string>();
  private state_: "unasked" | "loading" | "loaded" = "unasked";
  private again_ = false;
  private complete_ = false; // every record is in names_

  constructor(
    private readonly api_: Api,
    private readonly table_: () => Table,
    private readonly changed_: () => void,
  ) {}

  /** Null: there is no such record, or its name is not known yet. */
  label(key: number): string | null {
    this.want();
    return this.names_.get(key) || null;
  }

  /** Whether it is known that there is no such record. */
  lacks(key: number): boolean {
    this.want();
    return this.complete_ && !this.names_.has(key);
  }

  /** Where names begin with the text first, then where they hold it; by key, too. */
  search(text: string): NamedRecord[] {
    this.want();
    const wanted = text.trim().toLowerCase();
    const begins: NamedRecord[] = [];
    const holds: NamedRecord[] = [];
    for (const [key, label] of this.names_) {
      const name = label.toLowerCase();
      if (name.startsWith(wanted) || String(key) === wanted) begins.push({ key, label });
      else if (holds.length < kMostFound && (name.includes(wanted) || String(key).startsWith(wanted))) holds.push({ key, label });
      if (begins.length >= kMostFound) break;
    }
    return [...begins, ...holds].slice(0, kMostFound);
  }

  get loading(): boolean {
    return this.state_ === "loading";
  }

  put(record: TableRecord): void {
    if (this.state_ === "unasked") return;
    this.names_.set(record.key, label_of_record(this.table_(), record));
    this.changed_();
  }
  remove(key: number): void {
    if (this.names_.delete(key)) this.changed_();
  }
  /** Many changed, or the column that names them. */
  refresh(): void {
    if (this.state_ === "loading") this.again_ = true;
    else if (this.state_ === "loaded") void this.load();
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
        const names = new Map<number, string>();
        let complete = false;
        for (let offset = 0; offset < kMostNames; offset += kAtOnce) {
          const sortby = label_column(table)?.slug ?? "key";
          const { records, total } = await this.api_.records({ table: table.id }, { sortby, limit: kAtOnce, offset });
          for (const record of records) names.set(record.key, label_of_record(table, record));
          complete = offset + kAtOnce >= total;
          if (complete) break;
        }
        this.names_ = names;
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
