// <strata-table-panel>: the records of a database layer as a table: sorted, filtered, written into.
// Only the rows in sight are drawn.

import { kAsItIs } from "../../net/api";
import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { canBeTitle, holdsFiles, isNumber, labelColumn, labelOf } from "../../domain/cells";
import { chosenIn } from "../../domain/column-filter";
import { holdsMarks } from "../../domain/marks";
import { formatArea } from "../../domain/measure";
import { cssColor, recordColor } from "../../domain/palette";
import type { CellValue, Column, Table, TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { openTrashOf } from "../../ui/trash-dialog";
import type { CellEdit } from "./cell-edits";
import "../../session/fields/cell-input";
import { mayBeText, takesTyping, type StrataCellInput } from "../../session/fields/cell-input";
import "./column-filter";
import { ask } from "../../ui/dialog";
import { FileDrop } from "../../ui/drop";
import { followSession } from "../../session/follow-session";
import { growth } from "../../ui/growth";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { measuresOf, type RecordMeasure } from "../../session/fields/record-measures";
import type { RecordClaim } from "../../session/record-editors";
import { saveFrom } from "../../ui/save-from";
import { shownValue } from "../../session/fields/shown-value";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { tableStyles } from "./table-styles";
import type { TableView } from "./table-view";
import { termsType } from "./terms-files";
import { texts } from "../../texts";
import { visibilityBadge } from "../../ui/visibility";
import { toldClock } from "../../domain/times";
import type { TablePanelRequest } from "../../session/requests";

const kRowPx = 32;
const kHeadPx = 34;
const kNarrowPx = 820; // of the panel, where one row of tools has no room for all
const kAbove = 6; // rows drawn beyond those in sight
const kKeyWidth = 92;
const kMeasureWidth = 110;
const kWidths: Partial<Record<Column["kind"], number>> = {
  text: 190,
  numeric: 126,
  integer: 120,
  boolean: 110,
  date: 126,
  timestamp: 200,
  url: 200,
  relation: 190,
};
const kUsualWidth = 150;
const kLeastWidth = 56;
const kEditorWidth: Partial<Record<Column["kind"], number>> = {
  text: 260,
  url: 260,
  relation: 280,
  term: 240,
  period: 200,
  timestamp: 220,
  date: 160,
};

interface Editing {
  key: number;
  row: number;
  column: Column;
  value: CellValue;
  base: CellValue;
  typed: string | null;
}

@customElement("strata-table-panel")
export class StrataTablePanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) view!: TableView;
  @state() private _active = { row: 0, column: 0 };
  @state() private _editing: Editing | null = null;
  @state() private _editorProblem = "";
  // whose filter is open
  @state() private _filtered: { column: Column; anchor: HTMLElement } | null = null;
  private _claim: RecordClaim | null = null; // of the record that is written into
  @query(".scroller") private _scroller!: HTMLElement | null;
  @query(".editor strata-cell-input") private _input!: StrataCellInput | null;
  @query(".filter input") private _filter!: HTMLInputElement;
  private readonly _drop = new FileDrop(
    this,
    (files) => this.takeFiles(files),
    () => this.canWrite,
  );
  private readonly _widths = new Map<string, number>();
  private _observer: ResizeObserver | null = null;
  private _growth = 1;
  private _from = 0; // the row that the next one with Shift goes on from

  constructor() {
    super();
    followSession(this);
  }

  static override styles = [sharedStyles, tableStyles];

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._observer?.disconnect();
    this._observer = null;
    this._claim?.release();
    this._claim = null;
  }

  override willUpdate(): void {
    this._growth = growth();
    this.claimEdited();
    this.classList.toggle("over", this._drop.over);
    this.classList.toggle("narrow", this.isNarrow);
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

  /** Others see which record is written into. */
  private claimEdited(): void {
    const { _editing: editing, view } = this;
    if (
      this._claim?.key === editing?.key &&
      (editing === null || this._claim?.table === view.tableId)
    )
      return;
    this._claim?.release();
    this._claim = editing ? this.session.editors.claim(view.tableId, editing.key) : null;
  }

  // ── what is in sight
  // ──────────────────────────────────────────────────────────────────────────────────────────────

  private get rowPx(): number {
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

  private widthOf(column: Column): number {
    return this._widths.get(column.slug) ?? (kWidths[column.kind] ?? kUsualWidth) * this._growth;
  }
  private widthOfMeasure({ name }: RecordMeasure): number {
    return this._widths.get(name) ?? kMeasureWidth * this._growth;
  }
  /** Left edges of the columns, then of what is measured; at last the right one. */
  private edges(table: Table): number[] {
    const edges = [this._widths.get("key") ?? kKeyWidth * this._growth];
    const widths = [
      ...table.columns.map((column) => this.widthOf(column)),
      ...measuresOf(table).map((measure) => this.widthOfMeasure(measure)),
    ];
    for (const width of widths) edges.push(edges[edges.length - 1]! + width);
    return edges;
  }

  // ── drawing
  // ───────────────────────────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    const { view, layer } = this;
    const { table } = view;
    if (!table || !layer) return html`<p class="empty" role="status">${texts.loading}</p>`;
    return html`${this.bar(table, layer)} ${this.filterProblem()} ${this.grid(table, layer)} ${this.chosen(layer)} ${this.columnFilter(table)}`;
  }

  private bar(table: Table, layer: Layer): TemplateResult {
    const words = texts.tables;
    const { view, session } = this;
    const { rows } = view;
    const shown =
      rows.filter === "" ? words.records(rows.total) : words.records_of(rows.total, table.records);
    return html`<div class="bar">
      <h2 class="ellipsis" title=${table.description}>${labelOf(table)}</h2>
      <span class="hint numeric count" role="status">${view.told || (rows.loaded ? shown : "")}</span>
      ${view.outdated ? html`<button class="link" title=${words.outdated_hint} @click=${() => rows.refresh()}>${words.outdated}</button>` : nothing}
      <div class="filter">
        <input
          type="text"
          spellcheck="false"
          autocapitalize="off"
          maxlength="4096"
          aria-label=${words.filter}
          placeholder=${words.filter_example}
          aria-invalid=${rows.problem?.field === "filter" ? "true" : "false"}
          .value=${rows.filter}
          @change=${this.onFilter}
          @keydown=${this.onFilterKey}
        />
        ${
          rows.filter === ""
            ? nothing
            : html`<button class="icon quiet" aria-label=${words.filter_clear} title=${words.filter_clear} @click=${() => rows.setQuery({ filter: "" })}>
              ${icon("close")}
            </button>`
        }
      </div>
      <span class="grow"></span>
      ${this.onModel()}
      ${
        this.canWrite
          ? html`<button aria-label=${words.new_record} title=${words.new_record} @click=${() => this.request({ dialog: "record", layer, key: null })}>
              ${icon("plus")}<span class="words">${words.new_record}</span>
            </button>
            ${this.isNarrow ? nothing : this.turns("tool")}`
          : nothing
      }
      ${
        this.isNarrow
          ? nothing
          : html`<span class="files">
            <button title=${words.save_xlsx} aria-label=${words.save_xlsx} @click=${() => this.saveWorkbook(table, "xlsx")}>XLSX</button>
            <button title=${words.save_csv} aria-label=${words.save_csv} @click=${() => this.saveWorkbook(table, "csv")}>CSV</button>
          </span>`
      }
      <strata-menu label=${words.more}>
        ${this.canWrite && this.isNarrow ? html`${this.turns("menuitem")}<hr />` : nothing}
        ${
          session.canCurate
            ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "column", table: table.id, column: null })}>
                ${icon("plus")}${words.new_column}
              </button>
              <hr />`
            : nothing
        }
        <button class="quiet" role="menuitem" @click=${() => this.saveWorkbook(table, "xlsx")}>${icon("import")}${words.save_xlsx}</button>
        <button class="quiet" role="menuitem" @click=${() => this.saveWorkbook(table, "csv")}>${icon("import")}${words.save_csv}</button>
        <button class="quiet" role="menuitem" @click=${() => this.saveWorkbook(table, "csv", { separator: "semicolon" })}>${icon("import")}${words.save_csv_semicolon}</button>
        ${table.kind === "terms" ? this.termsMenu(table) : nothing}
        ${
          this.canWrite
            ? html`<button class="quiet" role="menuitem" @click=${() => this.chooseCsv(table)}>${icon("upload")}${words.import_csv}</button>
              ${
                table.columns.some(holdsFiles)
                  ? html`<button class="quiet" role="menuitem" @click=${() => this.choosePhotos(table)}>${icon("picture")}${texts.files.add_menu}</button>`
                  : nothing
              }
              <hr />
              <button class="quiet" role="menuitem" @click=${() => void openTrashOf(session)}>${icon("trash")}${texts.bin.open}</button>`
            : nothing
        }
      </strata-menu>
      <button class="icon quiet" aria-label=${words.close} title="${words.close} (T)" @click=${() => session.tables.close()}>${icon("close")}</button>
    </div>`;
  }

  /** Undo and redo, beside the other tools or in the menu. */
  private turns(place: "tool" | "menuitem"): TemplateResult[] {
    const { view } = this;
    const words = texts.tables;
    const turn = (glyph: "undo" | "redo", does: () => Promise<void>): TemplateResult =>
      place === "tool"
        ? html`<button class="icon quiet" aria-label=${words[glyph]} title=${words[glyph]} @click=${does}>${icon(glyph)}</button>`
        : html`<button class="quiet" role="menuitem" @click=${does}>${icon(glyph)}${words[glyph]}</button>`;
    return [turn("undo", () => view.undo()), turn("redo", () => view.redo())];
  }

  private termsMenu(table: Table): TemplateResult {
    const words = texts.terms_dialog;
    const { api, canCurate } = this.session;
    const save = (format: "csv" | "turtle", ending: string) => () =>
      saveFrom(
        api.url("GET /tables/{table}/terms", { path: { table: table.id }, query: { f: format } }),
        `${table.slug}.${ending}`,
      );
    return html`<hr />
      <button class="quiet" role="menuitem" @click=${save("csv", "csv")}>${icon("import")}${words.save_csv}</button>
      <button class="quiet" role="menuitem" @click=${save("turtle", "ttl")}>${icon("import")}${words.save_turtle}</button>
      ${
        canCurate
          ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "terms", table: table.id, file: null })}>
            ${icon("upload")}${words.open_more}
          </button>`
          : nothing
      }
      <hr />`;
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
      <span class="numeric ellipsis">${name} · ${formatArea(area)}</span>
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

  /** Whether the rows that are chosen, or that the filter finds, stand out on the model. */
  private onModel(): TemplateResult {
    const words = texts.tables;
    const { view } = this;
    const { extent, highlight } = view;
    const byFilter = extent !== null && view.selected.size === 0;
    const isNowhere = extent !== null && !extent.bounds;
    return html`<div class="on-model" role="group" aria-label=${words.on_model}>
      ${byFilter ? html`<span class="hint numeric" title=${words.painted_of(extent.painted, extent.records)}>${formatArea(extent.area_m2)}</span>` : nothing}
      <button
        class="icon quiet"
        aria-pressed=${view.lightsUp}
        aria-label=${words.light_up}
        title="${words.light_up}. ${words.light_up_hint}"
        @click=${() => view.setLightsUp(!view.lightsUp)}
      >
        ${icon("bulb")}
      </button>
      <button class="icon quiet" aria-pressed=${view.isolates} aria-label=${words.isolate} title=${words.isolate} @click=${() => view.setIsolates(!view.isolates)}>
        ${icon("isolate")}
      </button>
      <button
        class="icon quiet"
        ?disabled=${highlight === null || isNowhere}
        aria-label=${words.fly}
        title=${isNowhere ? words.nothing_here : words.fly}
        @click=${() => view.fly()}
      >
        ${icon("fit")}
      </button>
    </div>`;
  }

  /** The filter with the character that is wrong. */
  private filterProblem(): TemplateResult | typeof nothing {
    const { problem, filter } = this.view.rows;
    if (!problem) return nothing;
    const { offset } = problem;
    const characters = [...filter];
    return html`<div class="wrong" role="alert">
      <span>${problem.detail ?? problem.title}</span>
      ${
        problem.field === "filter" && offset !== undefined
          ? html`<code>${characters.slice(0, offset).join("")}<mark>${characters[offset] ?? " "}</mark>${characters.slice(offset + 1).join("")}</code>`
          : nothing
      }
    </div>`;
  }

  private grid(table: Table, layer: Layer): TemplateResult {
    const { rows } = this.view;
    const { first, last } = this.inSight();
    const edges = this.edges(table);
    const widths = edges.map((edge, at) => edge - (edges[at - 1] ?? 0));
    const indices: number[] = [];
    for (let index = first; index < Math.min(last, rows.total); ++index) indices.push(index);
    const { row, column } = this._active;
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
      ${this.head(table)}
      <div class="body" role="rowgroup" ${styled({ height: `${rows.total * this.rowPx}px` })}>
        ${repeat(
          indices,
          (index) => index,
          (index) => this.line(table, layer, index),
        )}
        ${this.editor(edges)} ${this.bubbles(table, edges)}
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

  private head(table: Table): TemplateResult {
    const words = texts.tables;
    return html`<div class="head" role="row" aria-rowindex="1">
      ${this.headCell("key", words.key, "key")}
      ${table.columns.map((column) => this.headCell(column.slug, labelOf(column), isNumber(column) ? "number" : "", column))}
      ${measuresOf(table).map(({ name, label }) => this.headCell(name, label, "number"))}
    </div>`;
  }

  private headCell(name: string, label: string, kind: string, column?: Column): TemplateResult {
    const words = texts.tables;
    const { sortby } = this.view.rows;
    const sorted = sortby === name ? "ascending" : sortby === `-${name}` ? "descending" : "none";
    return html`<div class="cell ${kind}" role="columnheader" aria-sort=${sorted}>
      <button class="sort" tabindex="-1" title=${column?.comment || words.sort(label)} @click=${() => this.sort(name)}>
        <span class="ellipsis"
          >${label}${column?.unit ? html` <span class="unit">${column.unit}</span>` : nothing}${
            column?.required
              ? html`<span class="required" title=${words.required}> *</span>`
              : nothing
          }</span
        >
        ${column ? visibilityBadge(column.visibility) : nothing} ${sorted === "none" ? nothing : icon(sorted === "ascending" ? "up" : "down")}
      </button>
      ${column ? this.filterButton(column, label) : nothing}
      ${
        column && this.session.canCurate
          ? html`<strata-menu label=${words.column_menu(label)} small>
            <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "column", table: this.view.tableId, column })}>
              ${icon("edit")}${words.change_column}
            </button>
            ${this.titleButton(column)}
            <button class="quiet" role="menuitem" @click=${() => this.dispatchEvent(new CustomEvent("drop-column", { detail: column }))}>
              ${icon("trash")}${words.drop_column}
            </button>
          </strata-menu>`
          : nothing
      }
      <span class="edge" @pointerdown=${(event: PointerEvent) => this.onEdge(event, name)}></span>
    </div>`;
  }

  private filterButton(column: Column, label: string): TemplateResult {
    const words = texts.column_filter;
    const isOn = chosenIn(this.view.rows.filter, column) !== null;
    const told = isOn ? words.open_on(label) : words.open(label);
    return html`<button class="icon quiet by-column ${isOn ? "on" : ""}" aria-haspopup="dialog" aria-label=${told} title=${told} @click=${(event: Event) => this.openFilter(column, event)}>
      ${icon("filter")}
    </button>`;
  }

  /** Records are called by what they have in the column. */
  private titleButton(column: Column): TemplateResult | typeof nothing {
    const words = texts.tables;
    const { table } = this.view;
    if (!table || table.kind === "terms" || !canBeTitle(column)) return nothing;
    const isTitle = labelColumn(table)?.id === column.id;
    return html`<button
      class="quiet"
      role="menuitemcheckbox"
      aria-checked=${isTitle}
      ?disabled=${isTitle && table.title_column !== column.id}
      title=${words.title_hint}
      @click=${() => void this.setTitle(table.id, isTitle ? null : column.id)}
    >
      ${icon(isTitle ? "check" : "edit")}${words.title_column}
    </button>`;
  }

  private async setTitle(table: number, column: number | null): Promise<void> {
    try {
      await this.session.api.json("PATCH /tables/{table}", {
        path: { table },
        body: { title_column: column === null ? "" : `${column}` },
        header: kAsItIs,
      });
      await this.session.tables.reload(table);
    } catch (error) {
      notices.error(error);
    }
  }

  private sort(name: string): void {
    if (this._scroller) this._scroller.scrollTop = 0;
    this.view.sort(name);
  }

  private line(table: Table, layer: Layer, index: number): TemplateResult {
    const record = this.view.rows.row(index);
    const chosen = record !== null && this.view.selected.has(record.key);
    const isActive = (column: number): string =>
      this._active.row === index && this._active.column === column ? "active" : "";
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
      <div class="cell key numeric ${isActive(0)}" role="rowheader" id="cell-${index}-0" @click=${(event: MouseEvent) => this.onKeyCell(event, index)}>
        ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}${record?.key ?? "…"}
        ${writer ? html`<span class="writer" role="img" aria-label=${told} title=${told}>${icon("edit")}</span>` : nothing}
      </div>
      ${table.columns.map((column, at) => this.cell(record, column, index, at + 1, isActive(at + 1)))}
      ${measuresOf(table).map(({ text }, measure) => {
        const at = table.columns.length + 1 + measure;
        return html`<div
          class="cell number numeric computed ${isActive(at)}"
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
    const number = isNumber(column) ? "number numeric" : "";
    return html`<div
      class="cell ${number} ${state} ${active}"
      role="gridcell"
      id="cell-${row}-${at}"
      @click=${(event: MouseEvent) => this.onCell(event, row, at)}
    >
      <span class="ellipsis">${record ? this.shown(column, value) : ""}</span>
    </div>`;
  }

  private shown(column: Column, value: CellValue): unknown {
    return shownValue(this.session, column, value);
  }

  // ── writing into a cell
  // ───────────────────────────────────────────────────────────────────────────────────────────

  private editor(edges: readonly number[]): TemplateResult | typeof nothing {
    const editing = this._editing;
    const { table } = this.view;
    if (!editing || !table) return nothing;
    const at = table.columns.findIndex((column) => column.id === editing.column.id);
    if (at < 0) return nothing;
    const width = Math.max(this.widthOf(editing.column), kEditorWidth[editing.column.kind] ?? 0);
    return html`<div
        class="editor"
        ${styled({ top: `${editing.row * this.rowPx}px`, left: `${edges[at]!}px`, width: `${width}px` })}
        @keydown=${this.onEditorKey}
        @focusout=${this.onEditorLeft}
      >
        <strata-cell-input
          class="in-cell"
          .session=${this.session}
          .column=${editing.column}
          .value=${editing.value}
          .typed=${editing.typed}
          .invalid=${this._editorProblem !== ""}
          .fixed=${this.isTaken}
        ></strata-cell-input>
      </div>
      ${this.isTaken ? this.taken(editing, edges[at]!) : nothing}
      ${
        this._editorProblem
          ? html`<div class="bubble" role="alert" ${styled(this.beside(editing.row, edges[at]!))}>
            <span class="error">${this._editorProblem}</span>
          </div>`
          : nothing
      }`;
  }

  /** Somebody else has the record that is written into here. */
  private get isTaken(): boolean {
    return this._claim !== null && this._claim.other !== null;
  }

  private taken({ key, row }: Editing, left: number): TemplateResult {
    const words = texts.tables;
    const { user, isMe } = this._claim!.other!;
    return html`<div class="bubble" role="alert" ${styled(this.beside(row, left))}>
      <span>${isMe ? words.taken_elsewhere : words.taken_over(user)}</span>
      <div class="row">
        <button @click=${() => void this.takeOver(key)}>${words.take_over}</button>
        <button class="quiet" @click=${() => this.leaveCell()}>${words.give_up}</button>
      </div>
    </div>`;
  }

  /**
   * Asks whoever would write into a record that somebody else has; `work` is done if it is, or was,
   * to be had.
   */
  private async takeOver(key: number, work: () => void = () => {}): Promise<void> {
    const words = texts.tables;
    const { session, view } = this;
    const claim = session.editors.claim(view.tableId, key);
    const { other } = claim;
    const name = session.tables.label(view.tableId, key) ?? words.record(key);
    const lead = other?.isMe ? words.take_over_own : words.take_over_lead(other?.user ?? "");
    if (
      !other ||
      (await ask({ heading: words.take_over_title(name), lead, yes: words.take_over }))
    ) {
      if (other) claim.takeOver();
      work();
      await this.updateComplete; // what is written into from now on has a claim of its own
    }
    claim.release();
  }

  private leaveCell(): void {
    this._editing = null;
    this._editorProblem = "";
    this._scroller?.focus();
  }

  /** Below the row, or above it where there is more room. */
  private beside(row: number, left: number): Record<string, string | null> {
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

  /** What the server refused, and what somebody else wrote meanwhile. */
  private bubbles(table: Table, edges: readonly number[]): unknown {
    return this.view.edits.open.map((edit) => {
      const row = this.view.rows.indexOf(edit.key);
      const at = table.columns.findIndex((column) => column.slug === edit.slug);
      const writtenAgain =
        this._editing?.key === edit.key && this._editing.column.slug === edit.slug;
      if (row === null || at < 0 || writtenAgain) return nothing;
      return html`<div class="bubble" role="alert" ${styled(this.beside(row, edges[at]!))}>
        ${edit.theirs ? this.conflict(table.columns[at]!, edit) : this.refused(edit, row, at + 1)}
      </div>`;
    });
  }

  private refused(edit: CellEdit, row: number, at: number): TemplateResult {
    const words = texts.tables;
    return html`<span class="error">${edit.problem}</span>
      <div class="row">
        <button @click=${() => this.editAt(row, at, null)}>${words.correct}</button>
        <button class="quiet" @click=${() => this.leaveEdit(edit)}>${words.give_up}</button>
      </div>`;
  }

  private conflict(column: Column, edit: CellEdit): TemplateResult {
    const words = texts.tables;
    const theirs = edit.theirs!;
    const shown = (value: CellValue): unknown =>
      value === null ? words.no_value : this.shown(column, value);
    const time = theirs.time ? toldClock(theirs.time) : "";
    return html`<span>${words.changed_by(theirs.user || words.somebody, time)} <b>${shown(theirs.value)}</b></span>
      <span>${words.yours} <b>${shown(edit.value)}</b></span>
      <div class="row">
        <button @click=${() => this.leaveEdit(edit)}>${words.keep_theirs}</button>
        <button class="primary" @click=${() => this.insist(edit)}>${words.take_mine}</button>
      </div>`;
  }

  private leaveEdit(edit: CellEdit): void {
    this.view.edits.forget(edit.key, edit.slug);
    this._scroller?.focus();
  }
  private insist(edit: CellEdit): void {
    void this.view.edits.insist(edit);
    this._scroller?.focus();
  }

  private editAt(row: number, at: number, typed: string | null): void {
    const record = this.view.rows.row(row);
    const column = this.view.table?.columns[at - 1];
    if (!this.canWrite || !record || !column) return;
    if (holdsFiles(column) || holdsMarks(column)) {
      this.request({ dialog: "record", layer: this.layer!, key: record.key });
      return;
    }
    if (this.isHeld(record.key)) void this.takeOver(record.key, () => this.editNow(row, at, typed));
    else this.editNow(row, at, typed);
  }

  private isHeld(key: number): boolean {
    return this.session.editors.other(this.view.tableId, key) !== null;
  }

  private clearCell(record: TableRecord, { slug }: Column): void {
    const clear = (): void =>
      void this.view.write(record.key, slug, null, this.baseOf(record, slug));
    if (this.isHeld(record.key)) void this.takeOver(record.key, clear);
    else clear();
  }

  /** What a cell holds, for who writes into it: what is on its way to the server, too. */
  private baseOf({ key, values }: TableRecord, slug: string): CellValue {
    const edit = this.view.edits.of(key, slug);
    return edit?.state === "saving" ? edit.value : (values[slug] ?? null);
  }

  private editNow(row: number, at: number, typed: string | null): void {
    const record = this.view.rows.row(row);
    const column = this.view.table?.columns[at - 1];
    if (!record || !column) return;
    this.activate(row, at);
    this.scrollToActive(this.view.table!);
    const base = this.baseOf(record, column.slug);
    this._editing = {
      key: record.key,
      row,
      column,
      value: this.view.edits.of(record.key, column.slug)?.value ?? base,
      base,
      typed,
    };
    this._editorProblem = "";
    void this.updateComplete.then(async () => {
      const input = this._input;
      await input?.updateComplete;
      input?.begin();
    });
  }

  /** False: what was typed is no value, or somebody took the record over; it stays in the field. */
  private commit(): boolean {
    const editing = this._editing;
    const read = this._input?.read();
    if (!editing || !read) return true;
    if (this.isTaken) return false;
    if ("problem" in read) {
      this._editorProblem = read.problem;
      return false;
    }
    this._editing = null;
    this._editorProblem = "";
    this.view.write(editing.key, editing.column.slug, read.value, editing.base);
    return true;
  }

  private readonly onEditorKey = (event: KeyboardEvent): void => {
    const { row, column } = this._active;
    if (event.key === "Escape") {
      this.leaveCell();
    } else if (event.key === "Enter" && !event.shiftKey && !event.altKey) {
      if (this.commit()) this.moveTo(row + 1, column);
    } else if (event.key === "Tab") {
      if (this.commit()) this.editBeside(row, column, event.shiftKey ? -1 : 1);
    } else {
      event.stopPropagation();
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  /** The next cell that can be written into; at the end of a row the first one of the next. */
  private editBeside(row: number, column: number, step: 1 | -1): void {
    const count = this.view.table?.columns.length ?? 0;
    const next = column + step;
    if (next < 1) [row, column] = [row - 1, count];
    else if (next > count) [row, column] = [row + 1, 1];
    else column = next;
    if (row < 0 || row >= this.view.rows.total || count === 0) {
      this._scroller?.focus();
      return;
    }
    this.moveTo(row, column);
    this.editAt(row, column, null);
  }

  private readonly onEditorLeft = (event: FocusEvent): void => {
    const editor = event.currentTarget as HTMLElement;
    if (
      !this._editing ||
      (event.relatedTarget instanceof Node && editor.contains(event.relatedTarget))
    )
      return;
    this.commit();
  };

  // ── keys and the pointer
  // ──────────────────────────────────────────────────────────────────────────────────────────

  private activate(row: number, column: number): void {
    this._active = { row, column };
  }

  private moveTo(row: number, column: number): void {
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
    const { row, column } = this._active;
    const top = row * this.rowPx;
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top + this.rowPx > box.scrollTop + box.clientHeight - this.headPx)
      box.scrollTop = top + this.rowPx - box.clientHeight + this.headPx;
    if (column === 0) return;
    const edges = this.edges(table);
    const left = edges[column - 1]!;
    const right = edges[column]!;
    if (left - edges[0]! < box.scrollLeft) box.scrollLeft = left - edges[0]!;
    else if (right > box.scrollLeft + box.clientWidth) box.scrollLeft = right - box.clientWidth;
  }

  private readonly onKey = (event: KeyboardEvent): void => {
    if (event.target !== this._scroller) return; // a button in it
    const { row, column } = this._active;
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
      this.clearCell(record, cell);
    else if (key.length === 1 && !event.altKey && cell && this.canWrite && mayBeText(cell, key))
      this.editAt(row, column, takesTyping(cell) ? key : null);
    else return key === " ";
    return true;
  }

  /** A cell is written into; the key and what is measured open the whole record. */
  private enter(record: TableRecord | null, row: number, column: number): void {
    const { layer } = this;
    if (this.view.table?.columns[column - 1]) this.editAt(row, column, null);
    else if (record && layer && this.canWrite)
      this.request({ dialog: "record", layer, key: record.key });
  }

  private onCell(event: MouseEvent, row: number, column: number): void {
    if ((event.target as HTMLElement).tagName === "A") return;
    const again = this._active.row === row && this._active.column === column && !this._editing;
    if (again && this.canWrite) this.editAt(row, column, null);
    else this.activate(row, column);
    if (!this._editing) this._scroller?.focus({ preventScroll: true });
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

  private onEdge(event: PointerEvent, name: string): void {
    const edge = event.currentTarget as HTMLElement;
    const width = edge.parentElement!.getBoundingClientRect().width;
    edge.setPointerCapture(event.pointerId);
    event.preventDefault();
    const move = (moved: PointerEvent): void => {
      this._widths.set(
        name,
        Math.max(kLeastWidth, Math.round(width + moved.clientX - event.clientX)),
      );
      this.requestUpdate();
    };
    edge.addEventListener("pointermove", move);
    edge.addEventListener(
      "lostpointercapture",
      () => edge.removeEventListener("pointermove", move),
      { once: true },
    );
  }

  // ── the filter, files, and what else is asked for
  // ─────────────────────────────────────────────────────────────────

  private onFilter(): void {
    this.setFilter(this._filter.value.trim());
  }

  private setFilter(filter: string): void {
    if (this._scroller) this._scroller.scrollTop = 0;
    this._active = { row: 0, column: this._active.column };
    this.view.rows.setQuery({ filter });
  }

  private onFilterKey(event: KeyboardEvent): void {
    if (event.key === "Enter") this.onFilter();
    else if (event.key === "Escape") this._filter.value = this.view.rows.filter;
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
      if (row !== null && view === this.view) this.moveTo(row, this._active.column);
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

  /** Of the rows that the filter finds, in their order. */
  private saveWorkbook(
    table: Table,
    format: "csv" | "xlsx",
    more: Record<string, string> = {},
  ): void {
    const { sortby, filter } = this.view.rows;
    const query = {
      f: format,
      ...more,
      ...(sortby ? { sortby } : {}),
      ...(filter ? { filter } : {}),
    };
    saveFrom(
      this.session.api.url("GET /models/{model}/layers/{layer}/records", {
        path: { model: this.session.modelId, layer: this.view.layerId },
        query,
      }),
      `${table.slug}.${format}`,
    );
  }

  // ── the filter of a column
  // ────────────────────────────────────────────────────────────────────────────────────────

  private openFilter(column: Column, event: Event): void {
    this._filtered = { column, anchor: event.currentTarget as HTMLElement };
  }

  private columnFilter(table: Table): TemplateResult | typeof nothing {
    const { _filtered: filtered, view } = this;
    const column = filtered && table.columns.find(({ id }) => id === filtered.column.id);
    if (!filtered || !column) return nothing;
    return html`<strata-column-filter
      .session=${this.session}
      .table=${view.tableId}
      .column=${column}
      .filter=${view.rows.filter}
      .anchor=${filtered.anchor}
      @filter=${(event: CustomEvent<string>) => this.setFilter(event.detail)}
      @closed=${() => (this._filtered = null)}
    ></strata-column-filter>`;
  }

  private choosePhotos(table: Table): void {
    const input = document.createElement("input");
    input.type = "file";
    input.multiple = true;
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])];
      if (files.length > 0) this.request({ dialog: "photos", table: table.id, files });
    });
    input.click();
  }
  private chooseCsv(table: Table): void {
    const input = document.createElement("input");
    input.type = "file";
    input.accept = ".csv,.tsv,.txt,text/csv";
    input.addEventListener("change", () => {
      const [file] = input.files ?? [];
      if (file) this.request({ dialog: "csv", table: table.id, file });
    });
    input.click();
  }

  /**
   * One text is records, or terms where the table is a list of them; everything else is files of
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

  private request(detail: TablePanelRequest): void {
    this.dispatchEvent(new CustomEvent<TablePanelRequest>("request", { detail }));
  }
}
