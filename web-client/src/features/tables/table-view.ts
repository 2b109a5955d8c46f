// One table as it is looked at below the stage, under the layer whose areas it shows: its rows,
// what is written into them and which are chosen.

import { ApiError, type Api } from "../../net/api";
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

const kRefreshAfter_ms = 250; // a stroke is many edits, and records often come several at once
const kMostHighlighted = 10_000; // that are named one by one

export interface TableViewHost {
  model_id: string;
  layer_id: number;
  table_id: number;
  table(): Table | null; // as it is now
  changed(): void;
  columns_changed(): Promise<void>;
  /** On the model; null: nothing. */
  highlight(what: Highlight | null): void;
  fly_to(bounds: NonNullable<Extent["bounds"]>): void;
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
  lights_up = true;
  /** And the others are not drawn. */
  isolates = false;
  /** Where they lie, once it is known. */
  extent: Extent | null = null;

  private timer_: ReturnType<typeof setTimeout> | null = null;
  private refreshes_rows_ = false;
  private highlighted_ = "null"; // as JSON
  private flies_ = false; // once the extent is here

  constructor(
    private readonly api_: Api,
    private readonly host_: TableViewHost,
  ) {
    const place = { model: host_.model_id, layer: host_.layer_id };
    this.rows = new RecordRows({
      ask: (query) => api_.records(place, query),
      changed: () => this.changed(),
      measures_outdated: () => this.refresh_soon(),
    });
    this.edits = new CellEdits(api_, {
      table: host_.table_id,
      row: (key) => this.rows.find(key),
      put: (record) => this.rows.put(record),
      changed: host_.changed,
    });
  }

  private changed(): void {
    this.light_up();
    this.host_.changed();
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

  // ── order and choice
  // ──────────────────────────────────────────────────────────────────────────────────────────────

  /**
   * `name`: the slug of a column, `key` or `area_m2`. Again turns the order round; a third time
   * takes it away.
   */
  sort(name: string): void {
    const { sortby } = this.rows;
    this.rows.set_query({
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
  select_rows(from: number, to: number): void {
    for (let index = Math.min(from, to); index <= Math.max(from, to); ++index) {
      const row = this.rows.row(index);
      if (row) this.selected.add(row.key);
    }
    this.changed();
  }
  select_none(): void {
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
    if (!this.lights_up) return null;
    if (this.selected.size > 0)
      return { keys: [...this.selected].slice(0, kMostHighlighted), ...isolate };
    return filter !== "" && settled ? { filter, ...isolate } : null;
  }
  set_lights_up(lights_up: boolean): void {
    this.lights_up = lights_up;
    this.changed();
  }
  set_isolates(isolates: boolean): void {
    this.isolates = isolates;
    if (isolates) this.lights_up = true;
    this.changed();
  }
  /** To where they are. */
  fly(): void {
    this.flies_ = true;
    void this.find_extent();
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

  private light_up(): void {
    const { highlight } = this;
    const text = JSON.stringify(highlight);
    if (text === this.highlighted_) return;
    this.highlighted_ = text;
    this.extent = null;
    this.host_.highlight(highlight);
    void this.find_extent();
  }

  private async find_extent(): Promise<void> {
    const { highlight, highlighted_ } = this;
    if (!highlight) return;
    try {
      const extent = await this.api_.extent(this.host_.model_id, this.host_.layer_id, highlight);
      if (this.highlighted_ !== highlighted_) return;
      this.extent = extent;
      if (this.flies_ && extent.bounds) this.host_.fly_to(extent.bounds);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // what is wrong with the filter, the rows tell
    }
    this.flies_ = false;
    this.host_.changed();
  }

  // ── changes
  // ───────────────────────────────────────────────────────────────────────────────────────────────────────

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

  private async turn(
    step: () => Promise<TableChanged>,
    told: (created: number, changed: number, deleted: number) => string,
  ): Promise<void> {
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

  // ── what others do
  // ────────────────────────────────────────────────────────────────────────────────────────────────

  on_record(event: RecordEvent): void {
    if (event.event === "changed" && event.record) {
      // where it stands: rows that jump away while somebody reads them help nobody
      this.rows.put(event.record);
      this.refresh_soon(false);
      return;
    }
    if (event.event === "deleted") this.selected.delete(event.key);
    this.refresh_soon();
  }

  /** Rows came or went, or their areas changed; or only what the filter finds of them. */
  refresh_soon(rows = true): void {
    this.refreshes_rows_ ||= rows;
    if (this.timer_) return;
    this.timer_ = setTimeout(() => {
      this.timer_ = null;
      if (this.refreshes_rows_) this.rows.refresh();
      this.refreshes_rows_ = false;
      void this.find_extent();
    }, kRefreshAfter_ms);
  }

  stop(): void {
    this.host_.highlight(null);
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
  }
}
