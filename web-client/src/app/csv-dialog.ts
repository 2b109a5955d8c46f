// <strata-csv-dialog>: records from a CSV file: first what it would do, line by line where something is wrong, then it is done.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../core/api";
import type { RecordsReport } from "../core/protocol.gen";
import "./dialog";
import type { StrataDialog } from "./dialog";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { shared_styles } from "./styles";
import { texts } from "./texts";

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
  @query("strata-dialog") private dialog_!: StrataDialog;

  static override styles = [
    shared_styles,
    css`
      .counts {
        display: flex;
        flex-wrap: wrap;
        gap: 6px 22px;
        margin: 0;
      }
      .counts div {
        display: flex;
        gap: 7px;
      }
      dt {
        color: var(--ink-soft);
      }
      dd {
        margin: 0;
        font-weight: 600;
      }
      .wrong {
        max-height: 320px;
        overflow: auto;
      }
      table {
        width: 100%;
        border-collapse: collapse;
        font-size: 0.88rem;
      }
      th {
        text-align: left;
        font-size: 0.8rem;
        color: var(--ink-soft);
      }
      th,
      td {
        padding: 4px 8px 4px 0;
        border-bottom: 1px solid var(--line);
        vertical-align: top;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.send(true);
  }

  override render(): TemplateResult {
    const report = this.report_;
    const useful = report !== null && report.problems.length === 0 && report.created + report.changed > 0;
    return html`<strata-dialog wide heading=${words.csv_title(this.file.name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${report ? this.report(report) : html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${words.csv_looking}</p>`}
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button slot="actions" @click=${() => this.dialog_.close()}>${texts.cancel}</button>
      <button slot="actions" class="primary" ?disabled=${this.busy_ || !useful} @click=${() => void this.send(false)}>${words.csv_import}</button>
    </strata-dialog>`;
  }

  private report(report: RecordsReport): TemplateResult {
    const counts: [string, number][] = [
      [words.csv_rows, report.rows],
      [words.csv_created, report.created],
      [words.csv_changed, report.changed],
      [words.csv_unchanged, report.unchanged],
    ];
    const problems = [...report.problems].sort((a, b) => a.line - b.line);
    return html`<dl class="counts numeric">${counts.map(([what, count]) => html`<div><dt>${what}</dt><dd>${count.toLocaleString("en-GB")}</dd></div>`)}</dl>
      ${problems.length === 0
        ? html`<p>${report.created + report.changed > 0 ? words.csv_good : words.csv_same}</p>`
        : html`<p class="error" role="alert">${words.csv_wrong(new Set(problems.map(({ line }) => line)).size)}</p>
            <div class="wrong">
              <table>
                <thead>
                  <tr>
                    <th>${words.csv_line}</th>
                    <th>${words.csv_column}</th>
                    <th>${words.csv_what}</th>
                  </tr>
                </thead>
                <tbody>
                  ${problems.map(
                    ({ line, column, detail }) =>
                      html`<tr>
                        <td class="numeric">${line}</td>
                        <td>${column ?? nothing}</td>
                        <td>${detail}</td>
                      </tr>`,
                  )}
                </tbody>
              </table>
            </div>`}`;
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
      if (error.problem.rows) this.report_ = error.problem.rows; // the table has changed since it was tried
      else this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
