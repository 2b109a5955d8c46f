// <strata-csv-dialog>: records from a CSV file: first what it would do, line by line where
// something is wrong, then it is done.

import { html, LitElement, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import type { RecordsReport } from "../../core/protocol.gen";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { is_useful, records_report, report_styles } from "./records-report";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tables;

@customElement("strata-csv-dialog")
export class StrataCsvDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Id. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) file!: File;
  @state() private report_: RecordsReport | null = null;
  @state() private problem_ = "";
  @state() private busy_ = false;

  static override styles = [shared_styles, report_styles];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.send(true);
  }

  override render(): TemplateResult {
    const report = this.report_;
    return html`<strata-dialog wide heading=${words.csv_title(this.file.name)} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${report ? records_report(report, words.csv_rows) : html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${words.csv_looking}</p>`}
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button slot="actions" class="primary" ?disabled=${this.busy_ || !report || !is_useful(report)} @click=${() => void this.send(false)}>${words.csv_import}</button>
    </strata-dialog>`;
  }

  private async send(dry_run: boolean): Promise<void> {
    this.busy_ = true;
    this.problem_ = "";
    try {
      const report = await this.session.api.import_records(this.table, this.file, dry_run);
      this.report_ = report;
      if (dry_run) return;
      this.session.tables.view?.rows.refresh();
      notices.show("success", words.csv_done(report.created, report.changed));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // the table has changed since it was tried
      if (error.problem.rows) this.report_ = error.problem.rows;
      else this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
