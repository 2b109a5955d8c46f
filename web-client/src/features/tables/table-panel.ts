// <strata-table-panel>: the records of a database layer as a table: sorted, filtered, written into.
// Only the rows in sight are drawn.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { can_be_title, holds_files, is_number, label_column, label_of } from "../../domain/cells";
import { chosen_in } from "../../domain/column-filter";
import { holds_marks } from "../../domain/marks";
import { format_area } from "../../domain/measure";
import { css_color, record_color } from "../../domain/palette";
import type { CellValue, Column, Table, TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { open_bin_of } from "../../ui/trash-dialog";
import type { CellEdit } from "./cell-edits";
import "../../session/fields/cell-input";
import { may_be_text, takes_typing, type StrataCellInput } from "../../session/fields/cell-input";
import "./column-filter";
import { ask } from "../../ui/dialog";
import { FileDrop } from "../../ui/drop";
import { follow_session } from "../../session/follow-session";
import { growth } from "../../ui/growth";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { measures_of, type RecordMeasure } from "../../session/fields/record-measures";
import type { RecordClaim } from "../../session/record-editors";
import { save_from } from "../../ui/save-from";
import { shown_value } from "../../session/fields/shown-value";
import { shared_styles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { table_styles } from "./table-styles";
import type { TableView } from "./table-view";
import { terms_type } from "./terms-files";
import { texts } from "../../texts";
import { visibility_badge } from "../../ui/visibility";
import { told_clock } from "../../domain/times";
import type { TablePanelRequest } from "../../session/requests";

const kRow_px = 32;
const kHead_px = 34;
const kNarrow_px = 820; // of the panel, where one row of tools has no room for all
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
  @state() private active_ = { row: 0, column: 0 };
  @state() private editing_: Editing | null = null;
  @state() private editor_problem_ = "";
  // whose filter is open
  @state() private filtered_: { column: Column; anchor: HTMLElement } | null = null;
  private claim_: RecordClaim | null = null; // of the record that is written into
  @query(".scroller") private scroller_!: HTMLElement | null;
  @query(".editor strata-cell-input") private input_!: StrataCellInput | null;
  @query(".filter input") private filter_!: HTMLInputElement;
  private readonly drop_ = new FileDrop(
    this,
    (files) => this.take_files(files),
    () => this.can_write,
  );
  private readonly widths_ = new Map<string, number>();
  private observer_: ResizeObserver | null = null;
  private growth_ = 1;
  private from_ = 0; // the row that the next one with Shift goes on from

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [shared_styles, table_styles];

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.observer_?.disconnect();
    this.observer_ = null;
    this.claim_?.release();
    this.claim_ = null;
  }

  override willUpdate(): void {
    this.growth_ = growth();
    this.claim_edited();
    this.classList.toggle("over", this.drop_.over);
    this.classList.toggle("narrow", this.is_narrow);
    const { first, last } = this.in_sight();
    this.view.rows.want(first, last);
  }

  override updated(): void {
    if (this.scroller_ && !this.observer_) {
      this.observer_ = new ResizeObserver(() => this.requestUpdate());
      this.observer_.observe(this.scroller_);
    }
    if (this.view.sought !== null) void this.seek();
  }

  /** Others see which record is written into. */
  private claim_edited(): void {
    const { editing_: editing, view } = this;
    if (
      this.claim_?.key === editing?.key &&
      (editing === null || this.claim_?.table === view.table_id)
    )
      return;
    this.claim_?.release();
    this.claim_ = editing ? this.session.editors.claim(view.table_id, editing.key) : null;
  }

  // ── what is in sight
  // ──────────────────────────────────────────────────────────────────────────────────────────────

  private get row_px(): number {
    return kRow_px * this.growth_;
  }
  private get head_px(): number {
    return kHead_px * this.growth_;
  }

  private in_sight(): { first: number; last: number } {
    const { scrollTop: top = 0, clientHeight: height = 300 } = this.scroller_ ?? {};
    const first = Math.max(0, Math.floor(top / this.row_px) - kAbove);
    return { first, last: Math.ceil((top + height) / this.row_px) + kAbove };
  }

  private get is_narrow(): boolean {
    return this.clientWidth <= kNarrow_px * this.growth_;
  }
  private get layer(): Layer | null {
    return this.session.layers.find(this.view.layer_id);
  }
  private get can_write(): boolean {
    return this.session.can_paint;
  }

  private width_of(column: Column): number {
    return this.widths_.get(column.slug) ?? (kWidths[column.kind] ?? kUsualWidth) * this.growth_;
  }
  private width_of_measure({ name }: RecordMeasure): number {
    return this.widths_.get(name) ?? kMeasureWidth * this.growth_;
  }
  /** Left edges of the columns, then of what is measured; at last the right one. */
  private edges(table: Table): number[] {
    const edges = [this.widths_.get("key") ?? kKeyWidth * this.growth_];
    const widths = [
      ...table.columns.map((column) => this.width_of(column)),
      ...measures_of(table).map((measure) => this.width_of_measure(measure)),
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
    return html`${this.bar(table, layer)} ${this.filter_problem()} ${this.grid(table, layer)} ${this.chosen(layer)} ${this.column_filter(table)}`;
  }

  private bar(table: Table, layer: Layer): TemplateResult {
    const words = texts.tables;
    const { view, session } = this;
    const { rows } = view;
    const shown =
      rows.filter === "" ? words.records(rows.total) : words.records_of(rows.total, table.records);
    return html`<div class="bar">
      <h2 class="ellipsis" title=${table.description}>${label_of(table)}</h2>
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
          @change=${this.on_filter}
          @keydown=${this.on_filter_key}
        />
        ${
          rows.filter === ""
            ? nothing
            : html`<button class="icon quiet" aria-label=${words.filter_clear} title=${words.filter_clear} @click=${() => rows.set_query({ filter: "" })}>
              ${icon("close")}
            </button>`
        }
      </div>
      <span class="grow"></span>
      ${this.on_model()}
      ${
        this.can_write
          ? html`<button aria-label=${words.new_record} title=${words.new_record} @click=${() => this.request({ dialog: "record", layer, key: null })}>
              ${icon("plus")}<span class="words">${words.new_record}</span>
            </button>
            ${this.is_narrow ? nothing : this.turns("tool")}`
          : nothing
      }
      ${
        this.is_narrow
          ? nothing
          : html`<span class="files">
            <button title=${words.save_xlsx} aria-label=${words.save_xlsx} @click=${() => this.save_sheet(table, "xlsx")}>XLSX</button>
            <button title=${words.save_csv} aria-label=${words.save_csv} @click=${() => this.save_sheet(table, "csv")}>CSV</button>
          </span>`
      }
      <strata-menu label=${words.more}>
        ${this.can_write && this.is_narrow ? html`${this.turns("menuitem")}<hr />` : nothing}
        ${
          session.can_curate
            ? html`<button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "column", table: table.id, column: null })}>
                ${icon("plus")}${words.new_column}
              </button>
              <hr />`
            : nothing
        }
        <button class="quiet" role="menuitem" @click=${() => this.save_sheet(table, "xlsx")}>${icon("import")}${words.save_xlsx}</button>
        <button class="quiet" role="menuitem" @click=${() => this.save_sheet(table, "csv")}>${icon("import")}${words.save_csv}</button>
        <button class="quiet" role="menuitem" @click=${() => this.save_sheet(table, "csv", { separator: "semicolon" })}>${icon("import")}${words.save_csv_semicolon}</button>
        ${table.kind === "terms" ? this.terms_menu(table) : nothing}
        ${
          this.can_write
            ? html`<button class="quiet" role="menuitem" @click=${() => this.choose_csv(table)}>${icon("upload")}${words.import_csv}</button>
              ${
                table.columns.some(holds_files)
                  ? html`<button class="quiet" role="menuitem" @click=${() => this.choose_photos(table)}>${icon("picture")}${texts.files.add_menu}</button>`
                  : nothing
              }
              <hr />
              <button class="quiet" role="menuitem" @click=${() => void open_bin_of(session)}>${icon("trash")}${texts.bin.open}</button>`
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

  private terms_menu(table: Table): TemplateResult {
    const words = texts.terms_dialog;
    const { api, can_curate } = this.session;
    const save = (format: "csv" | "turtle", ending: string) => () =>
      save_from(api.terms_url(table.id, format), `${table.slug}.${ending}`);
    return html`<hr />
      <button class="quiet" role="menuitem" @click=${save("csv", "csv")}>${icon("import")}${words.save_csv}</button>
      <button class="quiet" role="menuitem" @click=${save("turtle", "ttl")}>${icon("import")}${words.save_turtle}</button>
      ${
        can_curate
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
      ? (this.session.tables.label(this.view.table_id, key) ?? words.record(key))
      : words.chosen(keys.length);
    return html`<div class="chosen" role="group" aria-label=${words.chosen(keys.length)}>
      <span class="numeric ellipsis">${name} · ${format_area(area)}</span>
      ${
        one && this.can_write
          ? html`<button class="icon quiet" aria-label=${words.paint_with} title=${words.paint_with} @click=${() => this.paint_with(layer, key)}>
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
      <button class="icon quiet" aria-label=${words.choose_none} title=${words.choose_none} @click=${() => this.view.select_none()}>${icon("close")}</button>
    </div>`;
  }

  /** Whether the rows that are chosen, or that the filter finds, stand out on the model. */
  private on_model(): TemplateResult {
    const words = texts.tables;
    const { view } = this;
    const { extent, highlight } = view;
    const by_filter = extent !== null && view.selected.size === 0;
    const is_nowhere = extent !== null && !extent.bounds;
    return html`<div class="on-model" role="group" aria-label=${words.on_model}>
      ${by_filter ? html`<span class="hint numeric" title=${words.painted_of(extent.painted, extent.records)}>${format_area(extent.area_m2)}</span>` : nothing}
      <button
        class="icon quiet"
        aria-pressed=${view.lights_up}
        aria-label=${words.light_up}
        title="${words.light_up}. ${words.light_up_hint}"
        @click=${() => view.set_lights_up(!view.lights_up)}
      >
        ${icon("bulb")}
      </button>
      <button class="icon quiet" aria-pressed=${view.isolates} aria-label=${words.isolate} title=${words.isolate} @click=${() => view.set_isolates(!view.isolates)}>
        ${icon("isolate")}
      </button>
      <button
        class="icon quiet"
        ?disabled=${highlight === null || is_nowhere}
        aria-label=${words.fly}
        title=${is_nowhere ? words.nothing_here : words.fly}
        @click=${() => view.fly()}
      >
        ${icon("fit")}
      </button>
    </div>`;
  }

  /** The filter with the character that is wrong. */
  private filter_problem(): TemplateResult | typeof nothing {
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
    const { first, last } = this.in_sight();
    const edges = this.edges(table);
    const widths = edges.map((edge, at) => edge - (edges[at - 1] ?? 0));
    const indices: number[] = [];
    for (let index = first; index < Math.min(last, rows.total); ++index) indices.push(index);
    const { row, column } = this.active_;
    return html`<div
      class="scroller"
      role="grid"
      tabindex="0"
      aria-label=${texts.tables.grid(label_of(table))}
      aria-rowcount=${rows.total + 1}
      aria-colcount=${widths.length}
      aria-activedescendant=${indices.includes(row) ? `cell-${row}-${column}` : nothing}
      ${styled({ "--columns": widths.map((width) => `${width}px`).join(" "), "--row": `${this.row_px}px` })}
      @scroll=${() => this.requestUpdate()}
      @keydown=${this.on_key}
    >
      ${this.head(table)}
      <div class="body" role="rowgroup" ${styled({ height: `${rows.total * this.row_px}px` })}>
        ${repeat(
          indices,
          (index) => index,
          (index) => this.line(table, layer, index),
        )}
        ${this.editor(edges)} ${this.bubbles(table, edges)}
      </div>
      ${rows.loaded && rows.total === 0 && !rows.problem ? this.nothing_there(table, layer) : nothing}
    </div>`;
  }

  private nothing_there(table: Table, layer: Layer): TemplateResult {
    const words = texts.tables;
    return html`<div class="empty">
      <span>${table.records === 0 ? words.empty : words.nothing_matches}</span>
      ${
        table.records === 0 && this.can_write
          ? html`<button @click=${() => this.request({ dialog: "record", layer, key: null })}>${icon("plus")}${words.new_record}</button>`
          : nothing
      }
    </div>`;
  }

  private head(table: Table): TemplateResult {
    const words = texts.tables;
    return html`<div class="head" role="row" aria-rowindex="1">
      ${this.head_cell("key", words.key, "key")}
      ${table.columns.map((column) => this.head_cell(column.slug, label_of(column), is_number(column) ? "number" : "", column))}
      ${measures_of(table).map(({ name, label }) => this.head_cell(name, label, "number"))}
    </div>`;
  }

  private head_cell(name: string, label: string, kind: string, column?: Column): TemplateResult {
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
        ${column ? visibility_badge(column.visibility) : nothing} ${sorted === "none" ? nothing : icon(sorted === "ascending" ? "up" : "down")}
      </button>
      ${column ? this.filter_button(column, label) : nothing}
      ${
        column && this.session.can_curate
          ? html`<strata-menu label=${words.column_menu(label)} small>
            <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "column", table: this.view.table_id, column })}>
              ${icon("edit")}${words.change_column}
            </button>
            ${this.title_button(column)}
            <button class="quiet" role="menuitem" @click=${() => this.dispatchEvent(new CustomEvent("drop-column", { detail: column }))}>
              ${icon("trash")}${words.drop_column}
            </button>
          </strata-menu>`
          : nothing
      }
      <span class="edge" @pointerdown=${(event: PointerEvent) => this.on_edge(event, name)}></span>
    </div>`;
  }

  private filter_button(column: Column, label: string): TemplateResult {
    const words = texts.column_filter;
    const is_on = chosen_in(this.view.rows.filter, column) !== null;
    const told = is_on ? words.open_on(label) : words.open(label);
    return html`<button class="icon quiet by-column ${is_on ? "on" : ""}" aria-haspopup="dialog" aria-label=${told} title=${told} @click=${(event: Event) => this.open_filter(column, event)}>
      ${icon("filter")}
    </button>`;
  }

  /** Records are called by what they have in the column. */
  private title_button(column: Column): TemplateResult | typeof nothing {
    const words = texts.tables;
    const { table } = this.view;
    if (!table || table.kind === "terms" || !can_be_title(column)) return nothing;
    const is_title = label_column(table)?.id === column.id;
    return html`<button
      class="quiet"
      role="menuitemcheckbox"
      aria-checked=${is_title}
      ?disabled=${is_title && table.title_column !== column.id}
      title=${words.title_hint}
      @click=${() => void this.set_title(table.id, is_title ? null : column.id)}
    >
      ${icon(is_title ? "check" : "edit")}${words.title_column}
    </button>`;
  }

  private async set_title(table: number, column: number | null): Promise<void> {
    try {
      await this.session.api.set_title_column(table, column);
      await this.session.tables.reload(table);
    } catch (error) {
      notices.error(error);
    }
  }

  private sort(name: string): void {
    if (this.scroller_) this.scroller_.scrollTop = 0;
    this.view.sort(name);
  }

  private line(table: Table, layer: Layer, index: number): TemplateResult {
    const record = this.view.rows.row(index);
    const chosen = record !== null && this.view.selected.has(record.key);
    const is_active = (column: number): string =>
      this.active_.row === index && this.active_.column === column ? "active" : "";
    const color = record ? record_color(this.session.layers.palette(layer), record) : null;
    const writer = record ? this.session.editors.other(table.id, record.key) : null;
    const told = writer
      ? writer.is_me
        ? texts.tables.edited_elsewhere
        : texts.tables.edited_by(writer.user)
      : "";
    return html`<div
      class="line ${chosen ? "chosen-row" : ""} ${writer ? "held" : ""}"
      role="row"
      aria-rowindex=${index + 2}
      aria-selected=${chosen}
      ${styled({ top: `${index * this.row_px}px` })}
    >
      <div class="cell key numeric ${is_active(0)}" role="rowheader" id="cell-${index}-0" @click=${(event: MouseEvent) => this.on_key_cell(event, index)}>
        ${color ? html`<span class="swatch" ${styled({ background: css_color(color) })}></span>` : nothing}${record?.key ?? "…"}
        ${writer ? html`<span class="writer" role="img" aria-label=${told} title=${told}>${icon("edit")}</span>` : nothing}
      </div>
      ${table.columns.map((column, at) => this.cell(record, column, index, at + 1, is_active(at + 1)))}
      ${measures_of(table).map(({ text }, measure) => {
        const at = table.columns.length + 1 + measure;
        return html`<div
          class="cell number numeric computed ${is_active(at)}"
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
    const number = is_number(column) ? "number numeric" : "";
    return html`<div
      class="cell ${number} ${state} ${active}"
      role="gridcell"
      id="cell-${row}-${at}"
      @click=${(event: MouseEvent) => this.on_cell(event, row, at)}
    >
      <span class="ellipsis">${record ? this.shown(column, value) : ""}</span>
    </div>`;
  }

  private shown(column: Column, value: CellValue): unknown {
    return shown_value(this.session, column, value);
  }

  // ── writing into a cell
  // ───────────────────────────────────────────────────────────────────────────────────────────

  private editor(edges: readonly number[]): TemplateResult | typeof nothing {
    const editing = this.editing_;
    const { table } = this.view;
    if (!editing || !table) return nothing;
    const at = table.columns.findIndex((column) => column.id === editing.column.id);
    if (at < 0) return nothing;
    const width = Math.max(this.width_of(editing.column), kEditorWidth[editing.column.kind] ?? 0);
    return html`<div
        class="editor"
        ${styled({ top: `${editing.row * this.row_px}px`, left: `${edges[at]!}px`, width: `${width}px` })}
        @keydown=${this.on_editor_key}
        @focusout=${this.on_editor_left}
      >
        <strata-cell-input
          class="in-cell"
          .session=${this.session}
          .column=${editing.column}
          .value=${editing.value}
          .typed=${editing.typed}
          .invalid=${this.editor_problem_ !== ""}
          .fixed=${this.is_taken}
        ></strata-cell-input>
      </div>
      ${this.is_taken ? this.taken(editing, edges[at]!) : nothing}
      ${
        this.editor_problem_
          ? html`<div class="bubble" role="alert" ${styled(this.beside(editing.row, edges[at]!))}>
            <span class="error">${this.editor_problem_}</span>
          </div>`
          : nothing
      }`;
  }

  /** Somebody else has the record that is written into here. */
  private get is_taken(): boolean {
    return this.claim_ !== null && this.claim_.other !== null;
  }

  private taken({ key, row }: Editing, left: number): TemplateResult {
    const words = texts.tables;
    const { user, is_me } = this.claim_!.other!;
    return html`<div class="bubble" role="alert" ${styled(this.beside(row, left))}>
      <span>${is_me ? words.taken_elsewhere : words.taken_over(user)}</span>
      <div class="row">
        <button @click=${() => void this.take_over(key)}>${words.take_over}</button>
        <button class="quiet" @click=${() => this.leave_cell()}>${words.give_up}</button>
      </div>
    </div>`;
  }

  /**
   * Asks whoever would write into a record that somebody else has; `work` is done if it is, or was,
   * to be had.
   */
  private async take_over(key: number, work: () => void = () => {}): Promise<void> {
    const words = texts.tables;
    const { session, view } = this;
    const claim = session.editors.claim(view.table_id, key);
    const { other } = claim;
    const name = session.tables.label(view.table_id, key) ?? words.record(key);
    const lead = other?.is_me ? words.take_over_own : words.take_over_lead(other?.user ?? "");
    if (
      !other ||
      (await ask({ heading: words.take_over_title(name), lead, yes: words.take_over }))
    ) {
      if (other) claim.take_over();
      work();
      await this.updateComplete; // what is written into from now on has a claim of its own
    }
    claim.release();
  }

  private leave_cell(): void {
    this.editing_ = null;
    this.editor_problem_ = "";
    this.scroller_?.focus();
  }

  /** Below the row, or above it where there is more room. */
  private beside(row: number, left: number): Record<string, string | null> {
    const { scrollTop = 0, clientHeight = 0 } = this.scroller_ ?? {};
    const below = row === 0 || row * this.row_px - scrollTop < (clientHeight - this.head_px) / 2;
    const [top, bottom] = below
      ? [(row + 1) * this.row_px + 3, null]
      : [null, (this.view.rows.total - row) * this.row_px + 3];
    return {
      left: `${left}px`,
      top: top === null ? null : `${top}px`,
      bottom: bottom === null ? null : `${bottom}px`,
    };
  }

  /** What the server refused, and what somebody else wrote meanwhile. */
  private bubbles(table: Table, edges: readonly number[]): unknown {
    return this.view.edits.open.map((edit) => {
      const row = this.view.rows.index_of(edit.key);
      const at = table.columns.findIndex((column) => column.slug === edit.slug);
      const written_again =
        this.editing_?.key === edit.key && this.editing_.column.slug === edit.slug;
      if (row === null || at < 0 || written_again) return nothing;
      return html`<div class="bubble" role="alert" ${styled(this.beside(row, edges[at]!))}>
        ${edit.theirs ? this.conflict(table.columns[at]!, edit) : this.refused(edit, row, at + 1)}
      </div>`;
    });
  }

  private refused(edit: CellEdit, row: number, at: number): TemplateResult {
    const words = texts.tables;
    return html`<span class="error">${edit.problem}</span>
      <div class="row">
        <button @click=${() => this.edit_at(row, at, null)}>${words.correct}</button>
        <button class="quiet" @click=${() => this.leave_edit(edit)}>${words.give_up}</button>
      </div>`;
  }

  private conflict(column: Column, edit: CellEdit): TemplateResult {
    const words = texts.tables;
    const theirs = edit.theirs!;
    const shown = (value: CellValue): unknown =>
      value === null ? words.no_value : this.shown(column, value);
    const time = theirs.time ? told_clock(theirs.time) : "";
    return html`<span>${words.changed_by(theirs.user || words.somebody, time)} <b>${shown(theirs.value)}</b></span>
      <span>${words.yours} <b>${shown(edit.value)}</b></span>
      <div class="row">
        <button @click=${() => this.leave_edit(edit)}>${words.keep_theirs}</button>
        <button class="primary" @click=${() => this.insist(edit)}>${words.take_mine}</button>
      </div>`;
  }

  private leave_edit(edit: CellEdit): void {
    this.view.edits.forget(edit.key, edit.slug);
    this.scroller_?.focus();
  }
  private insist(edit: CellEdit): void {
    void this.view.edits.insist(edit);
    this.scroller_?.focus();
  }

  private edit_at(row: number, at: number, typed: string | null): void {
    const record = this.view.rows.row(row);
    const column = this.view.table?.columns[at - 1];
    if (!this.can_write || !record || !column) return;
    if (holds_files(column) || holds_marks(column)) {
      this.request({ dialog: "record", layer: this.layer!, key: record.key });
      return;
    }
    if (this.is_held(record.key))
      void this.take_over(record.key, () => this.edit_now(row, at, typed));
    else this.edit_now(row, at, typed);
  }

  private is_held(key: number): boolean {
    return this.session.editors.other(this.view.table_id, key) !== null;
  }

  private clear_cell(record: TableRecord, { slug }: Column): void {
    const clear = (): void =>
      void this.view.write(record.key, slug, null, this.base_of(record, slug));
    if (this.is_held(record.key)) void this.take_over(record.key, clear);
    else clear();
  }

  /** What a cell holds, for who writes into it: what is on its way to the server, too. */
  private base_of({ key, values }: TableRecord, slug: string): CellValue {
    const edit = this.view.edits.of(key, slug);
    return edit?.state === "saving" ? edit.value : (values[slug] ?? null);
  }

  private edit_now(row: number, at: number, typed: string | null): void {
    const record = this.view.rows.row(row);
    const column = this.view.table?.columns[at - 1];
    if (!record || !column) return;
    this.activate(row, at);
    this.scroll_to_active(this.view.table!);
    const base = this.base_of(record, column.slug);
    this.editing_ = {
      key: record.key,
      row,
      column,
      value: this.view.edits.of(record.key, column.slug)?.value ?? base,
      base,
      typed,
    };
    this.editor_problem_ = "";
    void this.updateComplete.then(async () => {
      const input = this.input_;
      await input?.updateComplete;
      input?.begin();
    });
  }

  /** False: what was typed is no value, or somebody took the record over; it stays in the field. */
  private commit(): boolean {
    const editing = this.editing_;
    const read = this.input_?.read();
    if (!editing || !read) return true;
    if (this.is_taken) return false;
    if ("problem" in read) {
      this.editor_problem_ = read.problem;
      return false;
    }
    this.editing_ = null;
    this.editor_problem_ = "";
    this.view.write(editing.key, editing.column.slug, read.value, editing.base);
    return true;
  }

  private readonly on_editor_key = (event: KeyboardEvent): void => {
    const { row, column } = this.active_;
    if (event.key === "Escape") {
      this.leave_cell();
    } else if (event.key === "Enter" && !event.shiftKey && !event.altKey) {
      if (this.commit()) this.move_to(row + 1, column);
    } else if (event.key === "Tab") {
      if (this.commit()) this.edit_beside(row, column, event.shiftKey ? -1 : 1);
    } else {
      event.stopPropagation();
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  /** The next cell that can be written into; at the end of a row the first one of the next. */
  private edit_beside(row: number, column: number, step: 1 | -1): void {
    const count = this.view.table?.columns.length ?? 0;
    const next = column + step;
    if (next < 1) [row, column] = [row - 1, count];
    else if (next > count) [row, column] = [row + 1, 1];
    else column = next;
    if (row < 0 || row >= this.view.rows.total || count === 0) {
      this.scroller_?.focus();
      return;
    }
    this.move_to(row, column);
    this.edit_at(row, column, null);
  }

  private readonly on_editor_left = (event: FocusEvent): void => {
    const editor = event.currentTarget as HTMLElement;
    if (
      !this.editing_ ||
      (event.relatedTarget instanceof Node && editor.contains(event.relatedTarget))
    )
      return;
    this.commit();
  };

  // ── keys and the pointer
  // ──────────────────────────────────────────────────────────────────────────────────────────

  private activate(row: number, column: number): void {
    this.active_ = { row, column };
  }

  private move_to(row: number, column: number): void {
    const { table, rows } = this.view;
    if (!table || !this.scroller_) return;
    this.activate(
      Math.min(Math.max(0, row), Math.max(0, rows.total - 1)),
      Math.min(Math.max(0, column), table.columns.length + measures_of(table).length),
    );
    this.scroll_to_active(table);
    this.scroller_.focus({ preventScroll: true });
  }

  private scroll_to_active(table: Table): void {
    const box = this.scroller_!;
    const { row, column } = this.active_;
    const top = row * this.row_px;
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top + this.row_px > box.scrollTop + box.clientHeight - this.head_px)
      box.scrollTop = top + this.row_px - box.clientHeight + this.head_px;
    if (column === 0) return;
    const edges = this.edges(table);
    const left = edges[column - 1]!;
    const right = edges[column]!;
    if (left - edges[0]! < box.scrollLeft) box.scrollLeft = left - edges[0]!;
    else if (right > box.scrollLeft + box.clientWidth) box.scrollLeft = right - box.clientWidth;
  }

  private readonly on_key = (event: KeyboardEvent): void => {
    if (event.target !== this.scroller_) return; // a button in it
    const { row, column } = this.active_;
    const { table, rows } = this.view;
    if (!table) return;
    if (this.on_grid_key(event, table, row, column, rows.total)) {
      event.preventDefault();
      event.stopPropagation();
    }
  };

  private on_grid_key(
    event: KeyboardEvent,
    table: Table,
    row: number,
    column: number,
    total: number,
  ): boolean {
    const { key } = event;
    const last = table.columns.length + measures_of(table).length;
    const page = Math.max(
      1,
      Math.floor(((this.scroller_?.clientHeight ?? 0) - this.head_px) / this.row_px) - 1,
    );
    if (event.ctrlKey || event.metaKey) {
      if (event.altKey) return false;
      if (key.toLowerCase() === "z") {
        if (this.can_write) void (event.shiftKey ? this.view.redo() : this.view.undo());
      } else if (key === "Home") this.move_to(0, 0);
      else if (key === "End") this.move_to(total - 1, last);
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
      this.move_to(...step);
      return true;
    }
    const record = this.view.rows.row(row);
    const cell = table.columns[column - 1];
    if (key === "Escape") this.scroller_?.blur();
    else if (key === " " && record) this.view.select(record.key, "toggle");
    else if (key === "Enter" || key === "F2") this.enter(record, row, column);
    else if ((key === "Delete" || key === "Backspace") && record && cell && this.can_write)
      this.clear_cell(record, cell);
    else if (key.length === 1 && !event.altKey && cell && this.can_write && may_be_text(cell, key))
      this.edit_at(row, column, takes_typing(cell) ? key : null);
    else return key === " ";
    return true;
  }

  /** A cell is written into; the key and what is measured open the whole record. */
  private enter(record: TableRecord | null, row: number, column: number): void {
    const { layer } = this;
    if (this.view.table?.columns[column - 1]) this.edit_at(row, column, null);
    else if (record && layer && this.can_write)
      this.request({ dialog: "record", layer, key: record.key });
  }

  private on_cell(event: MouseEvent, row: number, column: number): void {
    if ((event.target as HTMLElement).tagName === "A") return;
    const again = this.active_.row === row && this.active_.column === column && !this.editing_;
    if (again && this.can_write) this.edit_at(row, column, null);
    else this.activate(row, column);
    if (!this.editing_) this.scroller_?.focus({ preventScroll: true });
  }

  private on_key_cell(event: MouseEvent, row: number): void {
    const record = this.view.rows.row(row);
    this.activate(row, 0);
    this.scroller_?.focus({ preventScroll: true });
    if (!record) return;
    if (event.shiftKey) this.view.select_rows(this.from_, row);
    else
      this.view.select(
        record.key,
        event.ctrlKey || event.metaKey || this.view.selected.has(record.key) ? "toggle" : "only",
      );
    this.from_ = row;
  }

  private on_edge(event: PointerEvent, name: string): void {
    const edge = event.currentTarget as HTMLElement;
    const width = edge.parentElement!.getBoundingClientRect().width;
    edge.setPointerCapture(event.pointerId);
    event.preventDefault();
    const move = (moved: PointerEvent): void => {
      this.widths_.set(
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

  private on_filter(): void {
    this.set_filter(this.filter_.value.trim());
  }

  private set_filter(filter: string): void {
    if (this.scroller_) this.scroller_.scrollTop = 0;
    this.active_ = { row: 0, column: this.active_.column };
    this.view.rows.set_query({ filter });
  }

  private on_filter_key(event: KeyboardEvent): void {
    if (event.key === "Enter") this.on_filter();
    else if (event.key === "Escape") this.filter_.value = this.view.rows.filter;
  }

  private async seek(): Promise<void> {
    const { view } = this;
    const key = view.sought!;
    view.sought = null;
    try {
      let row = await view.rows.locate(key);
      if (row === null && view.rows.filter !== "") {
        view.rows.set_query({ filter: "" });
        row = await view.rows.locate(key);
      }
      await this.updateComplete;
      if (row !== null && view === this.view) this.move_to(row, this.active_.column);
    } catch (error) {
      notices.error(error);
    }
  }

  private paint_with(layer: Layer, key: number): void {
    const { session } = this;
    session.layers.select(layer);
    session.painting.set_brush((brush) => brush.set_value(layer, key));
    session.choose_tool("brush");
  }

  /** Of the rows that the filter finds, in their order. */
  private save_sheet(
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
    save_from(
      this.session.api.records_url(
        { model: this.session.model_id, layer: this.view.layer_id },
        query,
      ),
      `${table.slug}.${format}`,
    );
  }

  // ── the filter of a column
  // ────────────────────────────────────────────────────────────────────────────────────────

  private open_filter(column: Column, event: Event): void {
    this.filtered_ = { column, anchor: event.currentTarget as HTMLElement };
  }

  private column_filter(table: Table): TemplateResult | typeof nothing {
    const { filtered_: filtered, view } = this;
    const column = filtered && table.columns.find(({ id }) => id === filtered.column.id);
    if (!filtered || !column) return nothing;
    return html`<strata-column-filter
      .session=${this.session}
      .table=${view.table_id}
      .column=${column}
      .filter=${view.rows.filter}
      .anchor=${filtered.anchor}
      @filter=${(event: CustomEvent<string>) => this.set_filter(event.detail)}
      @closed=${() => (this.filtered_ = null)}
    ></strata-column-filter>`;
  }

  private choose_photos(table: Table): void {
    const input = document.createElement("input");
    input.type = "file";
    input.multiple = true;
    input.addEventListener("change", () => {
      const files = [...(input.files ?? [])];
      if (files.length > 0) this.request({ dialog: "photos", table: table.id, files });
    });
    input.click();
  }
  private choose_csv(table: Table): void {
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
  private take_files(files: File[]): void {
    const table = this.view.table_id;
    const [file] = files;
    const takes_terms = this.view.table?.kind === "terms" && this.session.can_curate;
    if (files.length === 1 && file && takes_terms && terms_type(file.name))
      this.request({ dialog: "terms", table, file });
    else if (files.length === 1 && file && /\.(csv|tsv|txt)$/i.test(file.name))
      this.request({ dialog: "csv", table, file });
    else if (files.length > 0) this.request({ dialog: "photos", table, files });
  }

  private request(detail: TablePanelRequest): void {
    this.dispatchEvent(new CustomEvent<TablePanelRequest>("request", { detail }));
  }
}
