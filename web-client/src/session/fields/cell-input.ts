// <strata-cell-input>: the input field for a value of a column. Its type depends on the kind of the
// column. Cells of the table and the form of a record use it.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import {
  cellText,
  holdsFiles,
  isNumber,
  labelOf,
  namedKeys,
  namesRecords,
  parseCell,
} from "../../domain/cells";
import { holdsMarks, marksOf } from "../../domain/marks";
import type { CellValue, Column } from "../../core/protocol.gen";
import type { ModelSession } from "../model-session";
import "./files-field";
import type { StrataFilesField } from "./files-field";
import "./marks-field";
import type { StrataMarksField } from "./marks-field";
import { StrataRecordChooser } from "./record-chooser";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

export type CellRead = { value: CellValue } | { problem: string };

/** Whether users type the values of the column. They choose values of other kinds. */
export const takesTyping = (column: Column): boolean =>
  !namesRecords(column) &&
  !holdsMarks(column) &&
  !holdsFiles(column) &&
  column.kind !== "boolean" &&
  column.kind !== "enumeration" &&
  column.kind !== "date";

/**
 * Whether a character can be part of a value of the column. All other characters are available for
 * the page's shortcuts.
 */
export function mayBeText(column: Column, character: string): boolean {
  if (isNumber(column)) return /[-+.,\d]/.test(character);
  if (column.kind === "timestamp" || column.kind === "date") return /\d/.test(character);
  return takesTyping(column);
}

@customElement("strata-cell-input")
export class StrataCellInput extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) column!: Column;
  @property({ attribute: false }) value: CellValue = null;
  /** The text that the user typed to start editing. It replaces the value. */
  @property({ attribute: false }) typed: string | null = null;
  @property({ type: Boolean }) invalid = false;
  /** Whether the value can be read and copied, but not changed. */
  @property({ type: Boolean, reflect: true }) fixed = false;
  /** The record, for columns of files. Its key is null if it does not exist yet. */
  @property({ attribute: false }) record: { table: number; key: number | null } | null = null;
  @query("strata-files-field") private _files!: StrataFilesField | null;
  @query("strata-marks-field") private _marks!: StrataMarksField | null;
  @query("input, select, textarea, strata-record-chooser") private _control!:
    HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement | StrataRecordChooser;

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      :host {
        display: block;
        min-width: 0;
      }
      textarea {
        min-height: 38px;
        max-height: 180px;
        resize: none;
        field-sizing: content;
      }
      :host([fixed]) :is(input, textarea, select, .number) {
        background: var(--surface);
        color: var(--ink-soft);
      }
      :host([fixed]) [inert] {
        opacity: var(--unavailable);
      }
      :host(.in-cell) :is(input, select, textarea) {
        min-height: var(--control-small);
        padding-block: var(--space-half);
        font-size: var(--text-small);
      }
      :host(.in-cell) .number > span {
        padding-right: var(--space-2);
      }
    `,
  ];

  override firstUpdated(): void {
    if (this.typed !== null && takesTyping(this.column))
      (this._control as HTMLInputElement).value = this.typed;
  }

  /** Returns the current value of the field. */
  read(): CellRead {
    const { column } = this;
    if (this._files) return { value: this._files.ids.length > 0 ? [...this._files.ids] : null };
    if (this._marks) return { value: this._marks.marks.length > 0 ? [...this._marks.marks] : null };
    if (namesRecords(column)) {
      const keys = [...(this._control as StrataRecordChooser).chosen];
      return {
        value: column.kind === "relation" ? (keys.length > 0 ? keys : null) : (keys[0] ?? null),
      };
    }
    const control = this._control as HTMLInputElement;
    if (control.validity.badInput) return { problem: texts.tables.bad_date };
    const parsed = parseCell(column, control.value);
    if ("value" in parsed) return parsed;
    return { problem: parsed.wrong === "whole" ? texts.tables.bad_whole : texts.tables.bad_number };
  }

  /** Replaces the value in the field. */
  put(value: CellValue): void {
    if (this._files) {
      this._files.ids = namedKeys(value);
      return;
    }
    if (this._marks) {
      this._marks.marks = marksOf(value);
      return;
    }
    const control = this._control;
    if ("chosen" in control) control.chosen = namedKeys(value);
    else control.value = cellText(value);
  }

  /** The field for files, which may have pending files. */
  get files(): StrataFilesField | null {
    return this._files;
  }

  /** Starts editing: selects the whole value, or places the caret after the typed text. */
  begin(): void {
    this.focus({ preventScroll: true });
    const control = this._control;
    const isText =
      control instanceof HTMLTextAreaElement ||
      (control instanceof HTMLInputElement && control.type === "text");
    if (control instanceof StrataRecordChooser) control.open();
    if (isText)
      control.setSelectionRange(
        this.typed === null ? 0 : control.value.length,
        control.value.length,
      );
  }

  override render(): TemplateResult {
    const { column, value } = this;
    const label = labelOf(column);
    const invalid = this.invalid ? "true" : "false";
    switch (column.kind) {
      case "term":
      case "relation":
        return html`<strata-record-chooser
          ?inert=${this.fixed}
          class=${this.classList.contains("in-cell") ? "in-cell" : ""}
          .session=${this.session}
          .table=${column.target ?? 0}
          .chosen=${namedKeys(value)}
          .multiple=${column.kind === "relation"}
          .invalid=${this.invalid}
          label=${label}
        ></strata-record-chooser>`;
      case "picture":
      case "document":
        return html`<strata-files-field
          ?inert=${this.fixed}
          .session=${this.session}
          .column=${column}
          .table=${this.record?.table ?? 0}
          .record=${this.record?.key ?? null}
          .ids=${namedKeys(value)}
        ></strata-files-field>`;
      case "line":
      case "point":
        return html`<strata-marks-field ?inert=${this.fixed} .session=${this.session} .column=${column} .marks=${marksOf(value)}></strata-marks-field>`;
      case "boolean":
        return this.choice(label, value === null ? "" : String(value), [
          ["true", texts.tables.yes],
          ["false", texts.tables.no],
        ]);
      case "enumeration":
        return this.choice(
          label,
          cellText(value),
          (column.choices ?? []).map((choice) => [choice, choice]),
        );
      case "text":
        return html`<textarea rows="1" maxlength="100000" ?readonly=${this.fixed} aria-label=${label} aria-invalid=${invalid} .value=${cellText(value)}></textarea>`;
      case "date":
        return html`<input type="date" min="0001-01-01" max="9999-12-31" ?readonly=${this.fixed} aria-label=${label} aria-invalid=${invalid} .value=${cellText(value)} />`;
      default: {
        const unit = isNumber(column) ? (column.unit ?? "") : "";
        const input = html`<input
          type="text"
          inputmode=${isNumber(column) ? "decimal" : column.kind === "url" ? "url" : "text"}
          spellcheck="false"
          autocapitalize="off"
          ?readonly=${this.fixed}
          aria-label=${label}
          aria-invalid=${invalid}
          placeholder=${texts.tables.examples[column.kind] ?? ""}
          .value=${cellText(value)}
        />`;
        return unit ? html`<span class="number"><span>${unit}</span>${input}</span>` : input;
      }
    }
  }

  private choice(label: string, chosen: string, choices: [string, string][]): TemplateResult {
    return html`<select ?disabled=${this.fixed} aria-label=${label} aria-invalid=${this.invalid ? "true" : "false"}>
      ${this.column.required && chosen !== "" ? nothing : html`<option value="" ?selected=${chosen === ""}></option>`}
      ${choices.map(([value, text]) => html`<option value=${value} ?selected=${value === chosen}>${text}</option>`)}
    </select>`;
  }
}
