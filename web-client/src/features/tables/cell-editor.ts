// Edits the cells of a table: the field in the cell, the message about a record that another user
// is editing, and the changes that could not be saved.

import {
  html,
  nothing,
  type ReactiveController,
  type ReactiveControllerHost,
  type TemplateResult,
} from "lit";
import { holdsFiles } from "../../domain/cells";
import { holdsMarks } from "../../domain/marks";
import { toldClock } from "../../domain/times";
import type { CellValue, Column, Table, TableRecord } from "../../core/protocol.gen";
import "../../session/fields/cell-input";
import type { StrataCellInput } from "../../session/fields/cell-input";
import type { ModelSession } from "../../session/model-session";
import type { RecordClaim } from "../../session/record-editors";
import { ask } from "../../ui/dialog";
import { styled } from "../../ui/styled";
import type { CellEdit } from "./cell-edits";
import type { TableView } from "./table-view";
import { texts } from "../../texts";

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

/**
 * Callbacks to the table, with positions of cells. Column 0 is the key, and the columns of the
 * table begin at 1.
 */
export interface CellEditorHost extends ReactiveControllerHost {
  readonly session: ModelSession;
  readonly view: TableView;
  readonly active: { row: number; column: number };
  readonly rowPx: number;
  widthOf(column: Column): number;
  /** Returns the position of a bubble next to a row. */
  beside(row: number, left: number): Record<string, string | null>;
  shown(column: Column, value: CellValue): unknown;
  /** Activates the cell and scrolls to it. */
  show(row: number, at: number): void;
  /** Activates the cell within the table, with the keyboard focus. */
  moveTo(row: number, at: number): void;
  focusGrid(): void;
  openRecord(key: number): void;
  input(): StrataCellInput | null;
}

export class CellEditor implements ReactiveController {
  private _editing: Editing | null = null;
  private _problem = "";
  private _claim: RecordClaim | null = null; // the claim to the edited record

  constructor(private readonly _host: CellEditorHost) {
    _host.addController(this);
  }

  get isOpen(): boolean {
    return this._editing !== null;
  }

  /** Shows other users that this user is editing the record. */
  hostUpdate(): void {
    const { view } = this._host;
    const editing = this._editing;
    if (
      this._claim?.key === editing?.key &&
      (editing === null || this._claim?.table === view.tableId)
    )
      return;
    this._claim?.release();
    this._claim = editing ? this._host.session.editors.claim(view.tableId, editing.key) : null;
  }

  hostDisconnected(): void {
    this._claim?.release();
    this._claim = null;
  }

  private put(editing: Editing | null, problem = ""): void {
    this._editing = editing;
    this._problem = problem;
    this._host.requestUpdate();
  }

  /** Renders the field of the edited cell, with its problem. */
  field(edges: readonly number[]): TemplateResult | typeof nothing {
    const editing = this._editing;
    const { table } = this._host.view;
    if (!editing || !table) return nothing;
    const at = table.columns.findIndex((column) => column.id === editing.column.id);
    if (at < 0) return nothing;
    const width = Math.max(
      this._host.widthOf(editing.column),
      kEditorWidth[editing.column.kind] ?? 0,
    );
    return html`<div
        class="editor"
        ${styled({ top: `${editing.row * this._host.rowPx}px`, left: `${edges[at]!}px`, width: `${width}px` })}
        @keydown=${this.onEditorKey}
        @focusout=${this.onEditorLeft}
      >
        <strata-cell-input
          class="in-cell"
          .session=${this._host.session}
          .column=${editing.column}
          .value=${editing.value}
          .typed=${editing.typed}
          .invalid=${this._problem !== ""}
          .fixed=${this.isTaken}
        ></strata-cell-input>
      </div>
      ${this.isTaken ? this.taken(editing, edges[at]!) : nothing}
      ${
        this._problem
          ? html`<div class="bubble" role="alert" ${styled(this._host.beside(editing.row, edges[at]!))}>
            <span class="error">${this._problem}</span>
          </div>`
          : nothing
      }`;
  }

  /** Whether another user is editing the record of the edited cell. */
  private get isTaken(): boolean {
    return this._claim !== null && this._claim.other !== null;
  }

  private taken({ key, row }: Editing, left: number): TemplateResult {
    const words = texts.tables;
    const { user, isMe } = this._claim!.other!;
    return html`<div class="bubble" role="alert" ${styled(this._host.beside(row, left))}>
      <span>${isMe ? words.taken_elsewhere : words.taken_over(user)}</span>
      <div class="row">
        <button @click=${() => void this.takeOver(key)}>${words.take_over}</button>
        <button class="quiet" @click=${() => this.leaveCell()}>${words.give_up}</button>
      </div>
    </div>`;
  }

  /**
   * Asks for confirmation before it takes a record over from another user. Runs `work` if the
   * record is free or was taken over.
   */
  private async takeOver(key: number, work: () => void = () => {}): Promise<void> {
    const words = texts.tables;
    const { session, view } = this._host;
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
      await this._host.updateComplete; // the new edit then makes its own claim
    }
    claim.release();
  }

  private leaveCell(): void {
    this.put(null);
    this._host.focusGrid();
  }

  /** Renders the changes that the server refused, and conflicts with changes by other users. */
  bubbles(table: Table, edges: readonly number[]): unknown {
    return this._host.view.edits.open.map((edit) => {
      const row = this._host.view.rows.indexOf(edit.key);
      const at = table.columns.findIndex((column) => column.slug === edit.slug);
      const writtenAgain =
        this._editing?.key === edit.key && this._editing.column.slug === edit.slug;
      if (row === null || at < 0 || writtenAgain) return nothing;
      return html`<div class="bubble" role="alert" ${styled(this._host.beside(row, edges[at]!))}>
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
      value === null ? words.no_value : this._host.shown(column, value);
    const time = theirs.time ? toldClock(theirs.time) : "";
    return html`<span>${words.changed_by(theirs.user || words.somebody, time)} <b>${shown(theirs.value)}</b></span>
      <span>${words.yours} <b>${shown(edit.value)}</b></span>
      <div class="row">
        <button @click=${() => this.leaveEdit(edit)}>${words.keep_theirs}</button>
        <button class="primary" @click=${() => this.insist(edit)}>${words.take_mine}</button>
      </div>`;
  }

  private leaveEdit(edit: CellEdit): void {
    this._host.view.edits.forget(edit.key, edit.slug);
    this._host.focusGrid();
  }
  private insist(edit: CellEdit): void {
    void this._host.view.edits.insist(edit);
    this._host.focusGrid();
  }

  editAt(row: number, at: number, typed: string | null): void {
    const record = this._host.view.rows.row(row);
    const column = this._host.view.table?.columns[at - 1];
    if (!this._host.session.canPaint || !record || !column) return;
    if (holdsFiles(column) || holdsMarks(column)) {
      this._host.openRecord(record.key);
      return;
    }
    if (this.isHeld(record.key)) void this.takeOver(record.key, () => this.editNow(row, at, typed));
    else this.editNow(row, at, typed);
  }

  private isHeld(key: number): boolean {
    return this._host.session.editors.other(this._host.view.tableId, key) !== null;
  }

  clear(record: TableRecord, { slug }: Column): void {
    const clear = (): void =>
      void this._host.view.write(record.key, slug, null, this.baseOf(record, slug));
    if (this.isHeld(record.key)) void this.takeOver(record.key, clear);
    else clear();
  }

  /** Returns the cell's value for editing, which may still be unsaved. */
  private baseOf({ key, values }: TableRecord, slug: string): CellValue {
    const edit = this._host.view.edits.of(key, slug);
    return edit?.state === "saving" ? edit.value : (values[slug] ?? null);
  }

  private editNow(row: number, at: number, typed: string | null): void {
    const record = this._host.view.rows.row(row);
    const column = this._host.view.table?.columns[at - 1];
    if (!record || !column) return;
    this._host.show(row, at);
    const base = this.baseOf(record, column.slug);
    this.put({
      key: record.key,
      row,
      column,
      value: this._host.view.edits.of(record.key, column.slug)?.value ?? base,
      base,
      typed,
    });
    void this._host.updateComplete.then(async () => {
      const input = this._host.input();
      await input?.updateComplete;
      input?.begin();
    });
  }

  /**
   * Returns false for an invalid value, or if another user has taken the record over. The field
   * keeps the text.
   */
  private commit(): boolean {
    const editing = this._editing;
    const read = this._host.input()?.read();
    if (!editing || !read) return true;
    if (this.isTaken) return false;
    if ("problem" in read) {
      this.put(editing, read.problem);
      return false;
    }
    this.put(null);
    this._host.view.write(editing.key, editing.column.slug, read.value, editing.base);
    return true;
  }

  private readonly onEditorKey = (event: KeyboardEvent): void => {
    const { row, column } = this._host.active;
    if (event.key === "Escape") {
      this.leaveCell();
    } else if (event.key === "Enter" && !event.shiftKey && !event.altKey) {
      if (this.commit()) this._host.moveTo(row + 1, column);
    } else if (event.key === "Tab") {
      if (this.commit()) this.editBeside(row, column, event.shiftKey ? -1 : 1);
    } else {
      event.stopPropagation();
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  /** Moves to the next editable cell. The next cell after the end of a row is in the next row. */
  private editBeside(row: number, column: number, step: 1 | -1): void {
    const count = this._host.view.table?.columns.length ?? 0;
    const next = column + step;
    if (next < 1) [row, column] = [row - 1, count];
    else if (next > count) [row, column] = [row + 1, 1];
    else column = next;
    if (row < 0 || row >= this._host.view.rows.total || count === 0) {
      this._host.focusGrid();
      return;
    }
    this._host.moveTo(row, column);
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
}
