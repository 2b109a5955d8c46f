// <strata-record-dialog>: a form for a new or existing record, generated from its table.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { readRecord, createRecord, changeRecord, lastEditOf } from "../../net/records";
import { cellText, holdsFiles, labelOf, sameValue } from "../../domain/cells";
import { formatArea } from "../../domain/measure";
import { cssColor, recordColor } from "../../domain/palette";
import type { CellValues, Column, Table, TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import "../../session/fields/cell-input";
import "../../ui/copy-field";
import type { StrataCellInput } from "../../session/fields/cell-input";
import { ask } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import type { RecordClaim } from "../../session/record-editors";
import { formStyles, sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const words = texts.tables;

@customElement("strata-record-dialog")
export class StrataRecordDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  /** Null for a new record. */
  @property({ attribute: false }) key: number | null = null;
  /** Called with the key of each record that was made. */
  @property({ attribute: false }) made: ((key: number) => void) | null = null;
  @state() private _record: TableRecord | null = null; // the loaded version
  @state() private _problem = "";
  @state() private _sending = "";
  @state() private _fieldProblems = new Map<string, string>(); // keyed by slug
  @state() private _busy = false;
  @state() private _written = ""; // the unsaved input after another user took the record over
  private _claim: RecordClaim | null = null;
  private _shut = false; // whether another user was editing the record at the last rendering
  @query("form") private _form!: HTMLFormElement | null;

  constructor() {
    super();
    followSession(this, "tables", "layers", "editors", "together");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      .facts {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      .other {
        display: grid;
        grid-template-columns: auto 1fr auto;
        align-items: center;
        gap: var(--space-2) var(--space-2);
        padding: var(--space-2) var(--space-3);
        border: var(--edge) solid var(--calm);
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        font-size: var(--text-small);
      }
      .other strata-copy-field {
        grid-column: 1 / -1;
      }
      .field-row {
        display: grid;
        gap: var(--space-1);
      }
      .field-row .caption b {
        color: var(--danger);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.key === null) return;
    void this.load(this.key);
    if (this.layer.table !== undefined)
      this._claim = this.session.editors.claim(this.layer.table, this.key);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._claim?.release();
    this._claim = null;
  }

  /**
   * Keeps the input when another user takes the record over. A user who waited for the record
   * starts with its saved version.
   */
  override willUpdate(): void {
    const shut = this._claim !== null && this._claim.other !== null;
    if (shut === this._shut) return;
    this._shut = shut;
    const { table } = this;
    if (shut && this._claim!.lost && table) this._written = this.inWords(table);
    else if (!shut && this._written === "" && this.key !== null) void this.load(this.key);
  }

  private get table(): Table | null {
    return this.layer.table === undefined ? null : this.session.tables.find(this.layer.table);
  }

  private async load(key: number): Promise<void> {
    try {
      const record = await readRecord(
        this.session.api,
        { model: this.session.modelId, layer: this.layer.id },
        key,
      );
      const again = this._record !== null;
      this._record = record;
      if (!again) return;
      await this.updateComplete;
      for (const { slug } of this.table?.columns ?? [])
        this.inputOf(slug)?.put(record.values[slug] ?? null);
    } catch (error) {
      this._problem = error instanceof ApiError ? error.message : texts.problems.unexpected;
    }
  }

  override render(): TemplateResult {
    const { table, _record: record, key } = this;
    const ready = table !== null && (key === null || record !== null);
    const name =
      table && record ? this.session.tables.title(table, record) || words.record(record.key) : "";
    return html`<strata-dialog
      heading=${key === null ? words.new_record_of(table ? labelOf(table) : "") : name}
      way_out=${texts.cancel}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${this._claim?.other ? this.held(this._claim, name) : nothing} ${record ? this.facts(record) : nothing}
      ${ready ? this.form(table) : html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`}
      <p class="hint" role="status" ?hidden=${!this._sending}>${this._sending}</p>
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${
        key === null
          ? html`<button slot="actions" ?disabled=${this._busy || !ready} @click=${() => void this.save(true)}>${words.save_next}</button>`
          : nothing
      }
      <button slot="actions" class="primary" ?disabled=${this._busy || !ready || this._shut} @click=${() => this._form?.requestSubmit()}>${texts.save}</button>
    </strata-dialog>`;
  }

  private held(claim: RecordClaim, name: string): TemplateResult {
    const { user, isMe } = claim.other!;
    const kept = claim.lost && this._written !== "";
    const told = kept
      ? isMe
        ? words.taken_elsewhere
        : words.taken_over(user)
      : isMe
        ? words.edited_elsewhere
        : words.edited_by(user);
    const takeOver = async (): Promise<void> => {
      const lead = isMe ? words.take_over_own : words.take_over_lead(user);
      if (await ask({ heading: words.take_over_title(name), lead, yes: words.take_over }))
        claim.takeOver();
    };
    return html`<div class="other" role="alert">
      ${icon("edit")}<span>${told}</span><button @click=${() => void takeOver()}>${words.take_over}</button>
      ${kept ? html`<strata-copy-field .label=${words.written} .text=${this._written}></strata-copy-field>` : nothing}
    </div>`;
  }

  private facts(record: TableRecord): TemplateResult {
    const color = recordColor(this.session.layers.palette(this.layer), record);
    return html`<div class="facts hint">
      ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}
      <span>${words.key_is(record.key)}</span>
      <span>${record.area_m2 ? words.area_on(formatArea(record.area_m2), labelOf(this.layer)) : words.not_painted_on(labelOf(this.layer))}</span>
    </div>`;
  }

  private form(table: Table): TemplateResult {
    return html`<form
      novalidate
      @submit=${(event: Event) => {
        event.preventDefault();
        void this.save(false);
      }}
      @draw=${(event: CustomEvent<Column>) => void this.draw(event.detail)}
      @keydown=${this.onKey}
    >
      ${table.columns.length === 0 ? html`<p class="hint">${words.no_columns}</p>` : nothing}
      ${table.columns.map((column) => this.field(column))}
    </form>`;
  }

  private field(column: Column): TemplateResult {
    const problem = this._fieldProblems.get(column.slug) ?? "";
    const value = this._record
      ? (this._record.values[column.slug] ?? null)
      : (column.default ?? null);
    return html`<div class="field-row">
      <span class="caption" @click=${() => this.inputOf(column.slug)?.focus()}
        >${labelOf(column)}${column.required ? html` <b title=${words.required}>*</b>` : nothing}</span
      >
      <strata-cell-input
        data-slug=${column.slug}
        .session=${this.session}
        .column=${column}
        .value=${value}
        .record=${{ table: this.layer.table ?? 0, key: this._record?.key ?? null }}
        .invalid=${problem !== ""}
        .fixed=${this._shut}
      ></strata-cell-input>
      ${column.comment ? html`<span class="hint">${column.comment}</span>` : nothing}
      ${problem ? html`<span class="error" role="alert">${problem}</span>` : nothing}
    </div>`;
  }

  /** Returns the differences from the record, with one line for each column. */
  private inWords(table: Table): string {
    const lines: string[] = [];
    for (const column of table.columns) {
      const read = this.inputOf(column.slug)?.read();
      if (!read || !("value" in read) || sameValue(read.value, this._record?.values[column.slug]))
        continue;
      lines.push(`${labelOf(column)}: ${cellText(read.value)}`);
    }
    return lines.join("\n");
  }

  private inputOf(slug: string): StrataCellInput | null {
    return this.renderRoot.querySelector(`strata-cell-input[data-slug="${CSS.escape(slug)}"]`);
  }

  /**
   * Enter saves, also from a field inside another element. In multi-line texts, Ctrl+Enter saves.
   */
  private onKey(event: KeyboardEvent): void {
    const field = event.composedPath()[0];
    if (
      event.key !== "Enter" ||
      field instanceof HTMLButtonElement ||
      (field instanceof HTMLTextAreaElement && !event.ctrlKey && !event.metaKey)
    )
      return;
    event.preventDefault();
    this._form?.requestSubmit();
  }

  /** Returns the changed values in the form, or null if a field is invalid. */
  private read(table: Table): CellValues | null {
    const values: CellValues = {};
    const problems = new Map<string, string>();
    for (const column of table.columns) {
      const read = this.inputOf(column.slug)?.read();
      if (!read) continue;
      if ("problem" in read) problems.set(column.slug, read.problem);
      else if (!this._record || !sameValue(read.value, this._record.values[column.slug]))
        values[column.slug] = read.value;
    }
    this._fieldProblems = problems;
    this.focusProblem();
    return problems.size > 0 ? null : values;
  }

  /** Saves the form, and starts the drawing of lines or points. */
  private async draw(column: Column): Promise<void> {
    const { session, layer } = this;
    if ((await this.save(false)) && this._record)
      session.drawMarks(layer, this._record.key, column);
  }

  /** Returns true if everything was saved. */
  private async save(another: boolean): Promise<boolean> {
    const { table, session, _record: record } = this;
    if (!table || this._busy || this._shut) return false;
    this._problem = "";
    const values = this.read(table);
    if (!values) return false;
    this._busy = true;
    try {
      if (record && Object.keys(values).length > 0) {
        const changed = await changeRecord(session.api, table.id, record.key, {
          version: record.version,
          values,
        });
        session.tables.view?.rows.put(changed);
        this._record = { ...record, ...changed };
      } else if (!record) {
        const made = await createRecord(session.api, table.id, { values });
        this._record = made; // after a later refusal, the next attempt uses this record
        session.tables.view?.rows.refresh();
        session.tables.view?.show(made.key);
        this.made?.(made.key);
      }
      await this.sendFiles(table, this._record!.key);
      if (another) this._record = null;
      if (another) this.beginAgain();
      else this.dispatchEvent(new CustomEvent("closed"));
      return true;
    } catch (error) {
      await this.refuse(error, table);
      return false;
    } finally {
      this._busy = false;
    }
  }

  /** Sends one file at a time. A sent file is no longer pending, even if a later one fails. */
  private async sendFiles(table: Table, key: number): Promise<void> {
    const fields = table.columns
      .filter(holdsFiles)
      .flatMap((column) => this.inputOf(column.slug)?.files ?? []);
    const of = fields.reduce((sum, field) => sum + field.pending.length, 0);
    let n = 0;
    try {
      for (const field of fields) {
        for (const file of field.pending) {
          this._sending = texts.files.sending_one(file.name, ++n, of);
          await this.session.api.send("POST /tables/{table}/records/{key}/attachments", {
            path: { table: table.id, key },
            query: { name: file.name, column: field.column.slug },
            body: file,
          });
          field.sent(file);
        }
      }
    } finally {
      this._sending = "";
      if (n > 0) {
        this._record = await readRecord(
          this.session.api,
          { model: this.session.modelId, layer: this.layer.id },
          key,
        );
        this.session.tables.view?.rows.put(this._record);
      }
    }
  }

  private beginAgain(): void {
    const { table } = this;
    for (const column of table?.columns ?? [])
      this.inputOf(column.slug)?.put(column.default ?? null);
    if (table?.columns[0]) this.inputOf(table.columns[0].slug)?.focus();
  }

  private async refuse(error: unknown, table: Table): Promise<void> {
    if (!(error instanceof ApiError)) throw error;
    const slug = /^values\.(.+)$/.exec(error.problem.field ?? "")?.[1];
    if (error.status === 412 && this._record) await this.tellChanges(table, this._record);
    else if (slug && this.inputOf(slug)) this._fieldProblems = new Map([[slug, error.message]]);
    else this._problem = error.message;
    this.focusProblem();
  }

  /**
   * After a change by another user, shows the new values next to the fields. A second save
   * overwrites them.
   */
  private async tellChanges(table: Table, read: TableRecord): Promise<void> {
    const { api } = this.session;
    const newest = await lastEditOf(api, table.id, read.key);
    const now = await readRecord(api, { table: table.id }, read.key);
    const typed = new Map<string, TableRecord["values"][string]>();
    const told = new Map<string, string>();
    for (const column of table.columns) {
      const mine = this.inputOf(column.slug)?.read();
      const theirs = now.values[column.slug] ?? null;
      if (mine && "value" in mine) typed.set(column.slug, mine.value);
      if (sameValue(theirs, read.values[column.slug])) continue;
      const changedHere =
        mine && "value" in mine && !sameValue(mine.value, read.values[column.slug]);
      if (changedHere) told.set(column.slug, words.now_is(cellText(theirs) || words.no_value));
      else typed.set(column.slug, theirs);
    }
    this._record = { ...now, ...(read.area_m2 === undefined ? {} : { area_m2: read.area_m2 }) };
    this._fieldProblems = told;
    this._problem = words.changed_meanwhile(newest?.user || words.somebody);
    await this.updateComplete;
    for (const [slug, value] of typed) this.inputOf(slug)?.put(value);
  }

  private focusProblem(): void {
    const [slug] = this._fieldProblems.keys();
    if (slug !== undefined) this.inputOf(slug)?.focus();
  }
}
