// <strata-terms-dialog>: a list of terms from a CSV or SKOS file, or more terms for one: first what
// the file would do, then it is done.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, name_of_file } from "../../net/api";
import { label_of } from "../../domain/cells";
import type { RecordsReport, Table } from "../../core/protocol.gen";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import "../../ui/file-choice";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { is_useful, records_report, report_styles } from "./records-report";
import { shared_styles } from "../../ui/styles";
import { kTermsEndings, terms_type } from "./terms-files";
import { texts } from "../../texts";

const words = texts.terms_dialog;

const kMostOfU16 = 30_000; // terms of a new layer's list: there is room for as many again

@customElement("strata-terms-dialog")
export class StrataTermsDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Id; null: a new list is made. */
  @property({ attribute: false }) table: number | null = null;
  /** The one that is looked at first, where there is one. */
  @property({ attribute: false }) file: File | null = null;
  @state() private file_: File | null = null;
  @state() private name_ = "";
  @state() private with_layer_ = true;
  @state() private report_: RecordsReport | null = null;
  @state() private problem_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  private named_ = false; // by the person, and not after the file
  private asked_ = 0;

  static override styles = [shared_styles, report_styles];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.file) this.take(this.file);
  }

  override render(): TemplateResult {
    const { report_: report, file_: file } = this;
    const list = this.table === null ? null : this.session.tables.find(this.table);
    const ready = report !== null && is_useful(report) && !this.busy_;
    return html`<strata-dialog wide heading=${list ? words.more_title(label_of(list)) : words.title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${list ? words.more_lead : words.lead}</p>
      <strata-file-choice
        label=${words.file}
        accept=${kTermsEndings}
        ?disabled=${this.busy_}
        .names=${file ? [file.name] : []}
        @files=${(event: CustomEvent<File[]>) => this.take(event.detail[0]!)}
      ></strata-file-choice>
      ${list || !file ? nothing : this.new_list()}
      ${report ? records_report(report, words.rows) : html`<p class="hint" role="status" ?hidden=${!file || this.problem_ !== ""}>${words.looking}</p>`}
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button slot="actions" class="primary" ?disabled=${!ready} @click=${() => void this.send()}>${words.import}</button>
    </strata-dialog>`;
  }

  private new_list(): TemplateResult {
    return html`<label class="field">
        <span>${words.name}</span>
        <input type="text" maxlength="200" autocomplete="off" ?disabled=${this.busy_} .value=${this.name_} @change=${this.on_name} />
      </label>
      <label class="check">
        <input
          type="checkbox"
          .checked=${this.with_layer_}
          ?disabled=${this.busy_}
          @change=${(event: Event) => (this.with_layer_ = (event.target as HTMLInputElement).checked)}
        />
        ${words.with_layer}
      </label>`;
  }

  private on_name(event: Event): void {
    this.name_ = (event.target as HTMLInputElement).value.trim();
    this.named_ = this.name_ !== "";
    if (this.file_) void this.look(this.file_);
  }

  private take(file: File): void {
    this.file_ = file;
    if (!this.named_) this.name_ = name_of_file(file.name);
    void this.look(file);
  }

  private get into(): { project: number | string; name: string } | { table: number } {
    return this.table === null
      ? { project: this.session.model?.project ?? 0, name: this.name_ }
      : { table: this.table };
  }

  /** What it would do. The newest question counts. */
  private async look(file: File): Promise<void> {
    const asked = ++this.asked_;
    const type = terms_type(file.name);
    this.report_ = null;
    this.problem_ =
      type === null
        ? words.unknown(file.name)
        : this.table === null && this.name_ === ""
          ? words.name_missing
          : "";
    if (type === null || this.problem_ !== "") return;
    try {
      const report = await this.session.api.import_terms(this.into, file, type, true);
      if (asked === this.asked_) this.report_ = report;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked === this.asked_) this.refuse(error);
    }
  }

  private async send(): Promise<void> {
    const { file_: file, session } = this;
    const type = terms_type(file?.name ?? "");
    if (!file || type === null) return;
    this.busy_ = true;
    this.problem_ = "";
    try {
      const report = await session.api.import_terms(this.into, file, type, false);
      if (this.table !== null) await session.tables.reload(this.table);
      notices.show("success", words.done(report.created, report.changed));
      if (this.table === null && this.with_layer_ && report.table)
        await this.make_layer(report.table, report.created);
      this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error);
    } finally {
      this.busy_ = false;
    }
  }

  /**
   * Where that is refused the list is there all the same: it is told as what it is, and not as a
   * failed import.
   */
  private async make_layer({ id, name }: Table, terms: number): Promise<void> {
    const { session } = this;
    try {
      const type = terms > kMostOfU16 ? "u32" : "u16";
      session.add_created(
        await session.api.create_layer(session.model_id, {
          name,
          kind: "database",
          type,
          table: id,
        }),
      );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.show("problem", words.no_layer(name), error.message);
    }
  }

  /** The list may have changed since the file was tried. */
  private refuse(error: ApiError): void {
    if (error.problem.rows) this.report_ = error.problem.rows;
    else this.problem_ = error.message;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-terms-dialog": StrataTermsDialog;
  }
}
