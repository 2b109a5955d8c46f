// A job of a dialog on the regions of a layer: a preview or a change.

import {
  html,
  nothing,
  type ReactiveController,
  type ReactiveControllerHost,
  type TemplateResult,
} from "lit";
import type { CleanupReport } from "../../core/protocol.gen";
import type { Job } from "../../core/types";
import { formatArea } from "../../domain/measure";
import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { followJob } from "../../net/follow-job";
import { stepOf } from "../../session/layer-jobs";
import { texts } from "../../texts";
import { MovedFocus } from "../../ui/moved-focus";
import { styled } from "../../ui/styled";

export interface RegionJobHost extends ReactiveControllerHost {
  readonly session: { api: Api };
  readonly shadowRoot: ShadowRoot | null;
}

/** The id of the message about a wrong field. */
export const kProblem = "problem";

const kStarts = '[slot="actions"]';

export class RegionJob implements ReactiveController {
  /** The running job. */
  job: Job | null = null;
  report: CleanupReport | null = null;
  problem = "";
  /** The member of the request that the problem is about. */
  field = "";
  private _starting = false;
  private _cancelled = false;
  /** Counts the changes of the input. */
  private _input = 0;

  constructor(private readonly _host: RegionJobHost) {
    _host.addController(this);
    new MovedFocus(_host, `.stop, ${kStarts}`);
  }

  /** A closed dialog changes nothing. */
  hostDisconnected(): void {
    void this.cancel();
  }

  get isBusy(): boolean {
    return this._starting || this.job !== null;
  }

  refuse(problem: string, field: string): void {
    this._input++;
    [this.report, this.problem, this.field] = [null, problem, field];
    this._host.requestUpdate();
  }

  /** Forgets the result, because the input has changed. */
  reset(): void {
    this.refuse("", "");
  }

  /**
   * Starts a job and follows it. Returns its report, or null if it failed or was canceled. If the
   * input changes during a preview, the dialog does not show its result.
   */
  async run(start: () => Promise<Job>, apply: boolean): Promise<CleanupReport | null> {
    if (this.isBusy) return null;
    this._starting = true;
    this._cancelled = false;
    this.reset();
    const input = this._input;
    const isShown = (): boolean => apply || input === this._input;
    let report: CleanupReport | null = null;
    try {
      const last = await followJob(this._host.session.api, await start(), (job) => {
        const isNew = this.job === null;
        this.job = job;
        this._host.requestUpdate();
        if (isNew && this._cancelled) void this.cancel();
      });
      if (last.problem && last.state === "failed" && isShown()) this.tell(last.problem);
      report = last.cleanup ?? null;
      if (isShown()) this.report = report;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (isShown()) this.tell(error.problem);
    } finally {
      this._starting = false;
      this.job = null;
      this._host.requestUpdate();
    }
    return report;
  }

  /** Cancels the job, also if its start is not confirmed yet. */
  async cancel(): Promise<void> {
    this._cancelled = true;
    if (!this.job) return;
    try {
      await this._host.session.api.send("DELETE /jobs/{job}", { path: { job: this.job.id } });
    } catch (error) {
      // 409: the job has just ended
      if (!(error instanceof ApiError)) throw error;
      if (error.status !== 409) this.tell(error.problem);
    }
  }

  private tell({ title, detail, field }: { title: string; detail?: string; field?: string }): void {
    this.problem = detail ?? title;
    this.field = field ?? "";
  }

  /** Renders the progress or the result. `unit` counts regions or records. */
  render(unit: (n: number) => string): TemplateResult {
    const words = texts.regions;
    const { job, report, problem } = this;
    const percent = Math.round((job?.progress ?? 0) * 100);
    return html`${
      this.isBusy
        ? html`<div class="progress" role="progressbar" aria-label=${words.progress} aria-valuemin="0" aria-valuemax="100" aria-valuenow=${percent}>
              <i ${styled({ width: `${percent}%` })}></i>
            </div>
            <span class="hint">${job ? stepOf(job) : ""}</span>
            <button type="button" class="stop" @click=${() => void this.cancel()}>${words.stop}</button>`
        : nothing
    }
      <p role="status">${report ? reportText(report, unit) : ""}</p>
      <p class="error" id=${kProblem} role="alert" ?hidden=${!problem}>${problem}</p>`;
  }
}

/** Describes the result of a preview. */
export function reportText(report: CleanupReport, unit: (n: number) => string): string {
  const words = texts.regions;
  if (report.texels === 0) return words.nothing;
  const area = formatArea(report.area_m2);
  return report.regions > 0
    ? words.would_change(unit(report.regions), area)
    : words.would_change_area(area);
}
