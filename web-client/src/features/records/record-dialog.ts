// <strata-record-dialog>: a record as a form that is made from its table: a new one, or one that is
// there.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { cell_text, holds_files, label_of, same_value } from "../../domain/cells";
import { format_area } from "../../domain/measure";
import { css_color, record_color } from "../../domain/palette";
import type { CellValues, Column, Table, TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import "../../session/fields/cell-input";
import "../../ui/copy-field";
import type { StrataCellInput } from "../../session/fields/cell-input";
import { ask } from "../../ui/dialog";
import { follow_session } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import type { RecordClaim } from "../../session/record-editors";
import { form_styles, shared_styles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const words = texts.tables;

@customElement("strata-record-dialog")
export class StrataRecordDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  /** Null: a new record. */
  @property({ attribute: false }) key: number | null = null;
  @state() private record_: TableRecord | null = null; // as it was read
  @state() private problem_ = "";
  @state() private sending_ = "";
  @state() private field_problems_ = new Map<string, string>(); // by slug
  @state() private busy_ = false;
  @state() private written_ = ""; // what was in the form when somebody took the record over
  private claim_: RecordClaim | null = null;
  private shut_ = false; // somebody else has the record, as far as was drawn
  @query("form") private form_!: HTMLFormElement | null;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    form_styles,
    css`
      .facts {
        display: flex;
        align-items: center;
        gap: 0.625rem;
      }
      .other {
        display: grid;
        grid-template-columns: auto 1fr auto;
        align-items: center;
        gap: 0.5rem 0.625rem;
        padding: 0.625rem 0.75rem;
        border: var(--edge) solid var(--calm);
        border-radius: var(--radius-small);
        background: var(--calm-soft);
        font-size: 0.9rem;
      }
      .other strata-copy-field {
        grid-column: 1 / -1;
      }
      .field-row {
        display: grid;
        gap: 4px;
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
      this.claim_ = this.session.editors.claim(this.layer.table, this.key);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.claim_?.release();
    this.claim_ = null;
  }

  /**
   * What is in the form is kept when somebody takes the record over. Whoever waited for it begins
   * with what was saved meanwhile.
   */
  override willUpdate(): void {
    const shut = this.claim_ !== null && this.claim_.other !== null;
    if (shut === this.shut_) return;
    this.shut_ = shut;
    const { table } = this;
    if (shut && this.claim_!.lost && table) this.written_ = this.in_words(table);
    else if (!shut && this.written_ === "" && this.key !== null) void this.load(this.key);
  }

  private get table(): Table | null {
    return this.layer.table === undefined ? null : this.session.tables.find(this.layer.table);
  }

  private async load(key: number): Promise<void> {
    try {
      const record = await this.session.api.record(
        { model: this.session.model_id, layer: this.layer.id },
        key,
      );
      const again = this.record_ !== null;
      this.record_ = record;
      if (!again) return;
      await this.updateComplete;
      for (const { slug } of this.table?.columns ?? [])
        this.input_of(slug)?.put(record.values[slug] ?? null);
    } catch (error) {
      this.problem_ = error instanceof ApiError ? error.message : texts.problems.unexpected;
    }
  }

  override render(): TemplateResult {
    const { table, record_: record, key } = this;
    const ready = table !== null && (key === null || record !== null);
    const name =
      table && record ? this.session.tables.title(table, record) || words.record(record.key) : "";
    return html`<strata-dialog
      heading=${key === null ? words.new_record_of(table ? label_of(table) : "") : name}
      way_out=${texts.cancel}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${this.claim_?.other ? this.held(this.claim_, name) : nothing} ${record ? this.facts(record) : nothing}
      ${ready ? this.form(table) : html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${texts.loading}</p>`}
      <p class="hint" role="status" ?hidden=${!this.sending_}>${this.sending_}</p>
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      ${
        key === null
          ? html`<button slot="actions" ?disabled=${this.busy_ || !ready} @click=${() => void this.save(true)}>${words.save_next}</button>`
          : nothing
      }
      <button slot="actions" class="primary" ?disabled=${this.busy_ || !ready || this.shut_} @click=${() => this.form_?.requestSubmit()}>${texts.save}</button>
    </strata-dialog>`;
  }

  private held(claim: RecordClaim, name: string): TemplateResult {
    const { user, is_me } = claim.other!;
    const kept = claim.lost && this.written_ !== "";
    const told = kept
      ? is_me
        ? words.taken_elsewhere
        : words.taken_over(user)
      : is_me
        ? words.edited_elsewhere
        : words.edited_by(user);
    const take_over = async (): Promise<void> => {
      const lead = is_me ? words.take_over_own : words.take_over_lead(user);
      if (await ask({ heading: words.take_over_title(name), lead, yes: words.take_over }))
        claim.take_over();
    };
    return html`<div class="other" role="alert">
      ${icon("edit")}<span>${told}</span><button @click=${() => void take_over()}>${words.take_over}</button>
      ${kept ? html`<strata-copy-field .label=${words.written} .text=${this.written_}></strata-copy-field>` : nothing}
    </div>`;
  }

  private facts(record: TableRecord): TemplateResult {
    const color = record_color(this.session.layers.palette(this.layer), record);
    return html`<div class="facts hint numeric">
      ${color ? html`<span class="swatch" ${styled({ background: css_color(color) })}></span>` : nothing}
      <span>${words.key_is(record.key)}</span>
      <span>${record.area_m2 ? words.area_on(format_area(record.area_m2), label_of(this.layer)) : words.not_painted_on(label_of(this.layer))}</span>
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
      @keydown=${this.on_key}
    >
      ${table.columns.length === 0 ? html`<p class="hint">${words.no_columns}</p>` : nothing}
      ${table.columns.map((column) => this.field(column))}
    </form>`;
  }

  private field(column: Column): TemplateResult {
    const problem = this.field_problems_.get(column.slug) ?? "";
    const value = this.record_
      ? (this.record_.values[column.slug] ?? null)
      : (column.default ?? null);
    return html`<div class="field-row">
      <span class="caption" @click=${() => this.input_of(column.slug)?.focus()}
        >${label_of(column)}${column.required ? html` <b title=${words.required}>*</b>` : nothing}</span
      >
      <strata-cell-input
        data-slug=${column.slug}
        .session=${this.session}
        .column=${column}
        .value=${value}
        .record=${{ table: this.layer.table ?? 0, key: this.record_?.key ?? null }}
        .invalid=${problem !== ""}
        .fixed=${this.shut_}
      ></strata-cell-input>
      ${column.comment ? html`<span class="hint">${column.comment}</span>` : nothing}
      ${problem ? html`<span class="error" role="alert">${problem}</span>` : nothing}
    </div>`;
  }

  /** What differs from the record, a line a column. */
  private in_words(table: Table): string {
    const lines: string[] = [];
    for (const column of table.columns) {
      const read = this.input_of(column.slug)?.read();
      if (!read || !("value" in read) || same_value(read.value, this.record_?.values[column.slug]))
        continue;
      lines.push(`${label_of(column)}: ${cell_text(read.value)}`);
    }
    return lines.join("\n");
  }

  private input_of(slug: string): StrataCellInput | null {
    return this.renderRoot.querySelector(`strata-cell-input[data-slug="${CSS.escape(slug)}"]`);
  }

  /**
   * Enter saves, also from a field in an element of its own; in texts of several lines with Ctrl.
   */
  private on_key(event: KeyboardEvent): void {
    const field = event.composedPath()[0];
    if (
      event.key !== "Enter" ||
      field instanceof HTMLButtonElement ||
      (field instanceof HTMLTextAreaElement && !event.ctrlKey && !event.metaKey)
    )
      return;
    event.preventDefault();
    this.form_?.requestSubmit();
  }

  /** What is in the form, without what is as it was; null: something is no value. */
  private read(table: Table): CellValues | null {
    const values: CellValues = {};
    const problems = new Map<string, string>();
    for (const column of table.columns) {
      const read = this.input_of(column.slug)?.read();
      if (!read) continue;
      if ("problem" in read) problems.set(column.slug, read.problem);
      else if (!this.record_ || !same_value(read.value, this.record_.values[column.slug]))
        values[column.slug] = read.value;
    }
    this.field_problems_ = problems;
    this.focus_problem();
    return problems.size > 0 ? null : values;
  }

  /** What is in the form is kept; lines and points are drawn without it. */
  private async draw(column: Column): Promise<void> {
    const { session, layer } = this;
    if ((await this.save(false)) && this.record_)
      session.draw_marks(layer, this.record_.key, column);
  }

  /** True: all of it is saved. */
  private async save(another: boolean): Promise<boolean> {
    const { table, session, record_: record } = this;
    if (!table || this.busy_ || this.shut_) return false;
    this.problem_ = "";
    const values = this.read(table);
    if (!values) return false;
    this.busy_ = true;
    try {
      if (record && Object.keys(values).length > 0) {
        const changed = await session.api.change_record(table.id, record.key, {
          version: record.version,
          values,
        });
        session.tables.view?.rows.put(changed);
        this.record_ = { ...record, ...changed };
      } else if (!record) {
        const made = await session.api.create_record(table.id, { values });
        this.record_ = made; // what is refused from here on is tried again for this record
        session.tables.view?.rows.refresh();
        session.tables.view?.show(made.key);
      }
      await this.send_files(table, this.record_!.key);
      if (another) this.record_ = null;
      if (another) this.begin_again();
      else this.dispatchEvent(new CustomEvent("closed"));
      return true;
    } catch (error) {
      await this.refuse(error, table);
      return false;
    } finally {
      this.busy_ = false;
    }
  }

  /** One after the other; what was sent does not wait any more, whatever becomes of the next. */
  private async send_files(table: Table, key: number): Promise<void> {
    const fields = table.columns
      .filter(holds_files)
      .flatMap((column) => this.input_of(column.slug)?.files ?? []);
    const of = fields.reduce((sum, field) => sum + field.pending.length, 0);
    let n = 0;
    try {
      for (const field of fields) {
        for (const file of field.pending) {
          this.sending_ = texts.files.sending_one(file.name, ++n, of);
          await this.session.api.attach(table.id, key, field.column.slug, file);
          field.sent(file);
        }
      }
    } finally {
      this.sending_ = "";
      if (n > 0) {
        this.record_ = await this.session.api.record(
          { model: this.session.model_id, layer: this.layer.id },
          key,
        );
        this.session.tables.view?.rows.put(this.record_);
      }
    }
  }

  private begin_again(): void {
    const { table } = this;
    for (const column of table?.columns ?? [])
      this.input_of(column.slug)?.put(column.default ?? null);
    if (table?.columns[0]) this.input_of(table.columns[0].slug)?.focus();
  }

  private async refuse(error: unknown, table: Table): Promise<void> {
    if (!(error instanceof ApiError)) throw error;
    const slug = /^values\.(.+)$/.exec(error.problem.field ?? "")?.[1];
    if (error.status === 412 && this.record_) await this.tell_changes(table, this.record_);
    else if (slug && this.input_of(slug)) this.field_problems_ = new Map([[slug, error.message]]);
    else this.problem_ = error.message;
    this.focus_problem();
  }

  /**
   * Somebody else changed the record: their values stand beside the fields, and saving again
   * decides.
   */
  private async tell_changes(table: Table, read: TableRecord): Promise<void> {
    const { api } = this.session;
    const [newest] = await api.record_edits(table.id, read.key, 1);
    const now = await api.record({ table: table.id }, read.key);
    const typed = new Map<string, TableRecord["values"][string]>();
    const told = new Map<string, string>();
    for (const column of table.columns) {
      const mine = this.input_of(column.slug)?.read();
      const theirs = now.values[column.slug] ?? null;
      if (mine && "value" in mine) typed.set(column.slug, mine.value);
      if (same_value(theirs, read.values[column.slug])) continue;
      const changed_here =
        mine && "value" in mine && !same_value(mine.value, read.values[column.slug]);
      if (changed_here) told.set(column.slug, words.now_is(cell_text(theirs) || words.no_value));
      else typed.set(column.slug, theirs);
    }
    this.record_ = { ...now, ...(read.area_m2 === undefined ? {} : { area_m2: read.area_m2 }) };
    this.field_problems_ = told;
    this.problem_ = words.changed_meanwhile(newest?.user || words.somebody);
    await this.updateComplete;
    for (const [slug, value] of typed) this.input_of(slug)?.put(value);
  }

  private focus_problem(): void {
    const [slug] = this.field_problems_.keys();
    if (slug !== undefined) this.input_of(slug)?.focus();
  }
}
