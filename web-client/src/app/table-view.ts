// One table as it is looked at below the stage, under the layer whose areas it shows: its rows, what is written into them and which
// are chosen.

import { ApiError, type Api } from "../core/api";
import type { CellValue, RecordEvent, Table, TableChanged } from "../core/protocol.gen";
import { CellEdits } from "./cell-edits";
import { notices } from "./notices";
import { RecordRows } from "./record-rows";
import { texts } from "./texts";

const kRefreshAfter_ms = 250; // a stroke is many edits, and records often come several at once

export interface TableViewHost {
  model_id: string;
  layer_id: number;
  table_id: number;
  table(): Table | null; // as it is now
  changed(): void;
  columns_changed(): Promise<void>;
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

  private timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly api_: Api,
    private readonly host_: TableViewHost,
  ) {
    const place = { model: host_.model_id, layer: host_.layer_id };
    this.rows = new RecordRows({ ask: (query) => api_.records(place, query), changed: host_.changed });
    this.edits = new CellEdits(api_, {
      table: host_.table_id,
      row: (key) => this.rows.find(key),
      put: (record) => this.rows.put(record),
      changed: host_.changed,
    });
  }

  get layer_id(): number {
    return this.host_.layer_id;
  }
  get table_id(): number {
    return this.host_.table_id;
  }
  get table(): Table | null {
    return this.host_.table();
  }

  // ── order and choice ──────────────────────────────────────────────────────────────────────────────────────────────

  /** `name`: the slug of a column, `key` or `area_m2`. Again turns the order round; a third time takes it away. */
  sort(name: string): void {
    const { sortby } = this.rows;
    this.rows.set_query({ sortby: sortby === name ? `-${name}` : sortby === `-${name}` ? "" : name });
  }

  select(key: number, how: "only" | "toggle"): void {
    const had = this.selected.has(key);
    this.told = "";
    if (how === "only") this.selected.clear();
    if (how === "toggle" && had) this.selected.delete(key);
    else this.selected.add(key);
    this.host_.changed();
  }
  /** All rows between the two that are here. */
  select_rows(from: number, to: number): void {
    for (let index = Math.min(from, to); index <= Math.max(from, to); ++index) {
      const row = this.rows.row(index);
      if (row) this.selected.add(row.key);
    }
    this.host_.changed();
  }
  select_none(): void {
    this.selected.clear();
    this.host_.changed();
  }

  /** Brings the record into sight: the panel scrolls there. */
  show(key: number): void {
    this.selected.clear();
    this.selected.add(key);
    this.sought = key;
    this.host_.changed();
  }

  // ── changes ───────────────────────────────────────────────────────────────────────────────────────────────────────

  write(key: number, slug: string, value: CellValue, base: CellValue): void {
    this.told = "";
    void this.edits.write(key, slug, value, base);
  }

  async undo(): Promise<void> {
    await this.turn(() => this.api_.undo_table(this.table_id), texts.tables.undone);
  }
  async redo(): Promise<void> {
    await this.turn(() => this.api_.redo_table(this.table_id), texts.tables.redone);
  }

  private async turn(step: () => Promise<TableChanged>, told: (created: number, changed: number, deleted: number) => string): Promise<void> {
    try {
      const what = await step();
      if (what.columns_changed) await this.host_.columns_changed();
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

  // ── what others do ────────────────────────────────────────────────────────────────────────────────────────────────

  on_record(event: RecordEvent): void {
    if (event.event === "changed" && event.record) {
      this.rows.put(event.record); // where it stands: rows that jump away while somebody reads them help nobody
      return;
    }
    if (event.event === "deleted") this.selected.delete(event.key);
    this.refresh_soon();
  }

  /** Rows came or went, or their areas changed. */
  refresh_soon(): void {
    if (this.timer_) return;
    this.timer_ = setTimeout(() => {
      this.timer_ = null;
      this.rows.refresh();
    }, kRefreshAfter_ms);
  }

  stop(): void {
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
  }
}
