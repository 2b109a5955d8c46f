// The project's tables that this page has used so far: their columns and the names of their
// records.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { readRecord } from "../../net/records";
import { labelOfRecord } from "../../domain/cells";
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
import { RecordCache } from "./record-cache";
import { TableView } from "./table-view";
import { TermTree } from "../../session/fields/term-tree";
import { texts } from "../../texts";

export interface TablesHost {
  modelId: string;
  highlight(layerId: number, what: Highlight | null): void;
  flyTo(bounds: Bounds): void;
  project(): string | null;
  changed(): void;
}

export class Tables {
  /** The table that is open below the stage. */
  view: TableView | null = null;

  /** The record that was clicked on the surface. `record` is null until it is loaded. */
  card: { layer: Layer; key: number; record: TableRecord | null } | null = null;

  private readonly _tables = new Map<number, Table | "asked">();
  private readonly _names = new Map<number, RecordNames>();
  private readonly _terms = new Map<number, TermTree>();
  private readonly _records: RecordCache;

  private readonly _others: OtherNames = {
    nameOf: (table, key) => this.label(table, key),
    places: (table) => this.terms(table)?.places ?? null,
  };

  constructor(
    private readonly _api: Api,
    private readonly _host: TablesHost,
  ) {
    this._records = new RecordCache(_api, () => _host.changed());
  }

  /** Returns null and requests the table until it is loaded. */
  find(id: number): Table | null {
    const known = this._tables.get(id);
    if (known === undefined) void this.load(id);
    return typeof known === "object" ? known : null;
  }

  /** Returns null until the table's columns are loaded. */
  names(id: number): RecordNames | null {
    const table = this.find(id);
    if (!table) return null;
    let names = this._names.get(id);
    if (!names) {
      names = new RecordNames(
        this._api,
        () => this.find(id) ?? table,
        this._host.changed,
        this._others,
      );
      this._names.set(id, names);
    }
    return names;
  }

  /** Returns the name of a record, or null if it has no name or the name is not loaded yet. */
  label(id: number, key: number): string | null {
    return this.names(id)?.label(key) ?? null;
  }

  /** Returns null if the record does not exist or is not loaded yet. */
  record(id: number, key: number): TableRecord | null {
    return this._records.find(id, key);
  }

  /** Returns whether the record is known not to exist. */
  lacks(id: number, key: number): boolean {
    return this.names(id)?.lacks(key) ?? false;
  }

  /** Returns the name of a loaded record, or an empty string if it has none. */
  title(table: Table, record: Pick<TableRecord, "values">): string {
    return labelOfRecord(table, record, undefined, this._others.nameOf);
  }

  /**
   * Returns the name of a term, or null if the table is not a list of terms or the name is unknown.
   */
  term(id: number, key: number): string | null {
    return this.find(id)?.kind === "terms" ? this.label(id, key) : null;
  }

  /** Returns null if the table is not known to be a list of terms. */
  terms(id: number): TermTree | null {
    if (this.find(id)?.kind !== "terms") return null;
    let terms = this._terms.get(id);
    if (!terms) {
      terms = new TermTree(this._api, id, () => {
        for (const names of this._names.values()) names.reorder();
        this._host.changed();
      });
      this._terms.set(id, terms);
    }
    return terms;
  }

  /** Returns all tables of the project. */
  async all(): Promise<Table[]> {
    const project = this._host.project();
    if (project === null) return [];
    const tables = await this._api.all("GET /projects/{project}/tables", "tables", {
      path: { project },
    });
    for (const table of tables) this._tables.set(table.id, table);
    return tables;
  }

  open(layer: Layer): void {
    if (layer.table === undefined || this.view?.layerId === layer.id) return;
    this.view?.stop();
    this.view = new TableView(this._api, {
      modelId: this._host.modelId,
      layer_id: layer.id,
      table_id: layer.table,
      table: () => this.find(layer.table!),
      changed: this._host.changed,
      columnsChanged: () => this.load(layer.table!),
      highlight: (what) => this._host.highlight(layer.id, what),
      flyTo: this._host.flyTo,
    });
    this._host.changed();
  }

  close(): void {
    this.view?.stop();
    this.view = null;
    this._host.changed();
  }

  /**
   * Opens the card of the clicked record. Closes the card if the layer has no records or is not
   * painted there.
   */
  showCard(layer: Layer | null, { values }: Picked): void {
    const found = layer ? values?.[layer.slug] : undefined;
    const key = found?.valid ? found.value : undefined;
    this.card =
      layer?.table === undefined || key === undefined ? null : { layer, key, record: null };
    this._host.changed();
    void this.loadCard();
  }
  closeCard(): void {
    this.card = null;
    this._host.changed();
  }
  /** Scrolls to the record's row in the table of its layer. */
  showRow(layer: Layer, key: number): void {
    this.open(layer);
    this.view?.show(key);
  }

  /** Opens the table of the layer with these records only. */
  showRows(layer: Layer, keys: readonly number[]): void {
    this.open(layer);
    this.view?.rows.setQuery({ filter: `key in (${keys.join(", ")})` });
  }

  /** Undoes this user's latest change to the table; `redo` repeats it. */
  undo(table: number): Promise<void> {
    return this.turn(table, "undo");
  }
  redo(table: number): Promise<void> {
    return this.turn(table, "redo");
  }

  private async turn(table: number, way: "undo" | "redo"): Promise<void> {
    if (this.view?.tableId === table) {
      await this.view[way]();
      return;
    }
    try {
      const what = await (way === "undo"
        ? this._api.json("POST /tables/{table}/undo", { path: { table } })
        : this._api.json("POST /tables/{table}/redo", { path: { table } }));
      if (what.columns_changed) await this.reload(table);
      const told = way === "undo" ? texts.tables.undone : texts.tables.redone;
      notices.show("success", told(what.created.length, what.changed.length, what.deleted.length));
    } catch (error) {
      notices.error(error);
    }
  }

  /** Loads the rows and their areas again after a stroke. */
  refreshAreas(): void {
    this.view?.refreshSoon();
    void this.loadCard();
  }

  /** Call this after a reconnection, because events may have been lost. */
  refresh(): void {
    for (const id of this._tables.keys()) void this.load(id);
    for (const kept of [...this._names.values(), ...this._terms.values()]) kept.refresh();
    this._records.forgetAll();
    this.view?.rows.refresh();
  }

  onRecord(event: RecordEvent): void {
    this._records.forget(event.table, event.key);
    const names = this._names.get(event.table);
    if (event.event === "deleted") names?.remove(event.key);
    else if (event.record) names?.put(event.record);
    this._terms.get(event.table)?.refresh();
    if (this.view?.tableId === event.table) this.view.onRecord(event);
    if (this.card?.layer.table !== event.table || this.card.key !== event.key) return;
    if (event.event === "deleted") this.closeCard();
    else void this.loadCard();
  }

  onTable(event: TableEvent): void {
    this._records.forgetTable(event.table_id);
    if (event.event === "deleted") {
      this._tables.delete(event.table_id);
      this._names.delete(event.table_id);
      this._terms.delete(event.table_id);
    } else if (event.table && this._tables.has(event.table_id)) {
      this._tables.set(event.table_id, event.table);
      this._names.get(event.table_id)?.refresh();
      this._terms.get(event.table_id)?.refresh();
    }
    if (this.view?.tableId === event.table_id) this.view.refreshSoon();
    this._host.changed();
  }

  onLayerEdited(layer: number): void {
    if (this.view?.layerId === layer) this.view.refreshSoon();
    if (this.card?.layer.id === layer) void this.loadCard();
  }
  onLayerDeleted(layer: number): void {
    if (this.view?.layerId === layer) this.close();
    if (this.card?.layer.id === layer) this.closeCard();
  }

  /** Call this after this user has changed the columns. Loads the rows again. */
  async reload(id: number): Promise<void> {
    await this.load(id);
    this._records.forgetTable(id);
    this._names.get(id)?.refresh();
    this._terms.get(id)?.refresh();
    if (this.view?.tableId === id) this.view.rows.refresh();
  }

  private async loadCard(): Promise<void> {
    const { card } = this;
    if (!card) return;
    try {
      const record = await readRecord(
        this._api,
        { model: this._host.modelId, layer: card.layer.id },
        card.key,
      );
      if (this.card?.key !== card.key || this.card.layer.id !== card.layer.id) return;
      this.card = { ...card, record };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // an undo has painted a key again whose record does not exist
      if (this.card === card) this.card = null;
    }
    this._host.changed();
  }

  private async load(id: number): Promise<void> {
    if (!this._tables.has(id)) this._tables.set(id, "asked");
    try {
      this._tables.set(id, await this._api.json("GET /tables/{table}", { path: { table: id } }));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status !== 404) notices.error(error);
    }
    this._host.changed();
  }
}
