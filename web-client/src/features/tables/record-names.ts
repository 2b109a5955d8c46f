// Names of the records of a table, for relations, legends and the brush. All names are loaded at
// the first use, because the search must be immediate. For very large tables only the first names
// are loaded.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { readRecords } from "../../net/records";
import { labelColumn, labelOfRecord, type NameOfKey } from "../../domain/cells";
import { personLanguages } from "../../core/locale";
import type { Table, TableRecord } from "../../core/protocol.gen";

export interface NamedRecord {
  key: number;
  label: string; // empty if the record has no name
}

const kAtOnce = 1000;
export const kMostNames = 20_000;
const kMostFound = 60;

/** Data from other tables of the project: the order of terms, and names of records. */
export interface OtherNames {
  nameOf: NameOfKey;
  /** Returns the order by key, or null if the table is not known to be a list of terms. */
  places(table: number): ReadonlyMap<number, number> | null;
}
const kNoOthers: OtherNames = { nameOf: () => null, places: () => null };

const collator = new Intl.Collator([...personLanguages()], { numeric: true });

export class RecordNames {
  // the values that form the names
  private _records = new Map<number, Pick<TableRecord, "values">>();
  private _sorted: NamedRecord[] | null = null;
  private _state: "unasked" | "loading" | "loaded" = "unasked";
  private _again = false;
  private _complete = false; // whether _records has every record

  constructor(
    private readonly _api: Api,
    private readonly _table: () => Table,
    private readonly _changed: () => void,
    private readonly _others: OtherNames = kNoOthers,
  ) {}

  /** Returns null if the record does not exist or its name is not loaded yet. */
  label(key: number): string | null {
    this.want();
    const record = this._records.get(key);
    return (record && this.name(record)) || null;
  }

  /** Returns whether the record is known not to exist. */
  lacks(key: number): boolean {
    this.want();
    return this._complete && !this._records.has(key);
  }

  /**
   * Finds records by name or key. Names that start with the text are first, followed by other names
   * that contain it. Both parts follow the order of the term list, or the alphabet of the user's
   * language.
   */
  search(text: string): NamedRecord[] {
    this.want();
    const wanted = text.trim().toLowerCase();
    const begins: NamedRecord[] = [];
    const holds: NamedRecord[] = [];
    for (const { key, label } of this.inOrder()) {
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
    return this._state === "loading";
  }

  put(record: TableRecord): void {
    if (this._state === "unasked") return;
    this._records.set(record.key, record);
    this.reorder();
    this._changed();
  }
  remove(key: number): void {
    if (!this._records.delete(key)) return;
    this.reorder();
    this._changed();
  }
  /** Call this when names or their order may have changed. */
  reorder(): void {
    this._sorted = null;
  }
  /** Call this when many records, or the naming column, have changed. */
  refresh(): void {
    if (this._state === "loading") this._again = true;
    else if (this._state === "loaded") void this.load();
  }

  private name(record: Pick<TableRecord, "values">): string {
    return labelOfRecord(this._table(), record, undefined, this._others.nameOf);
  }

  private inOrder(): NamedRecord[] {
    if (this._sorted) return this._sorted;
    const table = this._table();
    const title = labelColumn(table);
    const own = table.kind === "terms" ? this._others.places(table.id) : null;
    const ofTitle = !own && title?.kind === "term" ? this._others.places(title.target ?? 0) : null;
    const place = (key: number): number => {
      const named = ofTitle ? this._records.get(key)?.values[title!.slug] : undefined;
      return (
        own?.get(key) ?? (typeof named === "number" ? ofTitle!.get(named) : undefined) ?? Infinity
      );
    };
    const named = [...this._records].map(([key, record]) => ({
      key,
      label: this.name(record),
      place: place(key),
    }));
    // records without a name are last
    const nameless = ({ label }: NamedRecord): number => Number(label === "");
    named.sort((a, b) =>
      a.place === b.place
        ? nameless(a) - nameless(b) || collator.compare(a.label, b.label) || a.key - b.key
        : a.place - b.place,
    );
    return (this._sorted = named.map(({ key, label }) => ({ key, label })));
  }

  private want(): void {
    if (this._state === "unasked") void this.load();
  }

  private async load(): Promise<void> {
    this._state = "loading";
    try {
      do {
        this._again = false;
        const table = this._table();
        const names = new Map<number, Pick<TableRecord, "values">>();
        let complete = false;
        for (let offset = 0; offset < kMostNames; offset += kAtOnce) {
          const sortby = labelColumn(table)?.slug ?? "key";
          const { records, total } = await readRecords(
            this._api,
            { table: table.id },
            { sortby, limit: kAtOnce, offset },
          );
          for (const record of records) names.set(record.key, record);
          complete = offset + kAtOnce >= total;
          if (complete) break;
        }
        this._records = names;
        this.reorder();
        this._complete = complete;
      } while (this._again);
      this._state = "loaded";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._state = "loaded"; // keys are shown instead; the next event repeats the request
    }
    this._changed();
  }
}
