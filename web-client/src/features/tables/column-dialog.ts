// <strata-column-dialog>: a new column of a table, or what one is called, holds and asks for.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { cell_text, label_of, parse_cell } from "../../domain/cells";
import { format_list } from "../../core/locale";
import type {
  Column,
  ColumnChanged,
  ColumnCreate,
  ColumnKind,
  Table,
  Visibility,
} from "../../core/protocol.gen";
import {
  column_changes,
  has_limits,
  has_target,
  kColumnKinds,
  of_kind,
  type ColumnWanted,
} from "./column-changes";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import "../../ui/labels-field";
import type { StrataLabelsField } from "../../ui/labels-field";
import type { ModelSession } from "../../session/model-session";
import { form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import { visibility_choice } from "../../ui/visibility";

const words = texts.column_dialog;
const kNoLabels = {};

@customElement("strata-column-dialog")
export class StrataColumnDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) table!: Table;
  /** Null: a new one. */
  @property({ attribute: false }) column: Column | null = null;
  @state() private kind_: ColumnKind = "text";
  @state() private visibility_: Visibility = "public";
  @state() private tables_: Table[] = [];
  @state() private problem_ = "";
  @state() private busy_ = false;
  @state() private outcome_: ColumnChanged | null = null; // values were lost: is that well?
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("form") private form_!: HTMLFormElement;
  @query("strata-labels-field") private labels_!: StrataLabelsField;

  static override styles = [
    shared_styles,
    form_styles,
    css`
      .three {
        display: grid;
        grid-template-columns: repeat(3, minmax(0, 1fr));
        gap: 12px;
      }
      .checks {
        display: flex;
        gap: 22px;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.kind_ = this.column?.kind ?? "text";
    this.visibility_ = this.column?.visibility ?? "public";
    void this.session.tables.all().then(
      (tables) => (this.tables_ = tables),
      (error: unknown) =>
        (this.problem_ = error instanceof ApiError ? error.message : texts.problems.unexpected),
    );
  }

  override render(): TemplateResult {
    const { column, outcome_: outcome } = this;
    const heading = column
      ? words.edit_title(label_of(column))
      : words.create_title(label_of(this.table));
    return html`<strata-dialog heading=${heading} way_out=${outcome ? "" : texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${outcome ? this.lost(outcome) : this.form()}
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      ${
        outcome
          ? html`<button slot="actions" ?disabled=${this.busy_} @click=${() => void this.take_back()}>${words.take_back}</button>
            <button slot="actions" class="primary" @click=${() => this.dialog_.close()}>${words.keep}</button>`
          : html`<button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => this.form_.requestSubmit()}>
            ${column ? texts.save : words.create}
          </button>`
      }
    </strata-dialog>`;
  }

  private form(): TemplateResult {
    const { column, kind_: kind } = this;
    return html`<form
      novalidate
      @submit=${(event: Event) => {
        event.preventDefault();
        void this.save();
      }}
    >
      <label class="field">
        <span>${words.name}</span>
        <input type="text" name="name" maxlength="200" autofocus .value=${column?.name ?? ""} />
      </label>
      <strata-labels-field .labels=${column?.labels ?? kNoLabels} @keydown=${this.on_key}></strata-labels-field>
      <label class="field">
        <span>${words.kind}</span>
        <select name="kind" @change=${(event: Event) => (this.kind_ = (event.target as HTMLSelectElement).value as ColumnKind)}>
          ${kColumnKinds.map((each) => html`<option value=${each} ?selected=${each === kind}>${words.kinds[each]}</option>`)}
        </select>
      </label>
      ${column && column.kind !== kind ? html`<p class="hint" role="status">${words.retype_hint}</p>` : nothing}
      ${
        has_limits(kind)
          ? html`<div class="three">
            <label class="field"><span>${words.unit}</span><input type="text" name="unit" maxlength="40" .value=${column?.unit ?? ""} /></label>
            <label class="field"
              ><span>${words.minimum}</span><input type="text" inputmode="decimal" name="minimum" .value=${cell_text(column?.minimum)}
            /></label>
            <label class="field"
              ><span>${words.maximum}</span><input type="text" inputmode="decimal" name="maximum" .value=${cell_text(column?.maximum)}
            /></label>
          </div>`
          : nothing
      }
      ${
        kind === "enumeration"
          ? html`<label class="field">
            <span>${words.choices}</span>
            <textarea name="choices" rows="4" .value=${(column?.choices ?? []).join("\n")}></textarea>
          </label>`
          : nothing
      }
      ${
        has_target(kind)
          ? html`<label class="field">
            <span>${words.target}</span>
            <select name="target">
              ${this.tables_.map(
                (table) =>
                  html`<option value=${table.id} ?selected=${table.id === (column?.target ?? this.table.id)}>${label_of(table)}</option>`,
              )}
            </select>
          </label>`
          : nothing
      }
      <div class="checks">
        <label class="check"><input type="checkbox" name="required" .checked=${column?.required ?? false} />${words.required}</label>
        <label class="check"><input type="checkbox" name="unique" .checked=${column?.unique ?? false} />${words.unique}</label>
      </div>
      <label class="field">
        <span>${words.comment}</span>
        <textarea name="comment" rows="2" maxlength="2000" placeholder=${words.comment_hint} .value=${column?.comment ?? ""}></textarea>
      </label>
      ${visibility_choice(this.visibility_, (visibility) => (this.visibility_ = visibility))}
    </form>`;
  }

  private lost({ converted = 0, lost = 0, lost_keys = [] }: ColumnChanged): TemplateResult {
    return html`<p>${words.lost(lost, converted)}</p>
      <p class="hint numeric">${words.lost_of(format_list(lost_keys.map(String)))}</p>`;
  }

  /** Enter saves, also from a field in an element of its own. */
  private on_key(event: KeyboardEvent): void {
    if (event.key !== "Enter" || event.composedPath()[0] instanceof HTMLButtonElement) return;
    event.preventDefault();
    this.form_.requestSubmit();
  }

  /** Otherwise what is wrong; empty where that is said at its field. */
  private wanted(): ColumnWanted | string {
    const data = new FormData(this.form_);
    const text = (name: string): string => String(data.get(name) ?? "").trim();
    const limits = ["minimum", "maximum"].map((name) =>
      parse_cell({ kind: "numeric" }, text(name)),
    );
    const [minimum, maximum] = limits.map((parsed) =>
      "value" in parsed ? (parsed.value as number | null) : undefined,
    );
    if (text("name") === "") return words.name_missing;
    if (minimum === undefined || maximum === undefined) return texts.tables.bad_number;
    const labels = this.labels_.read();
    if (!labels) return "";
    return {
      name: text("name"),
      labels,
      kind: this.kind_,
      unit: text("unit"),
      required: data.has("required"),
      unique: data.has("unique"),
      comment: text("comment"),
      choices: text("choices")
        .split("\n")
        .map((choice) => choice.trim())
        .filter((choice) => choice !== ""),
      target: Number(text("target")) || null,
      minimum,
      maximum,
    };
  }

  private async save(): Promise<void> {
    const wanted = this.wanted();
    this.problem_ = typeof wanted === "string" ? wanted : "";
    if (typeof wanted === "string" || this.busy_) return;
    const { column, table, session } = this;
    await this.work(async () => {
      if (!column) {
        await session.api.create_column(table.id, {
          ...of_kind(wanted),
          visibility: this.visibility_,
        } as ColumnCreate);
      } else {
        // In a call of its own, which is no entry of the journal; the first, so that what follows
        // is seen by none who should not.
        if (this.visibility_ !== column.visibility)
          await session.api.change_column(table.id, column.id, { visibility: this.visibility_ });
        const change = column_changes(column, wanted);
        const outcome =
          Object.keys(change).length > 0
            ? await session.api.change_column(table.id, column.id, change)
            : null;
        if (outcome?.lost) this.outcome_ = outcome;
      }
      await session.tables.reload(table.id);
      if (!this.outcome_) this.dispatchEvent(new CustomEvent("closed"));
    });
  }

  /** The column is as it was, with all its values. */
  private async take_back(): Promise<void> {
    await this.work(async () => {
      await this.session.api.undo_table(this.table.id);
      await this.session.tables.reload(this.table.id);
      this.dispatchEvent(new CustomEvent("closed"));
    });
  }

  private async work(task: () => Promise<void>): Promise<void> {
    this.busy_ = true;
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (/^labels\b/.test(error.problem.field ?? "")) this.labels_.refuse(error.message);
      else this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
