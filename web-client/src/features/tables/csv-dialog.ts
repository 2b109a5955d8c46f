// <strata-csv-dialog>: imports records from a CSV file. It previews the changes and lists problems
// by line before the import.

import { html, LitElement, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { RecordsReport } from "../../core/protocol.gen";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { isUseful, recordsReport, reportStyles } from "./records-report";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tables;

@customElement("strata-csv-dialog")
export class StrataCsvDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The table's id. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) file!: File;
  @state() private _report: RecordsReport | null = null;
  @state() private _problem = "";
  @state() private _busy = false;

  static override styles = [sharedStyles, reportStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.send(true);
  }

  override render(): TemplateResult {
    const report = this._report;
    return html`<strata-dialog wide heading=${words.csv_title(this.file.name)} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${report ? recordsReport(report, words.csv_rows) : html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${words.csv_looking}</p>`}
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <button slot="actions" class="primary" ?disabled=${this._busy || !report || !isUseful(report)} @click=${() => void this.send(false)}>${words.csv_import}</button>
    </strata-dialog>`;
  }

  private async send(dryRun: boolean): Promise<void> {
    this._busy = true;
    this._problem = "";
    try {
      const report = (await this.session.api.json("POST /tables/{table}/records", {
        path: { table: this.table },
        query: dryRun ? { dry_run: true } : {},
        body: this.file,
        type: "text/csv",
      })) as RecordsReport;
      this._report = report;
      if (dryRun) return;
      this.session.tables.view?.rows.refresh();
      notices.show("success", words.csv_done(report.created, report.changed));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // the table has changed since the preview
      if (error.problem.rows) this._report = error.problem.rows;
      else this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}
