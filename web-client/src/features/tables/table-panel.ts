// <strata-table-panel>: the records of a layer of records as a table, with sorting, filter and
// editing. Only visible rows are rendered.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { isNumber, labelOf } from "../../domain/cells";
import { formatArea } from "../../domain/measure";
import { cssColor, recordColor } from "../../domain/palette";
import type { CellValue, Column, Table, TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { mayBeText, takesTyping, type StrataCellInput } from "../../session/fields/cell-input";
import { corrected } from "../../domain/completion";
import { FileDrop } from "../../ui/drop";
import {
  expressionProblem,
  expressionProblemStyles,
} from "../../session/fields/expression-problem";
import { followSession } from "../../session/follow-session";
import { growth } from "../../ui/growth";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { measuresOf } from "../../session/fields/record-measures";
import { shownValue } from "../../session/fields/shown-value";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { CellEditor, type CellEditorHost } from "./cell-editor";
import "./table-bar";
import { TableColumns } from "./table-columns";
import { TableHead, type TableHeadHost } from "./table-head";
import { tableStyles } from "./table-styles";
import type { TableView } from "./table-view";
import { termsType } from "./terms-files";
import { texts } from "../../texts";
import type { TablePanelRequest } from "../../session/requests";

const kRowPx = 32;
const kHeadPx = 34;
const kNarrowPx = 820; // below this width, a single row of tools is too narrow
const kAbove = 6; // number of rendered rows outside the visible ones
@customElement("strata-table-panel")
export class StrataTablePanel extends LitElement implements CellEditorHost, TableHeadHost {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) view!: TableView;
  @state() active = { row: 0, column: 0 };
  @query(".scroller") private _scroller!: HTMLElement | null;
  @query(".editor strata-cell-input") private _input!: StrataCellInput | null;
  private readonly _drop = new FileDrop(
    this,
    (files) => this.takeFiles(files),
    () => this.canWrite,
  );
  readonly columns = new TableColumns();
  private readonly _head = new TableHead(this);
  private readonly _editor = new CellEditor(this);
  private _observer: ResizeObserver | null = null;
  private _growth = 1;
  private _from = 0; // first row of a selection with Shift

  constructor() {
    super();
    followSession(this, "tables", "layers", "editors", "together");
  }

  static override styles = [sharedStyles, expressionProblemStyles, tableStyles];

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._observer?.disconnect();
    this._observer = null;
  }

  override willUpdate(): void {
    this._growth = this.columns.growth = growth();
    this.classList.toggle("over", this._drop.over);
    const { first, last } = this.inSight();
    this.view.rows.want(first, last);
  }

  override updated(): void {
    if (this._scroller && !this._observer) {
      this._observer = new ResizeObserver(() => this.requestUpdate());
      this._observer.observe(this._scroller);
    }
    if (this.view.sought !== null) void this.seek();
  }

  // ── visible rows

  get rowPx(): number {
    return kRowPx * this._growth;
  }
  private get headPx(): number {
    return kHeadPx * this._growth;
  }

  private inSight(): { first: number; last: number } {
    const { scrollTop: top = 0, clientHeight: height = 300 } = this._scroller ?? {};
    const first = Math.max(0, Math.floor(top / this.rowPx) - kAbove);
    return { first, last: Math.ceil((top + height) / this.rowPx) + kAbove };
  }

  private get isNarrow(): boolean {
    return this.clientWidth <= kNarrowPx * this._growth;
  }
  private get layer(): Layer | null {
    return this.session.layers.find(this.view.layerId);
  }
  private get canWrite(): boolean {
    return this.session.canPaint;
  }

  // ── rendering

  override render(): TemplateResult {
    const { view, layer } = this;
    const { table } = view;
    if (!table || !layer) return html`<p class="empty" role="status">${texts.loading}</p>`;
    return html`<strata-table-bar
        .session=${this.session}
        .view=${view}
        .narrow=${this.isNarrow}
        @request=${(event: CustomEvent<TablePanelRequest>) => this.request(event.detail)}
        @filter=${(event: CustomEvent<string>) => this.setFilter(event.detail)}
      ></strata-table-bar> ${this.filterProblem()} ${this.grid(table, layer)} ${this.chosen(layer)} ${this._head.filter(table)}`;
  }

  private chosen(layer: Layer): TemplateResult | typeof nothing {
    const words = texts.tables;
    const keys = [...this.view.selected];
    if (keys.length === 0) return nothing;
    const area =
      this.view.extent?.area_m2 ??
      keys.reduce((sum, key) => sum + (this.view.rows.find(key)?.area_m2 ?? 0), 0);
    const [key] = keys;
    const one = keys.length === 1 && key !== undefined;
    const name = one
      ? (this.session.tables.label(this.view.tableId, key) ?? words.record(key))
      : words.chosen(keys.length);
    return html`<div class="chosen" role="group" aria-label=${words.chosen(keys.length)}>
      <span class="ellipsis">${name} · ${formatArea(area)}</span>
      ${
        one && this.canWrite
          ? html`<button class="icon quiet" aria-label=${words.paint_with} title=${words.paint_with} @click=${() => this.paintWith(layer, key)}>
              ${icon("brush")}
            </button>
            <button class="icon quiet" aria-label=${words.edit} title=${words.edit} @click=${() => this.request({ dialog: "record", layer, key })}>
              ${icon("edit")}
            </button>
            <button class="icon quiet" aria-label=${words.delete} title=${words.delete} @click=${() => this.request({ dialog: "delete-record", layer, key })}>
              ${icon("trash")}
            </button>`
          : nothing
      }
      <button class="icon quiet" aria-label=${words.choose_none} title=${words.choose_none} @click=${() => this.view.selectNone()}>${icon("close")}</button>
    </div>`;
  }

  /** Renders the filter text with the wrong character marked. */
  private filterProblem(): TemplateResult | typeof nothing {
    const { problem, filter } = this.view.rows;
    if (!problem) return nothing;
    const { offset, length, suggestions = [] } = problem;
    const mistake =
      problem.field === "filter" && offset !== undefined ? { offset, length, suggestions } : null;
    return html`<div class="wrong">
      ${expressionProblem({
        text: filter,
        message: problem.detail ?? problem.title,
        mistake,
        corrections: mistake ? suggestions.map((text) => ({ text })) : [],
        correct: (by) => {
          if (mistake) this.view.rows.setQuery({ filter: corrected(filter, mistake, by) });
        },
      })}
    </div>`;
  }

  private grid(table: Table, layer: Layer): TemplateResult {
    const { rows } = this.view;
    const { first, last } = this.inSight();
    const edges = this.columns.edges(table);
    const widths = edges.map((edge, at) => edge - (edges[at - 1] ?? 0));
    const indices: number[] = [];
    for (let index = first; index < Math.min(last, rows.total); ++index) indices.push(index);
    const { row, column } = this.active;
    return html`<div
      class="scroller"
      role="grid"
      tabindex="0"
      aria-label=${texts.tables.grid(labelOf(table))}
      aria-rowcount=${rows.total + 1}
      aria-colcount=${widths.length}
      aria-activedescendant=${indices.includes(row) ? `cell-${row}-${column}` : nothing}
      ${styled({ "--columns": widths.map((width) => `${width}px`).join(" "), "--row": `${this.rowPx}px` })}
      @scroll=${() => this.requestUpdate()}
      @keydown=${this.onKey}
    >
      ${this._head.row(table)}
      <div class="body" role="rowgroup" ${styled({ height: `${rows.total * this.rowPx}px` })}>
        ${repeat(
          indices,
          (index) => index,
          (index) => this.line(table, layer, index),
        )}
        ${this._editor.field(edges)} ${this._editor.bubbles(table, edges)}
      </div>
      ${rows.loaded && rows.total === 0 && !rows.problem ? this.nothingThere(table, layer) : nothing}
    </div>`;
  }

  private nothingThere(table: Table, layer: Layer): TemplateResult {
    const words = texts.tables;
    return html`<div class="empty">
      <span>${table.records === 0 ? words.empty : words.nothing_matches}</span>
      ${
        table.records === 0 && this.canWrite
          ? html`<button @click=${() => this.request({ dialog: "record", layer, key: null })}>${icon("plus")}${words.new_record}</button>`
          : nothing
      }
    </div>`;
  }

  sort(name: string): void {
    if (this._scroller) this._scroller.scrollTop = 0;
    this.view.sort(name);
  }

  private line(table: Table, layer: Layer, index: number): TemplateResult {
    const record = this.view.rows.row(index);
    const chosen = record !== null && this.view.selected.has(record.key);
    const isActive = (column: number): string =>
      this.active.row === index && this.active.column === column ? "active" : "";
    const color = record ? recordColor(this.session.layers.palette(layer), record) : null;
    const writer = record ? this.session.editors.other(table.id, record.key) : null;
    const told = writer
      ? writer.isMe
        ? texts.tables.edited_elsewhere
        : texts.tables.edited_by(writer.user)
      : "";
    return html`<div
      class="line ${chosen ? "chosen-row" : ""} ${writer ? "held" : ""}"
      role="row"
      aria-rowindex=${index + 2}
      aria-selected=${chosen}
      ${styled({ top: `${index * this.rowPx}px` })}
    >
      <div class="cell key ${isActive(0)}" role="rowheader" id="cell-${index}-0" @click=${(event: MouseEvent) => this.onKeyCell(event, index)}>
        ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}${record?.key ?? "…"}
        ${writer ? html`<span class="writer" role="img" aria-label=${told} title=${told}>${icon("edit")}</span>` : nothing}
      </div>
      ${table.columns.map((column, at) => this.cell(record, column, index, at + 1, isActive(at + 1)))}
      ${measuresOf(table).map(({ text }, measure) => {
        const at = table.columns.length + 1 + measure;
        return html`<div
          class="cell number computed ${isActive(at)}"
          role="gridcell"
          aria-readonly="true"
          id="cell-${index}-${at}"
          @click=${() => this.activate(index, at)}
        >
          ${record ? text(record) : ""}
        </div>`;
      })}
    </div>`;
  }

  private cell(
    record: TableRecord | null,
    column: Column,
    row: number,
    at: number,
    active: string,
  ): TemplateResult {
    const edit = record ? this.view.edits.of(record.key, column.slug) : null;
    const value = edit ? edit.value : (record?.values[column.slug] ?? null);
    const state = edit ? (edit.state === "saving" ? "saving" : "refused") : "";
    const number = isNumber(column) ? "number" : "";
    return html`<div
      class="cell ${number} ${state} ${active}"
      role="gridcell"
      id="cell-${row}-${at}"
      @click=${(event: MouseEvent) => this.onCell(event, row, at)}
    >
      <span class="ellipsis">${record ? this.shown(column, value) : ""}</span>
    </div>`;
  }

  shown(column: Column, value: CellValue): unknown {
    return shownValue(this.session, column, value);
  }

  // ── callbacks of the cell editor

  widthOf(column: Column): number {
    return this.columns.widthOf(column);
  }

  show(row: number, at: number): void {
    this.activate(row, at);
    this.scrollToActive(this.view.table!);
  }

  focusGrid(): void {
    this._scroller?.focus();
  }

  openRecord(key: number): void {
    this.request({ dialog: "record", layer: this.layer!, key });
  }

  input(): StrataCellInput | null {
    return this._input;
  }

  /** Returns a position below the row, or above it if there is more space. */
  beside(row: number, left: number): Record<string, string | null> {
    const { scrollTop = 0, clientHeight = 0 } = this._scroller ?? {};
    const below = row === 0 || row * this.rowPx - scrollTop < (clientHeight - this.headPx) / 2;
    const [top, bottom] = below
      ? [(row + 1) * this.rowPx + 3, null]
      : [null, (this.view.rows.total - row) * this.rowPx + 3];
    return {
      left: `${left}px`,
      top: top === null ? null : `${top}px`,
      bottom: bottom === null ? null : `${bottom}px`,
    };
  }

  // ── keyboard and pointer

  private activate(row: number, column: number): void {
    this.active = { row, column };
  }

  moveTo(row: number, column: number): void {
    const { table, rows } = this.view;
    if (!table || !this._scroller) return;
    this.activate(
      Math.min(Math.max(0, row), Math.max(0, rows.total - 1)),
      Math.min(Math.max(0, column), table.columns.length + measuresOf(table).length),
    );
    this.scrollToActive(table);
    this._scroller.focus({ preventScroll: true });
  }

  private scrollToActive(table: Table): void {
    const box = this._scroller!;
    const { row, column } = this.active;
    const top = row * this.rowPx;
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top + this.rowPx > box.scrollTop + box.clientHeight - this.headPx)
      box.scrollTop = top + this.rowPx - box.clientHeight + this.headPx;
    if (column === 0) return;
    const edges = this.columns.edges(table);
    const left = edges[column - 1]!;
    const right = edges[column]!;
    if (left - edges[0]! < box.scrollLeft) box.scrollLeft = left - edges[0]!;
    else if (right > box.scrollLeft + box.clientWidth) box.scrollLeft = right - box.clientWidth;
  }

  private readonly onKey = (event: KeyboardEvent): void => {
    if (event.target !== this._scroller) return; // a button in the table has the focus
    const { row, column } = this.active;
    const { table, rows } = this.view;
    if (!table) return;
    if (this.onGridKey(event, table, row, column, rows.total)) {
      event.preventDefault();
      event.stopPropagation();
    }
  };

  private onGridKey(
    event: KeyboardEvent,
    table: Table,
    row: number,
    column: number,
    total: number,
  ): boolean {
    const { key } = event;
    const last = table.columns.length + measuresOf(table).length;
    const page = Math.max(
      1,
      Math.floor(((this._scroller?.clientHeight ?? 0) - this.headPx) / this.rowPx) - 1,
    );
    if (event.ctrlKey || event.metaKey) {
      if (event.altKey) return false;
      if (key.toLowerCase() === "z") {
        if (this.canWrite) void (event.shiftKey ? this.view.redo() : this.view.undo());
      } else if (key === "Home") this.moveTo(0, 0);
      else if (key === "End") this.moveTo(total - 1, last);
      else return false;
      return true;
    }
    const steps: Record<string, [number, number]> = {
      ArrowUp: [row - 1, column],
      ArrowDown: [row + 1, column],
      ArrowLeft: [row, column - 1],
      ArrowRight: [row, column + 1],
      Home: [row, 0],
      End: [row, last],
      PageUp: [row - page, column],
      PageDown: [row + page, column],
    };
    const step = steps[key];
    if (step) {
      this.moveTo(...step);
      return true;
    }
    const record = this.view.rows.row(row);
    const cell = table.columns[column - 1];
    if (key === "Escape") this._scroller?.blur();
    else if (key === " " && record) this.view.select(record.key, "toggle");
    else if (key === "Enter" || key === "F2") this.enter(record, row, column);
    else if ((key === "Delete" || key === "Backspace") && record && cell && this.canWrite)
      this._editor.clear(record, cell);
    else if (key.length === 1 && !event.altKey && cell && this.canWrite && mayBeText(cell, key))
      this._editor.editAt(row, column, takesTyping(cell) ? key : null);
    else return key === " ";
    return true;
  }

  /** Edits a cell. The key and the measures open the whole record. */
  private enter(record: TableRecord | null, row: number, column: number): void {
    const { layer } = this;
    if (this.view.table?.columns[column - 1]) this._editor.editAt(row, column, null);
    else if (record && layer && this.canWrite)
      this.request({ dialog: "record", layer, key: record.key });
  }

  private onCell(event: MouseEvent, row: number, column: number): void {
    if ((event.target as HTMLElement).tagName === "A") return;
    const again = this.active.row === row && this.active.column === column && !this._editor.isOpen;
    if (again && this.canWrite) this._editor.editAt(row, column, null);
    else this.activate(row, column);
    if (!this._editor.isOpen) this._scroller?.focus({ preventScroll: true });
  }

  private onKeyCell(event: MouseEvent, row: number): void {
    const record = this.view.rows.row(row);
    this.activate(row, 0);
    this._scroller?.focus({ preventScroll: true });
    if (!record) return;
    if (event.shiftKey) this.view.selectRows(this._from, row);
    else
      this.view.select(
        record.key,
        event.ctrlKey || event.metaKey || this.view.selected.has(record.key) ? "toggle" : "only",
      );
    this._from = row;
  }

  // ── filter, files and other requests

  setFilter(filter: string): void {
    if (this._scroller) this._scroller.scrollTop = 0;
    this.active = { row: 0, column: this.active.column };
    this.view.rows.setQuery({ filter });
  }

  private async seek(): Promise<void> {
    const { view } = this;
    const key = view.sought!;
    view.sought = null;
    try {
      let row = await view.rows.locate(key);
      if (row === null && view.rows.filter !== "") {
        view.rows.setQuery({ filter: "" });
        row = await view.rows.locate(key);
      }
      await this.updateComplete;
      if (row !== null && view === this.view) this.moveTo(row, this.active.column);
    } catch (error) {
      notices.error(error);
    }
  }

  private paintWith(layer: Layer, key: number): void {
    const { session } = this;
    session.layers.select(layer);
    session.painting.setBrush((brush) => brush.setValue(layer, key));
    session.chooseTool("brush");
  }

  /**
   * Imports a CSV file as records, or as terms into a list of terms. Attaches other files to
   * records.
   */
  private takeFiles(files: File[]): void {
    const table = this.view.tableId;
    const [file] = files;
    const takesTerms = this.view.table?.kind === "terms" && this.session.canCurate;
    if (files.length === 1 && file && takesTerms && termsType(file.name))
      this.request({ dialog: "terms", table, file });
    else if (files.length === 1 && file && /\.(csv|tsv|txt)$/i.test(file.name))
      this.request({ dialog: "csv", table, file });
    else if (files.length > 0) this.request({ dialog: "photos", table, files });
  }

  drop(column: Column): void {
    this.dispatchEvent(new CustomEvent("drop-column", { detail: column }));
  }

  request(detail: TablePanelRequest): void {
    this.dispatchEvent(new CustomEvent<TablePanelRequest>("request", { detail }));
  }
}
