// <strata-cell-input>: the field for a value of a column, by its kind. In a cell of the table and
// in the form of a record alike.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import {
  cell_text,
  holds_files,
  is_number,
  label_of,
  named_keys,
  names_records,
  parse_cell,
} from "../../domain/cells";
import { holds_marks, marks_of } from "../../domain/marks";
import type { CellValue, Column } from "../../core/protocol.gen";
import type { ModelSession } from "../model-session";
import "./files-field";
import type { StrataFilesField } from "./files-field";
import "./marks-field";
import type { StrataMarksField } from "./marks-field";
import { StrataRecordChooser } from "./record-chooser";
import { number_field_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

export type CellRead = { value: CellValue } | { problem: string };

/** Whether what is typed can begin a new value; the others are chosen. */
export const takes_typing = (column: Column): boolean =>
  !names_records(column) &&
  !holds_marks(column) &&
  !holds_files(column) &&
  column.kind !== "boolean" &&
  column.kind !== "enumeration" &&
  column.kind !== "date";

/**
 * Whether a character may be meant as text in a cell of the column. What may not is left to the
 * keys of the page.
 */
export function may_be_text(column: Column, character: string): boolean {
  if (is_number(column)) return /[-+.,\d]/.test(character);
  if (column.kind === "timestamp" || column.kind === "date") return /\d/.test(character);
  return takes_typing(column);
}

@customElement("strata-cell-input")
export class StrataCellInput extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) column!: Column;
  @property({ attribute: false }) value: CellValue = null;
  /** What was typed to begin with: it takes the place of the value. */
  @property({ attribute: false }) typed: string | null = null;
  @property({ type: Boolean }) invalid = false;
  /** What it holds can be read and copied, but not changed. */
  @property({ type: Boolean, reflect: true }) fixed = false;
  /** Columns of files: the record that they are of, where it is there already. */
  @property({ attribute: false }) record: { table: number; key: number | null } | null = null;
  @query("strata-files-field") private files_!: StrataFilesField | null;
  @query("strata-marks-field") private marks_!: StrataMarksField | null;
  @query("input, select, textarea, strata-record-chooser") private control_!:
    HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement | StrataRecordChooser;

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override styles = [
    shared_styles,
    number_field_styles,
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
      input[type="date"] {
        width: 100%;
        min-height: 38px;
        padding: 6px 10px;
        border: var(--edge) solid var(--line-strong);
        border-radius: var(--radius-small);
        background: var(--raised);
      }
      :host([fixed]) :is(input, textarea, select, .number) {
        background: var(--surface);
        color: var(--ink-soft);
      }
      :host([fixed]) [inert] {
        opacity: var(--unavailable);
      }
      :host(.in-cell) :is(input, select, textarea) {
        min-height: 28px;
        padding: 2px 6px;
        font-size: 0.9rem;
      }
      :host(.in-cell) .number > span {
        padding-right: 6px;
      }
    `,
  ];

  override firstUpdated(): void {
    if (this.typed !== null && takes_typing(this.column))
      (this.control_ as HTMLInputElement).value = this.typed;
  }

  /** What is in the field now. */
  read(): CellRead {
    const { column } = this;
    if (this.files_) return { value: this.files_.ids.length > 0 ? [...this.files_.ids] : null };
    if (this.marks_) return { value: this.marks_.marks.length > 0 ? [...this.marks_.marks] : null };
    if (names_records(column)) {
      const keys = [...(this.control_ as StrataRecordChooser).chosen];
      return {
        value: column.kind === "relation" ? (keys.length > 0 ? keys : null) : (keys[0] ?? null),
      };
    }
    const control = this.control_ as HTMLInputElement;
    if (control.validity.badInput) return { problem: texts.tables.bad_date };
    const parsed = parse_cell(column, control.value);
    if ("value" in parsed) return parsed;
    return { problem: parsed.wrong === "whole" ? texts.tables.bad_whole : texts.tables.bad_number };
  }

  /** In place of what was typed. */
  put(value: CellValue): void {
    if (this.files_) {
      this.files_.ids = named_keys(value);
      return;
    }
    if (this.marks_) {
      this.marks_.marks = marks_of(value);
      return;
    }
    const control = this.control_;
    if ("chosen" in control) control.chosen = named_keys(value);
    else control.value = cell_text(value);
  }

  /** Files that wait to be sent. */
  get files(): StrataFilesField | null {
    return this.files_;
  }

  /** To write on: all of the value, or behind what was typed. */
  begin(): void {
    this.focus({ preventScroll: true });
    const control = this.control_;
    const is_text =
      control instanceof HTMLTextAreaElement ||
      (control instanceof HTMLInputElement && control.type === "text");
    if (control instanceof StrataRecordChooser) control.open();
    if (is_text)
      control.setSelectionRange(
        this.typed === null ? 0 : control.value.length,
        control.value.length,
      );
  }

  override render(): TemplateResult {
    const { column, value } = this;
    const label = label_of(column);
    const invalid = this.invalid ? "true" : "false";
    switch (column.kind) {
      case "term":
      case "relation":
        return html`<strata-record-chooser
          ?inert=${this.fixed}
          class=${this.classList.contains("in-cell") ? "in-cell" : ""}
          .session=${this.session}
          .table=${column.target ?? 0}
          .chosen=${named_keys(value)}
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
          .ids=${named_keys(value)}
        ></strata-files-field>`;
      case "line":
      case "point":
        return html`<strata-marks-field ?inert=${this.fixed} .session=${this.session} .column=${column} .marks=${marks_of(value)}></strata-marks-field>`;
      case "boolean":
        return this.choice(label, value === null ? "" : String(value), [
          ["true", texts.tables.yes],
          ["false", texts.tables.no],
        ]);
      case "enumeration":
        return this.choice(
          label,
          cell_text(value),
          (column.choices ?? []).map((choice) => [choice, choice]),
        );
      case "text":
        return html`<textarea rows="1" maxlength="100000" ?readonly=${this.fixed} aria-label=${label} aria-invalid=${invalid} .value=${cell_text(value)}></textarea>`;
      case "date":
        return html`<input type="date" min="0001-01-01" max="9999-12-31" ?readonly=${this.fixed} aria-label=${label} aria-invalid=${invalid} .value=${cell_text(value)} />`;
      default: {
        const unit = is_number(column) ? (column.unit ?? "") : "";
        const input = html`<input
          type="text"
          inputmode=${is_number(column) ? "decimal" : column.kind === "url" ? "url" : "text"}
          spellcheck="false"
          autocapitalize="off"
          ?readonly=${this.fixed}
          aria-label=${label}
          aria-invalid=${invalid}
          placeholder=${texts.tables.examples[column.kind] ?? ""}
          .value=${cell_text(value)}
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
