// One table as it is looked at below the stage, under the layer whose areas it shows: its rows,
// what is written into them and which are chosen.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { readRecords } from "../../net/records";
import type {
  CellValue,
  Extent,
  Highlight,
  RecordEvent,
  Table,
  TableChanged,
} from "../../core/protocol.gen";
import { CellEdits } from "./cell-edits";
import { notices } from "../../ui/notices";
import { RecordRows } from "./record-rows";
import { texts } from "../../texts";

const kRefreshAfterMs = 250; // a stroke is many edits, and records often come several at once
const kMostHighlighted = 10_000; // that are named one by one

export interface TableViewHost {
  modelId: string;
  layer_id: number;
  table_id: number;
  table(): Table | null; // as it is now
  changed(): void;
  columnsChanged(): Promise<void>;
  /** On the model; null: nothing. */
  highlight(what: Highlight | null): void;
  flyTo(bounds: NonNullable<Extent["bounds"]>): void;
}

export class TableView {
  readonly rows: RecordRows;
  readonly edits: CellEdits;
  /** Keys of the rows that are chosen. */
  readonly selected = new Set<number>();
  /** What undo or redo did; a notice would lie over the model. */
  told = "";
  /** A record to be brought into sight. */
  sought: number | null = null;

  /** Rows that are chosen, or the filter finds, stand out on the model. */
  lightsUp = true;
  /** And the others are not drawn. */
  isolates = false;
  /** Where they lie, once it is known. */
  extent: Extent | null = null;

  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _refreshesRows = false;
  private _highlighted = "null"; // as JSON
  private _flies = false; // once the extent is here

  constructor(
    private readonly _api: Api,
    private readonly _host: TableViewHost,
  ) {
    const place = { model: _host.modelId, layer: _host.layer_id };
    this.rows = new RecordRows({
      ask: (query) => readRecords(_api, place, query),
      changed: () => this.changed(),
      measuresOutdated: () => this.refreshSoon(),
    });
    this.edits = new CellEdits(_api, {
      table: _host.table_id,
      row: (key) => this.rows.find(key),
      put: (record) => this.rows.put(record),
      changed: _host.changed,
    });
  }

  private changed(): void {
    this.lightUp();
    this._host.changed();
  }

  get layerId(): number {
    return this._host.layer_id;
  }
  get tableId(): number {
    return this._host.table_id;
  }
  get table(): Table | null {
    return this._host.table();
  }

  // ── order and choice
  // ──────────────────────────────────────────────────────────────────────────────────────────────

  /**
   * `name`: the slug of a column, `key` or `area_m2`. Again turns the order round; a third time
   * takes it away.
   */
  sort(name: string): void {
    const { sortby } = this.rows;
    this.rows.setQuery({
      sortby: sortby === name ? `-${name}` : sortby === `-${name}` ? "" : name,
    });
  }

  select(key: number, how: "only" | "toggle"): void {
    const had = this.selected.has(key);
    this.told = "";
    if (how === "only") this.selected.clear();
    if (how === "toggle" && had) this.selected.delete(key);
    else this.selected.add(key);
    this.changed();
  }
  /** All rows between the two that are here. */
  selectRows(from: number, to: number): void {
    for (let index = Math.min(from, to); index <= Math.max(from, to); ++index) {
      const row = this.rows.row(index);
      if (row) this.selected.add(row.key);
    }
    this.changed();
  }
  selectNone(): void {
    this.selected.clear();
    this.changed();
  }

  /** Brings the record into sight: the panel scrolls there. */
  show(key: number): void {
    this.selected.clear();
    this.selected.add(key);
    this.sought = key;
    this.changed();
  }

  // ── on the model
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  /** What is to stand out: the rows that are chosen, else those that the filter finds. */
  get highlight(): Highlight | null {
    const { filter, settled } = this.rows;
    const isolate = this.isolates ? { isolate: true } : {};
    if (!this.lightsUp) return null;
    if (this.selected.size > 0)
      return { keys: [...this.selected].slice(0, kMostHighlighted), ...isolate };
    return filter !== "" && settled ? { filter, ...isolate } : null;
  }
  setLightsUp(lightsUp: boolean): void {
    this.lightsUp = lightsUp;
    this.changed();
  }
  setIsolates(isolates: boolean): void {
    this.isolates = isolates;
    if (isolates) this.lightsUp = true;
    this.changed();
  }
  /** To where they are. */
  fly(): void {
    this._flies = true;
    void this.findExtent();
  }

  /**
   * What others wrote brought records into the filter, or took some out of it, that the rows do not
   * follow by themselves.
   */
  get outdated(): boolean {
    const { extent, rows } = this;
    return (
      extent !== null &&
      rows.loaded &&
      this.selected.size === 0 &&
      rows.filter !== "" &&
      extent.records !== rows.total
    );
  }

  private lightUp(): void {
    const { highlight } = this;
    const text = JSON.stringify(highlight);
    if (text === this._highlighted) return;
    this._highlighted = text;
    this.extent = null;
    this._host.highlight(highlight);
    void this.findExtent();
  }

  private async findExtent(): Promise<void> {
    const { highlight, _highlighted } = this;
    if (!highlight) return;
    try {
      const extent = await this._api.json("POST /models/{model}/layers/{layer}/extent", {
        path: { model: this._host.modelId, layer: this._host.layer_id },
        body: highlight,
      });
      if (this._highlighted !== _highlighted) return;
      this.extent = extent;
      if (this._flies && extent.bounds) this._host.flyTo(extent.bounds);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // what is wrong with the filter, the rows tell
    }
    this._flies = false;
    this._host.changed();
  }

  // ── changes
  // ───────────────────────────────────────────────────────────────────────────────────────────────────────

  write(key: number, slug: string, value: CellValue, base: CellValue): void {
    this.told = "";
    void this.edits.write(key, slug, value, base);
  }

  async undo(): Promise<void> {
    await this.turn(
      () => this._api.json("POST /tables/{table}/undo", { path: { table: this.tableId } }),
      texts.tables.undone,
    );
  }
  async redo(): Promise<void> {
    await this.turn(
      () => this._api.json("POST /tables/{table}/redo", { path: { table: this.tableId } }),
      texts.tables.redone,
    );
  }

  private async turn(
    step: () => Promise<TableChanged>,
    told: (created: number, changed: number, deleted: number) => string,
  ): Promise<void> {
    try {
      const what = await step();
      if (what.columns_changed) await this._host.columnsChanged();
      this.sought = what.changed[0] ?? what.created[0] ?? null;
      this.told = told(what.created.length, what.changed.length, what.deleted.length);
      this.rows.refresh();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  /** It was deleted here. */
  forget(key: number): void {
    this.selected.delete(key);
    this.rows.refresh();
  }

  // ── what others do
  // ────────────────────────────────────────────────────────────────────────────────────────────────

  onRecord(event: RecordEvent): void {
    if (event.event === "changed" && event.record) {
      // where it stands: rows that jump away while somebody reads them help nobody
      this.rows.put(event.record);
      this.refreshSoon(false);
      return;
    }
    if (event.event === "deleted") this.selected.delete(event.key);
    this.refreshSoon();
  }

  /** Rows came or went, or their areas changed; or only what the filter finds of them. */
  refreshSoon(rows = true): void {
    this._refreshesRows ||= rows;
    if (this._timer) return;
    this._timer = setTimeout(() => {
      this._timer = null;
      if (this._refreshesRows) this.rows.refresh();
      this._refreshesRows = false;
      void this.findExtent();
    }, kRefreshAfterMs);
  }

  stop(): void {
    this._host.highlight(null);
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }
}
