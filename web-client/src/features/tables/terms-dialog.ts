// <strata-terms-dialog>: imports a term list, or adds terms to one, from a CSV or SKOS file. It
// previews the changes before the import.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { nameOfFile } from "../../domain/file-names";
import { createLayer } from "../../net/layers";
import { labelOf } from "../../domain/cells";
import type { RecordsReport, Table } from "../../core/protocol.gen";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import "../../ui/file-choice";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { isUseful, recordsReport, reportStyles } from "./records-report";
import { sharedStyles } from "../../ui/styles";
import { kTermsEndings, termsType, type TermsType } from "./terms-files";
import { texts } from "../../texts";

const words = texts.terms_dialog;

const kMostOfU16 = 30_000; // up to this number of terms, u16 keys suffice even if it doubles

@customElement("strata-terms-dialog")
export class StrataTermsDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The list's id; null creates a new list. */
  @property({ attribute: false }) table: number | null = null;
  /** The file to preview first; null for none. */
  @property({ attribute: false }) file: File | null = null;
  @state() private _file: File | null = null;
  @state() private _name = "";
  @state() private _withLayer = true;
  @state() private _report: RecordsReport | null = null;
  @state() private _problem = "";
  @state() private _busy = false;
  @query("strata-dialog") private _dialog!: StrataDialog;
  private _named = false; // whether the user typed the name; otherwise the file provides it
  private _asked = 0;

  static override styles = [sharedStyles, reportStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.file) this.take(this.file);
  }

  override render(): TemplateResult {
    const { _report: report, _file: file } = this;
    const list = this.table === null ? null : this.session.tables.find(this.table);
    const ready = report !== null && isUseful(report) && !this._busy;
    return html`<strata-dialog wide heading=${list ? words.more_title(labelOf(list)) : words.title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${list ? words.more_lead : words.lead}</p>
      <strata-file-choice
        label=${words.file}
        accept=${kTermsEndings}
        ?disabled=${this._busy}
        .names=${file ? [file.name] : []}
        @files=${(event: CustomEvent<File[]>) => this.take(event.detail[0]!)}
      ></strata-file-choice>
      ${list || !file ? nothing : this.newList()}
      ${report ? recordsReport(report, words.rows) : html`<p class="hint" role="status" ?hidden=${!file || this._problem !== ""}>${words.looking}</p>`}
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <button slot="actions" class="primary" ?disabled=${!ready} @click=${() => void this.send()}>${words.import}</button>
    </strata-dialog>`;
  }

  private newList(): TemplateResult {
    return html`<label class="field">
        <span>${words.name}</span>
        <input type="text" maxlength="200" autocomplete="off" ?disabled=${this._busy} .value=${this._name} @change=${this.onName} />
      </label>
      <label class="check">
        <input
          type="checkbox"
          .checked=${this._withLayer}
          ?disabled=${this._busy}
          @change=${(event: Event) => (this._withLayer = (event.target as HTMLInputElement).checked)}
        />
        ${words.with_layer}
      </label>`;
  }

  private onName(event: Event): void {
    this._name = (event.target as HTMLInputElement).value.trim();
    this._named = this._name !== "";
    if (this._file) void this.look(this._file);
  }

  private take(file: File): void {
    this._file = file;
    if (!this._named) this._name = nameOfFile(file.name);
    void this.look(file);
  }

  /**
   * Creates a new list in the project, or adds to an existing list. `dryRun` only reports the
   * changes. If a term is invalid, nothing is written.
   */
  private import(body: File, type: TermsType, dryRun: boolean): Promise<RecordsReport> {
    const { api, model } = this.session;
    const query = dryRun ? { dry_run: true } : {};
    return this.table === null
      ? api.json("POST /projects/{project}/terms", {
          path: { project: model?.project ?? 0 },
          query: { name: this._name, ...query },
          body,
          type,
        })
      : api.json("POST /tables/{table}/terms", { path: { table: this.table }, query, body, type });
  }

  /** Previews the changes. Ignores a response if a later request was sent. */
  private async look(file: File): Promise<void> {
    const asked = ++this._asked;
    const type = termsType(file.name);
    this._report = null;
    this._problem =
      type === null
        ? words.unknown(file.name)
        : this.table === null && this._name === ""
          ? words.name_missing
          : "";
    if (type === null || this._problem !== "") return;
    try {
      const report = await this.import(file, type, true);
      if (asked === this._asked) this._report = report;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked === this._asked) this.refuse(error);
    }
  }

  private async send(): Promise<void> {
    const { _file: file, session } = this;
    const type = termsType(file?.name ?? "");
    if (!file || type === null) return;
    this._busy = true;
    this._problem = "";
    try {
      const report = await this.import(file, type, false);
      if (this.table !== null) await session.tables.reload(this.table);
      notices.show("success", words.done(report.created, report.changed));
      if (this.table === null && this._withLayer && report.table)
        await this.makeLayer(report.table, report.created);
      this._dialog.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error);
    } finally {
      this._busy = false;
    }
  }

  /**
   * Creates a layer for the list. The list exists even if the server refuses the layer, so the
   * message does not report a failed import.
   */
  private async makeLayer({ id, name }: Table, terms: number): Promise<void> {
    const { session } = this;
    try {
      const type = terms > kMostOfU16 ? "u32" : "u16";
      session.addCreated(
        await createLayer(session.api, session.modelId, {
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

  /** Shows the refusal. The list may have changed since the preview. */
  private refuse(error: ApiError): void {
    if (error.problem.rows) this._report = error.problem.rows;
    else this._problem = error.message;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-terms-dialog": StrataTermsDialog;
  }
}
