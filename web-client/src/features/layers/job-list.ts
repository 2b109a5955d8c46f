// <strata-job-list>: the model's jobs that make layers or files, with progress and result. It is
// above every tab of the side panel.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatArea, formatBytes, shareText } from "../../domain/measure";
import type { TransferReport } from "../../core/types";
import { icon } from "../../ui/icons";
import { isBusy, stepOf, type LayerJob } from "../../session/layer-jobs";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

@customElement("strata-job-list")
export class StrataJobList extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "jobs");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
        padding: var(--space-3) var(--space-3) 0;
      }
      :host([hidden]) {
        display: none;
      }
      .job {
        display: grid;
        gap: var(--space-2);
        padding: var(--space-2) var(--space-2) var(--space-3) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        font-size: var(--text-small);
      }
      .job .head {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      .job .head b {
        flex: 1;
        min-width: 0;
      }
      .job.failed .said {
        color: var(--danger);
      }
      .job .bar {
        height: 5px;
        margin-right: var(--space-2);
        border-radius: var(--radius-tiny);
        overflow: hidden;
        background: var(--line);
      }
      .job .bar i {
        display: block;
        height: 100%;
        background: var(--accent);
      }
      .job table {
        border-collapse: collapse;
        margin-right: var(--space-2);
      }
      .job th {
        padding: 0 0 var(--space-1) var(--space-2);
        font-weight: normal;
        color: var(--ink-soft);
      }
      .job td {
        padding: var(--space-1) 0 var(--space-1) var(--space-2);
        border-top: var(--edge) solid var(--line);
        text-align: right;
        white-space: nowrap;
      }
      .job th:first-child,
      .job td:first-child {
        padding-left: 0;
        text-align: left;
        white-space: normal;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override updated(): void {
    this.hidden = this.session.jobs.entries.length === 0;
  }

  override render(): TemplateResult {
    const { session } = this;
    return html`${session.jobs.entries.map((entry) => jobRow(session, entry))}`;
  }
}

function jobRow(session: ModelSession, entry: LayerJob): TemplateResult {
  const words = texts.layer_jobs;
  const { job, problem, report } = entry;
  const busy = isBusy(entry);
  const percent = Math.round(job.progress * 100);
  return html`<div class="job ${problem ? "failed" : ""}">
    <div class="head">
      <b class="ellipsis" title=${entry.name}>${entry.name}</b>
      ${
        busy
          ? html`<button aria-label=${words.cancel(entry.name)} @click=${() => void cancel(session, entry)}>${texts.cancel}</button>`
          : html`${job.file && !problem ? html`<button @click=${() => void session.files.save(entry.key)}>${icon("import")}${texts.figures.save}</button>` : nothing}<button
            class="icon quiet"
            aria-label=${words.dismiss(entry.name)}
            @click=${() => session.jobs.dismiss(entry.key)}
          >
            ${icon("close")}
          </button>`
      }
    </div>
    ${
      busy
        ? html`<div
            class="bar"
            role="progressbar"
            aria-label=${entry.name}
            aria-valuemin="0"
            aria-valuemax="100"
            aria-valuenow=${percent}
          >
            <i ${styled({ width: `${percent}%` })}></i>
          </div>
          <span class="said hint">${stepOf(job, words.running)}</span>`
        : nothing
    }
    ${job.file && !problem ? html`<span class="said hint">${job.file.name}, <span>${formatBytes(job.file.bytes)}</span></span>` : nothing}
    ${problem ? html`<span class="said" role="alert">${[problem.title, problem.detail].filter(Boolean).join(". ")}</span>` : nothing}
    ${report ? reportTable(report) : nothing}
  </div>`;
}

function reportTable(report: TransferReport): TemplateResult {
  const words = texts.transfer;
  return html`<span class="hint">${words.matched(shareText(report.matched_m2, report.area_m2))}</span>
    <table>
      <tr>
        <th scope="col">${words.layer}</th>
        <th scope="col">${words.brought}</th>
        <th scope="col">${words.lost}</th>
      </tr>
      ${report.layers.map(
        (layer) =>
          html`<tr>
            <td>${layer.name ?? layer.layer}</td>
            <td>${formatArea(layer.transferred_m2)}</td>
            <td>${shareText(layer.lost_m2, layer.source_m2)}</td>
          </tr>`,
      )}
    </table>`;
}

async function cancel(session: ModelSession, entry: LayerJob): Promise<void> {
  await session.jobs.cancel(entry.key).catch((error: unknown) => notices.error(error));
}
