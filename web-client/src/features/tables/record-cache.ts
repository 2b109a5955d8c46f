// A cache of viewed records. It keeps a record until an event reports a change. New records replace
// the oldest ones.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { readRecord } from "../../net/records";
import type { TableRecord } from "../../core/protocol.gen";

const kMostKept = 300;

export class RecordCache {
  /** A symbol means that the record was requested. Null means that it does not exist. */
  private readonly _kept = new Map<string, TableRecord | symbol | null>();

  constructor(
    private readonly _api: Api,
    private readonly _changed: () => void,
  ) {}

  /** Returns null if the record does not exist or is not loaded yet. Requests it once. */
  find(table: number, key: number): TableRecord | null {
    const known = this._kept.get(nameOf(table, key));
    if (known === undefined) void this.load(table, key);
    return typeof known === "object" ? known : null;
  }

  /** Call this after a change to the record. */
  forget(table: number, key: number): void {
    if (this._kept.delete(nameOf(table, key))) this._changed();
  }
  forgetTable(table: number): void {
    for (const name of [...this._kept.keys()])
      if (name.startsWith(nameOf(table, ""))) this._kept.delete(name);
  }
  forgetAll(): void {
    this._kept.clear();
  }

  private async load(table: number, key: number): Promise<void> {
    const name = nameOf(table, key);
    const asked = Symbol();
    this._kept.set(name, asked);
    const [oldest] = this._kept.keys();
    if (this._kept.size > kMostKept && oldest !== undefined) this._kept.delete(oldest);
    let found: TableRecord | null = null;
    try {
      found = await readRecord(this._api, { table }, key);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // painted keys may have no record
    }
    if (this._kept.get(name) === asked) this._kept.set(name, found);
    this._changed();
  }
}

const nameOf = (table: number, key: number | ""): string => `${table} ${key}`;
