// The report of an import, before or after it, with the number of new rows and the problems by
// line.

import { css, html, nothing, type TemplateResult } from "lit";
import { formatCount } from "../../core/locale";
import type { RecordsReport } from "../../core/protocol.gen";
import { texts } from "../../texts";

const words = texts.reports;

export const reportStyles = css`
  .counts {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-2) var(--space-6);
    margin: 0;
  }
  .counts div {
    display: flex;
    gap: var(--space-2);
  }
  .counts dt {
    color: var(--ink-soft);
  }
  .counts dd {
    margin: 0;
    font-weight: 600;
  }
  .wrong {
    max-height: 320px;
    overflow: auto;
  }
  .wrong table {
    width: 100%;
    border-collapse: collapse;
    font-size: var(--text-small);
  }
  .wrong th {
    text-align: left;
    font-size: var(--text-tiny);
    color: var(--ink-soft);
  }
  .wrong th,
  .wrong td {
    padding: var(--space-1) var(--space-2) var(--space-1) 0;
    border-bottom: var(--edge) solid var(--line);
    vertical-align: top;
  }
`;

/** Returns whether the import is possible and changes the table. */
export const isUseful = (report: RecordsReport): boolean =>
  report.problems.length === 0 && report.created + report.changed > 0;

/** `rows` is the label for the number of rows in the file, such as “Rows” or “Terms”. */
export function recordsReport(report: RecordsReport, rows: string): TemplateResult {
  const counts: [string, number][] = [
    [rows, report.rows],
    [words.created, report.created],
    [words.changed, report.changed],
    [words.unchanged, report.unchanged],
  ];
  const leftOut = report.left_out ?? 0;
  return html`<dl class="counts">${counts.map(([what, count]) => html`<div><dt>${what}</dt><dd>${formatCount(count)}</dd></div>`)}</dl>
    ${leftOut > 0 ? html`<p class="hint">${words.left_out(leftOut)}</p>` : nothing}
    ${report.problems.length === 0 ? html`<p>${report.created + report.changed > 0 ? words.good : words.same}</p>` : whatIsWrong(report)}`;
}

/**
 * Renders the list of problems, by line. In files without lines, problems are listed by the term's
 * code.
 */
function whatIsWrong({ problems }: RecordsReport): TemplateResult {
  const sorted = [...problems].sort((a, b) => a.line - b.line);
  const hasLines = sorted.some(({ line }) => line > 0);
  const hasCodes = sorted.some(({ code }) => code);
  const hasColumns = sorted.some(({ column }) => column);
  const cell = (shown: boolean, content: unknown, style = ""): TemplateResult | typeof nothing =>
    shown ? html`<td class=${style}>${content}</td>` : nothing;
  const head = (shown: boolean, content: string): TemplateResult | typeof nothing =>
    shown ? html`<th scope="col">${content}</th>` : nothing;
  return html`<p class="error" role="alert">${words.wrong(new Set(problems.map(({ line, code = "" }) => `${line} ${code}`)).size)}</p>
    <div class="wrong">
      <table>
        <thead>
          <tr>
            ${head(hasLines, words.line)} ${head(hasCodes, words.term)} ${head(hasColumns, words.column)} ${head(true, words.what)}
          </tr>
        </thead>
        <tbody>
          ${sorted.map(
            ({ line, code, column, detail }) =>
              html`<tr>
                ${cell(hasLines, line || nothing)} ${cell(hasCodes, code)} ${cell(hasColumns, column)} ${cell(true, detail)}
              </tr>`,
          )}
        </tbody>
      </table>
    </div>`;
}
