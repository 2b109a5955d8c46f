// The tables of the project that this page has needed so far: their columns, and what their records
// are called.

import { ApiError, type Api } from "../../net/api";
import { label_of_record } from "../../domain/cells";
import type {
  Bounds,
  Highlight,
  Picked,
  RecordEvent,
  Table,
  TableEvent,
  TableRecord,
} from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { notices } from "../../ui/notices";
import { RecordNames, type OtherNames } from "./record-names";
import { RecordShelf } from "./record-cache";
import { TableView } from "./table-view";
import { TermTree } from "../../session/fields/term-tree";
import { texts } from "../../texts";

export interface TablesHost {
  model_id: string;
  highlight(layer_id: number, what: Highlight | null): void;
  fly_to(bounds: Bounds): void;
  project(): string | null;
  changed(): void;
}

export class Tables {
  /** The table that is open below the stage. */
  view: TableView | null = null;

  /** The record that somebody took from the surface; `record` once it is here. */
  card: { layer: Layer; key: number; record: TableRecord | null } | null = null;

  private readonly tables_ = new Map<number, Table | "asked">();
  private readonly names_ = new Map<number, RecordNames>();
  private readonly terms_ = new Map<number, TermTree>();
  private readonly records_: RecordShelf;

  private readonly others_: OtherNames = {
    name_of: (table, key) => this.label(table, key),
    places: (table) => this.terms(table)?.places ?? null,
  };

  constructor(
    private readonly api_: Api,
    private readonly host_: TablesHost,
  ) {
    this.records_ = new RecordShelf(api_, () => host_.changed());
  }

  /** Null until it is here; it is asked for. */
  find(id: number): Table | null {
    const known = this.tables_.get(id);
    if (known === undefined) void this.load(id);
    return typeof known === "object" ? known : null;
  }

  /** Null until its columns are known. */
  names(id: number): RecordNames | null {
    const table = this.find(id);
    if (!table) return null;
    let names = this.names_.get(id);
    if (!names) {
      names = new RecordNames(
        this.api_,
        () => this.find(id) ?? table,
        this.host_.changed,
        this.others_,
      );
      this.names_.set(id, names);
    }
    return names;
  }

  /** What a record of the table is called; null where it has no name, or none that is known yet. */
  label(id: number, key: number): string | null {
    return this.names(id)?.label(key) ?? null;
  }

  /** Null until it is here, and where there is none. */
  record(id: number, key: number): TableRecord | null {
    return this.records_.find(id, key);
  }

  /** Whether it is known that the table has no such record. */
  lacks(id: number, key: number): boolean {
    return this.names(id)?.lacks(key) ?? false;
  }

  /** What a record that is here is called; empty where it has no name. */
  title(table: Table, record: Pick<TableRecord, "values">): string {
    return label_of_record(table, record, undefined, this.others_.name_of);
  }

  /** What a term is called; null where the table is no list of terms, or its name is not known. */
  term(id: number, key: number): string | null {
    return this.find(id)?.kind === "terms" ? this.label(id, key) : null;
  }

  /** Null: the table is no list of terms, as far as is known. */
  terms(id: number): TermTree | null {
    if (this.find(id)?.kind !== "terms") return null;
    let terms = this.terms_.get(id);
    if (!terms) {
      terms = new TermTree(this.api_, id, () => {
        for (const names of this.names_.values()) names.reorder();
        this.host_.changed();
      });
      this.terms_.set(id, terms);
    }
    return terms;
  }

  /** All of the project, for a choice among them. */
  async all(): Promise<Table[]> {
    const project = this.host_.project();
    if (project === null) return [];
    const tables = await this.api_.tables(project);
    for (const table of tables) this.tables_.set(table.id, table);
    return tables;
  }

  open(layer: Layer): void {
    if (layer.table === undefined || this.view?.layer_id === layer.id) return;
    this.view?.stop();
    this.view = new TableView(this.api_, {
      model_id: this.host_.model_id,
      layer_id: layer.id,
      table_id: layer.table,
      table: () => this.find(layer.table!),
      changed: this.host_.changed,
      columns_changed: () => this.load(layer.table!),
      highlight: (what) => this.host_.highlight(layer.id, what),
      fly_to: this.host_.fly_to,
    });
    this.host_.changed();
  }

  close(): void {
    this.view?.stop();
    this.view = null;
    this.host_.changed();
  }

  /**
   * The card of the record that was taken; none where the layer has no records, or is not painted.
   */
  show_card(layer: Layer | null, { values }: Picked): void {
    const found = layer ? values?.[layer.slug] : undefined;
    const key = found?.valid ? found.value : undefined;
    this.card =
      layer?.table === undefined || key === undefined ? null : { layer, key, record: null };
    this.host_.changed();
    void this.load_card();
  }
  close_card(): void {
    this.card = null;
    this.host_.changed();
  }
  /** Brings the record's row into sight, in the table of its layer. */
  show_row(layer: Layer, key: number): void {
    this.open(layer);
    this.view?.show(key);
  }

  /** This person's newest change of the table is taken back, or the one that was comes again. */
  undo(table: number): Promise<void> {
    return this.turn(table, "undo");
  }
  redo(table: number): Promise<void> {
    return this.turn(table, "redo");
  }

  private async turn(table: number, way: "undo" | "redo"): Promise<void> {
    if (this.view?.table_id === table) {
      await this.view[way]();
      return;
    }
    try {
      const what = await (way === "undo"
        ? this.api_.undo_table(table)
        : this.api_.redo_table(table));
      if (what.columns_changed) await this.reload(table);
      const told = way === "undo" ? texts.tables.undone : texts.tables.redone;
      notices.show("success", told(what.created.length, what.changed.length, what.deleted.length));
    } catch (error) {
      notices.error(error);
    }
  }

  /** With the areas that strokes leave. */
  refresh_areas(): void {
    this.view?.refresh_soon();
    void this.load_card();
  }

  /** The connection was away: what happened meanwhile was not told. */
  refresh(): void {
    for (const id of this.tables_.keys()) void this.load(id);
    for (const kept of [...this.names_.values(), ...this.terms_.values()]) kept.refresh();
    this.records_.forget_all();
    this.view?.rows.refresh();
  }

  on_record(event: RecordEvent): void {
    this.records_.forget(event.table, event.key);
    const names = this.names_.get(event.table);
    if (event.event === "deleted") names?.remove(event.key);
    else if (event.record) names?.put(event.record);
    this.terms_.get(event.table)?.refresh();
    if (this.view?.table_id === event.table) this.view.on_record(event);
    if (this.card?.layer.table !== event.table || this.card.key !== event.key) return;
    if (event.event === "deleted") this.close_card();
    else void this.load_card();
  }

  on_table(event: TableEvent): void {
    this.records_.forget_table(event.table_id);
    if (event.event === "deleted") {
      this.tables_.delete(event.table_id);
      this.names_.delete(event.table_id);
      this.terms_.delete(event.table_id);
    } else if (event.table && this.tables_.has(event.table_id)) {
      this.tables_.set(event.table_id, event.table);
      this.names_.get(event.table_id)?.refresh();
      this.terms_.get(event.table_id)?.refresh();
    }
    if (this.view?.table_id === event.table_id) this.view.refresh_soon();
    this.host_.changed();
  }

  on_layer_edited(layer: number): void {
    if (this.view?.layer_id === layer) this.view.refresh_soon();
    if (this.card?.layer.id === layer) void this.load_card();
  }
  on_layer_deleted(layer: number): void {
    if (this.view?.layer_id === layer) this.close();
    if (this.card?.layer.id === layer) this.close_card();
  }

  /** This person changed its columns: the rows are read anew with them. */
  async reload(id: number): Promise<void> {
    await this.load(id);
    this.records_.forget_table(id);
    this.names_.get(id)?.refresh();
    this.terms_.get(id)?.refresh();
    if (this.view?.table_id === id) this.view.rows.refresh();
  }

  private async load_card(): Promise<void> {
    const { card } = this;
    if (!card) return;
    try {
      const record = await this.api_.record(
        { model: this.host_.model_id, layer: card.layer.id },
        card.key,
      );
      if (this.card?.key !== card.key || this.card.layer.id !== card.layer.id) return;
      this.card = { ...card, record };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // paint that an undo brought back, without its record
      if (this.card === card) this.card = null;
    }
    this.host_.changed();
  }

  private async load(id: number): Promise<void> {
    if (!this.tables_.has(id)) this.tables_.set(id, "asked");
    try {
      this.tables_.set(id, await this.api_.table(id));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status !== 404) notices.error(error);
    }
    this.host_.changed();
  }
}
