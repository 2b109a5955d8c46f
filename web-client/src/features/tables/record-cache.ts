// Records that were looked at, kept until something tells that they changed. The oldest make room
// for new ones.

import { ApiError, type Api } from "../../net/api";
import type { TableRecord } from "../../core/protocol.gen";

const kMostKept = 300;

export class RecordShelf {
  /** A symbol: it was asked for; null: there is none. */
  private readonly kept_ = new Map<string, TableRecord | symbol | null>();

  constructor(
    private readonly api_: Api,
    private readonly changed_: () => void,
  ) {}

  /** Null until it is here, and where there is none; it is asked for once. */
  find(table: number, key: number): TableRecord | null {
    const known = this.kept_.get(name_of(table, key));
    if (known === undefined) void this.load(table, key);
    return typeof known === "object" ? known : null;
  }

  /** What was known of it is so no longer. */
  forget(table: number, key: number): void {
    if (this.kept_.delete(name_of(table, key))) this.changed_();
  }
  forget_table(table: number): void {
    for (const name of [...this.kept_.keys()])
      if (name.startsWith(name_of(table, ""))) this.kept_.delete(name);
  }
  forget_all(): void {
    this.kept_.clear();
  }

  private async load(table: number, key: number): Promise<void> {
    const name = name_of(table, key);
    const asked = Symbol();
    this.kept_.set(name, asked);
    const [oldest] = this.kept_.keys();
    if (this.kept_.size > kMostKept && oldest !== undefined) this.kept_.delete(oldest);
    let found: TableRecord | null = null;
    try {
      found = await this.api_.record({ table }, key);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // paint without a record
    }
    if (this.kept_.get(name) === asked) this.kept_.set(name, found);
    this.changed_();
  }
}

const name_of = (table: number, key: number | ""): string => `${table} ${key}`;
