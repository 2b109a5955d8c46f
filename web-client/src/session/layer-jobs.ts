// Running jobs that make layers or surface images of the open model, or files for this user.
// Examples are a layer computed from the shape, layers transferred from another scan, and a figure
// to scale. All participants receive finished layers in events. A file is listed until the user
// saves it.

import { ApiError } from "../net/api-error";
import type { Api } from "../net/api";
import type { Job, LayerCreate, ProblemBody, Transfer, TransferReport } from "../core/types";
import { followJob, jobIsOver } from "../net/follow-job";
import { texts } from "../texts";

export interface LayerJob {
  key: number;
  name: string;
  job: Job;
  problem: ProblemBody | null;
  report: TransferReport | null;
}

/** A job that the server has accepted. */
export interface StartedJob {
  /** The ids of the new layers. Empty if the job was canceled or failed. */
  done: Promise<readonly number[]>;
}

export const isBusy = (entry: LayerJob): boolean => !entry.problem && !jobIsOver(entry.job);

/** Describes what a job does now. `otherwise` is for a job that does not say it. */
export const stepOf = (job: Job, otherwise = ""): string =>
  job.state === "queued" ? texts.layer_jobs.queued : job.message || otherwise;

export class LayerJobs {
  entries: readonly LayerJob[] = [];
  private _nextKey = 1;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _changed: () => void,
  ) {}

  /**
   * Starts a job that computes a layer. Throws an ApiError if the server refuses the job
   * immediately.
   */
  async compute(layer: LayerCreate): Promise<StartedJob> {
    const job = (await this._api.json("POST /models/{model}/layers", {
      path: { model: this._modelId },
      body: layer,
    })) as Job;
    return { done: this.follow(this.add(layer.name, job), job) };
  }

  /**
   * Starts a job that transfers layers. `name` is the displayed name of the job. Throws like
   * compute().
   */
  async transfer(name: string, wish: Transfer): Promise<StartedJob> {
    const job = await this._api.json("POST /models/{model}/transfer", {
      path: { model: this._modelId },
      body: wish,
    });
    return { done: this.follow(this.add(name, job), job) };
  }

  /**
   * Follows a job that another part of the page has started. Returns the key of its entry. Calls
   * `made` when the job is done.
   */
  watch(name: string, job: Job, made: (job: Job, key: number) => void): number {
    const key = this.add(name, job);
    void this.follow(key, job, (last) => made(last, key));
    return key;
  }

  async cancel(key: number): Promise<void> {
    const job = this.entries.find((entry) => entry.key === key)?.job;
    if (job) await this._api.send("DELETE /jobs/{job}", { path: { job: job.id } });
  }

  dismiss(key: number): void {
    this.entries = this.entries.filter((entry) => entry.key !== key);
    this._changed();
  }

  private add(name: string, job: Job): number {
    const key = this._nextKey++;
    this.entries = [...this.entries, { key, name, job, problem: null, report: null }];
    return key;
  }

  private async follow(
    key: number,
    first: Job,
    made: (job: Job) => void = () => {},
  ): Promise<readonly number[]> {
    try {
      const job = await followJob(this._api, first, (now) => this.change(key, { job: now }));
      if (job.state === "failed")
        this.change(key, { problem: job.problem ?? { status: 500, title: job.message } });
      else if (job.report) this.change(key, { report: job.report });
      else if (!job.file) this.dismiss(key);
      if (job.state === "done") made(job);
      return job.layers ?? [];
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.change(key, { problem: error.problem });
      return [];
    }
  }

  private change(key: number, change: Partial<LayerJob>): void {
    this.entries = this.entries.map((entry) =>
      entry.key === key ? { ...entry, ...change } : entry,
    );
    this._changed();
  }
}
