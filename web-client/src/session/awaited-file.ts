// The job of a dialog that makes a file, and the dialog's footer with its progress and result.

import { css, html, nothing } from "lit";
import type { LitElement, ReactiveController, TemplateResult } from "lit";
import { ApiError } from "../net/api-error";
import type { JobFile } from "../core/protocol.gen";
import type { ProblemBody } from "../core/types";
import { styled } from "../ui/styled";
import { MovedFocus } from "../ui/moved-focus";
import { isBusy, stepOf, type LayerJob } from "./layer-jobs";
import type { ModelSession } from "./model-session";

/** The texts of the footer. `form` is the id of the form that the button submits. */
export interface FileFooter {
  form: string;
  make: string;
  making: string;
  cancel: string;
  /** Other buttons, before the button that makes the file. A running job has none. */
  actions?: TemplateResult;
  /** A text below the problem or the saved file. */
  status?: TemplateResult | null;
  saved(file: JobFile): string;
  /** A problem that belongs to no field, or an empty text. */
  problem: string;
}

export class AwaitedFile implements ReactiveController {
  private _sending = false;

  /** `refuse` shows the problem of a refused request or a failed job. */
  constructor(
    private readonly _host: LitElement & { session: ModelSession },
    private readonly _refuse: (problem: ProblemBody) => void,
  ) {
    _host.addController(this);
    new MovedFocus(_host, 'button[slot="actions"]');
  }

  private get job(): LayerJob | null {
    const { files, jobs } = this._host.session;
    return jobs.entries.find(({ key }) => key === files.awaited) ?? null;
  }

  /** The job while it is queued or running. */
  get running(): LayerJob | null {
    const { job } = this;
    return job && isBusy(job) ? job : null;
  }

  /** Whether the dialog can start another job. */
  get isFree(): boolean {
    return !this._sending && !this.running;
  }

  hostConnected(): void {
    this._host.session.files.saved = null;
  }

  hostDisconnected(): void {
    void this._host.session.files.leave();
  }

  hostUpdate(): void {
    const { files, jobs } = this._host.session;
    const { job } = this;
    if (!job?.problem) return;
    files.awaited = null;
    jobs.dismiss(job.key);
    this._refuse(job.problem);
  }

  /** Runs a function that starts the job. `isOpen` returns whether the dialog is still open. */
  async make(start: () => Promise<unknown>, isOpen: () => boolean): Promise<void> {
    this._sending = true;
    this._host.requestUpdate();
    try {
      await start();
      if (!isOpen()) void this._host.session.files.leave();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._refuse(error.problem);
    } finally {
      this._sending = false;
      this._host.requestUpdate();
    }
  }

  private async cancel({ key }: LayerJob): Promise<void> {
    try {
      await this._host.session.jobs.cancel(key);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._refuse(error.problem);
    }
  }

  /** Renders the content of a dialog's footer. */
  footer(footer: FileFooter): TemplateResult {
    const { form, make, making, cancel, saved, problem, actions = nothing, status } = footer;
    const { running, isFree } = this;
    const { saved: file } = this._host.session.files;
    const told = running ? "making" : problem || file || status ? "told" : "told nothing";
    // The status is always in the page, because screen readers announce only its changes.
    return html`<div slot="told" class=${told}>
        ${running ? this.progress(running, making) : nothing}
        ${problem && !running ? html`<span class="error" role="alert">${problem}</span>` : nothing}
        <span class="hint" role="status">${running ? nothing : html`${problem || !file ? nothing : saved(file)} ${status}`}</span>
      </div>
      ${running ? html`<button slot="actions" @click=${() => void this.cancel(running)}>${cancel}</button>` : actions}
      <button slot="actions" class="primary" form=${form} ?disabled=${!isFree}>${make}</button>`;
  }

  private progress({ job }: LayerJob, making: string): TemplateResult {
    const percent = Math.round(job.progress * 100);
    return html`<div class="bar" role="progressbar" aria-label=${making} aria-valuemin="0" aria-valuemax="100" aria-valuenow=${percent}>
        <i ${styled({ width: `${percent}%` })}></i>
      </div>
      <span class="hint">${stepOf(job, making)}</span>`;
  }
}

export const awaitedFileStyles = css`
  .making,
  .told {
    flex: 1 1 15rem;
    align-self: center;
    display: grid;
    gap: var(--space-1);
    min-width: 0;
    overflow-wrap: anywhere;
  }
  .told.nothing {
    flex-basis: 0; /* keeps the buttons in a single row */
  }
  .bar {
    height: 0.375rem;
    border-radius: var(--radius-tiny);
    overflow: hidden;
    background: var(--line);
  }
  .bar i {
    display: block;
    height: 100%;
    background: var(--accent);
  }
  @media (max-width: 560px) {
    .making,
    .told:not(.nothing) {
      flex-basis: 100%; /* above the buttons, which stay in a single row */
    }
  }
`;
