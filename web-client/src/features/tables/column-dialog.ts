// <strata-column-dialog>: creates a column of a table, or changes its name, kind and rules.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { kAsItIs } from "../../net/api";
import { cellText, labelOf, parseCell } from "../../domain/cells";
import { formatList } from "../../core/locale";
import type {
  Column,
  ColumnChanged,
  ColumnCreate,
  ColumnKind,
  Table,
  Visibility,
} from "../../core/protocol.gen";
import { columnChanges, hasLimits, hasTarget, ofKind, type ColumnWanted } from "./column-changes";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import "../../ui/labels-field";
import type { StrataLabelsField } from "../../ui/labels-field";
import type { ModelSession } from "../../session/model-session";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { visibilityChoice } from "../../ui/visibility";

const words = texts.column_dialog;
const kKinds = Object.keys(words.kinds) as ColumnKind[];
const kNoLabels = {};

@customElement("strata-column-dialog")
export class StrataColumnDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) table!: Table;
  /** Null for a new column. */
  @property({ attribute: false }) column: Column | null = null;
  @state() private _kind: ColumnKind = "text";
  @state() private _visibility: Visibility = "public";
  @state() private _tables: Table[] = [];
  @state() private _problem = "";
  @state() private _busy = false;
  // values were lost; the user must confirm or undo
  @state() private _outcome: ColumnChanged | null = null;
  @query("strata-dialog") private _dialog!: StrataDialog;
  @query("form") private _form!: HTMLFormElement;
  @query("strata-labels-field") private _labels!: StrataLabelsField;

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      .three {
        display: grid;
        grid-template-columns: repeat(3, minmax(0, 1fr));
        gap: var(--space-3);
      }
      .checks {
        display: flex;
        gap: var(--space-6);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._kind = this.column?.kind ?? "text";
    this._visibility = this.column?.visibility ?? "public";
    void this.session.tables.all().then(
      (tables) => (this._tables = tables),
      (error: unknown) =>
        (this._problem = error instanceof ApiError ? error.message : texts.problems.unexpected),
    );
  }

  override render(): TemplateResult {
    const { column, _outcome: outcome } = this;
    const heading = column
      ? words.edit_title(labelOf(column))
      : words.create_title(labelOf(this.table));
    return html`<strata-dialog heading=${heading} way_out=${outcome ? "" : texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${outcome ? this.lost(outcome) : this.form()}
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${
        outcome
          ? html`<button slot="actions" ?disabled=${this._busy} @click=${() => void this.takeBack()}>${words.take_back}</button>
            <button slot="actions" class="primary" @click=${() => this._dialog.close()}>${words.keep}</button>`
          : html`<button slot="actions" class="primary" ?disabled=${this._busy} @click=${() => this._form.requestSubmit()}>
            ${column ? texts.save : words.create}
          </button>`
      }
    </strata-dialog>`;
  }

  private form(): TemplateResult {
    const { column, _kind: kind } = this;
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
      <strata-labels-field .labels=${column?.labels ?? kNoLabels} @keydown=${this.onKey}></strata-labels-field>
      <label class="field">
        <span>${words.kind}</span>
        <select name="kind" @change=${(event: Event) => (this._kind = (event.target as HTMLSelectElement).value as ColumnKind)}>
          ${kKinds.map((each) => html`<option value=${each} ?selected=${each === kind}>${words.kinds[each]}</option>`)}
        </select>
      </label>
      ${column && column.kind !== kind ? html`<p class="hint" role="status">${words.retype_hint}</p>` : nothing}
      ${
        hasLimits(kind)
          ? html`<div class="three">
            <label class="field"><span>${words.unit}</span><input type="text" name="unit" maxlength="40" .value=${column?.unit ?? ""} /></label>
            <label class="field"
              ><span>${words.minimum}</span><input type="text" inputmode="decimal" name="minimum" .value=${cellText(column?.minimum)}
            /></label>
            <label class="field"
              ><span>${words.maximum}</span><input type="text" inputmode="decimal" name="maximum" .value=${cellText(column?.maximum)}
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
        hasTarget(kind)
          ? html`<label class="field">
            <span>${words.target}</span>
            <select name="target">
              ${this._tables.map(
                (table) =>
                  html`<option value=${table.id} ?selected=${table.id === (column?.target ?? this.table.id)}>${labelOf(table)}</option>`,
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
      ${visibilityChoice(this._visibility, (visibility) => (this._visibility = visibility))}
    </form>`;
  }

  private lost({
    converted = 0,
    lost = 0,
    lost_keys: lostKeys = [],
  }: ColumnChanged): TemplateResult {
    return html`<p>${words.lost(lost, converted)}</p>
      <p class="hint">${words.lost_of(formatList(lostKeys.map(String)))}</p>`;
  }

  /** Enter saves, also from a field inside another element. */
  private onKey(event: KeyboardEvent): void {
    if (event.key !== "Enter" || event.composedPath()[0] instanceof HTMLButtonElement) return;
    event.preventDefault();
    this._form.requestSubmit();
  }

  /**
   * Returns the input, or the text of a problem. The text is empty if the field itself shows the
   * problem.
   */
  private wanted(): ColumnWanted | string {
    const data = new FormData(this._form);
    const text = (name: string): string => String(data.get(name) ?? "").trim();
    const limits = ["minimum", "maximum"].map((name) => parseCell({ kind: "numeric" }, text(name)));
    const [minimum, maximum] = limits.map((parsed) =>
      "value" in parsed ? (parsed.value as number | null) : undefined,
    );
    if (text("name") === "") return words.name_missing;
    if (minimum === undefined || maximum === undefined) return texts.tables.bad_number;
    const labels = this._labels.read();
    if (!labels) return "";
    return {
      name: text("name"),
      labels,
      kind: this._kind,
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
    this._problem = typeof wanted === "string" ? wanted : "";
    if (typeof wanted === "string" || this._busy) return;
    const { column, table, session } = this;
    await this.work(async () => {
      if (!column) {
        await session.api.json("POST /tables/{table}/columns", {
          path: { table: table.id },
          body: {
            ...ofKind(wanted),
            visibility: this._visibility,
          } as ColumnCreate,
        });
      } else {
        // The visibility is a separate request without a journal entry. It comes first, so only
        // permitted users can see the later changes.
        if (this._visibility !== column.visibility)
          await session.api.json("PATCH /tables/{table}/columns/{column}", {
            path: { table: table.id, column: column.id },
            body: { visibility: this._visibility },
            header: kAsItIs,
          });
        const change = columnChanges(column, wanted);
        const outcome =
          Object.keys(change).length > 0
            ? await session.api.json("PATCH /tables/{table}/columns/{column}", {
                path: { table: table.id, column: column.id },
                body: change,
                header: kAsItIs,
              })
            : null;
        if (outcome?.lost) this._outcome = outcome;
      }
      await session.tables.reload(table.id);
      if (!this._outcome) this.dispatchEvent(new CustomEvent("closed"));
    });
  }

  /** Restores the column and all its values. */
  private async takeBack(): Promise<void> {
    await this.work(async () => {
      await this.session.api.json("POST /tables/{table}/undo", { path: { table: this.table.id } });
      await this.session.tables.reload(this.table.id);
      this.dispatchEvent(new CustomEvent("closed"));
    });
  }

  private async work(task: () => Promise<void>): Promise<void> {
    this._busy = true;
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (/^labels\b/.test(error.problem.field ?? "")) this._labels.refuse(error.message);
      else this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}
