// A table that is open below the stage: its rows, edits and selection. The table shows the areas of
// the records on one layer.

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

const kRefreshAfterMs = 250; // a stroke has many edits, and several records often arrive together
const kMostHighlighted = 10_000; // the server's limit for highlights by key

export interface TableViewHost {
  modelId: string;
  layer_id: number;
  table_id: number;
  table(): Table | null; // the current definition of the table
  changed(): void;
  columnsChanged(): Promise<void>;
  /** Sets the highlight on the model. Null removes it. */
  highlight(what: Highlight | null): void;
  flyTo(bounds: NonNullable<Extent["bounds"]>): void;
}

export class TableView {
  readonly rows: RecordRows;
  readonly edits: CellEdits;
  /** The keys of the selected rows. */
  readonly selected = new Set<number>();
  /**
   * The result of undo or redo, as a text in the bar above the table, because a notice would cover
   * the model.
   */
  told = "";
  /** The key of the record to scroll to. */
  sought: number | null = null;

  /** Whether the selected or filtered rows are highlighted on the model. */
  lightsUp = true;
  /** Whether the other records are hidden. */
  isolates = false;
  /** The bounds of the highlighted records on the model; null while they are unknown. */
  extent: Extent | null = null;

  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _refreshesRows = false;
  private _highlighted = "null"; // the last highlight as JSON
  private _flies = false; // whether the camera moves when the extent arrives

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

  // ── order and selection ────────────────────────────────────────────────────────────────────────

  /**
   * `name` is the slug of a column, `key` or `area_m2`. A second call reverses the order, and a
   * third one removes it.
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
  /** Selects all loaded rows between two rows. */
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

  /** Scrolls the panel to the record. */
  show(key: number): void {
    this.selected.clear();
    this.selected.add(key);
    this.sought = key;
    this.changed();
  }

  // ── on the model ───────────────────────────────────────────────────────────────────────────────

  /** The highlight on the model: the selected rows, or else the filtered ones. */
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
  /** Moves the camera to the highlighted records. */
  fly(): void {
    this._flies = true;
    void this.findExtent();
  }

  /**
   * Whether changes by other users moved records into or out of the filter. The rows do not follow
   * such changes automatically.
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
      if (!(error instanceof ApiError)) throw error; // the rows show problems of the filter
    }
    this._flies = false;
    this._host.changed();
  }

  // ── changes ────────────────────────────────────────────────────────────────────────────────────

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

  /** Call this after the record was deleted on this page. */
  forget(key: number): void {
    this.selected.delete(key);
    this.rows.refresh();
  }

  // ── changes by others ──────────────────────────────────────────────────────────────────────────

  onRecord(event: RecordEvent): void {
    if (event.event === "changed" && event.record) {
      // the row keeps its position, because moving rows would disturb readers
      this.rows.put(event.record);
      this.refreshSoon(false);
      return;
    }
    if (event.event === "deleted") this.selected.delete(event.key);
    this.refreshSoon();
  }

  /**
   * Loads the data again after rows or areas have changed. If `rows` is false, loads only the
   * extent.
   */
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
