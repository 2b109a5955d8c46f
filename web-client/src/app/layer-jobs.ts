// Work under way that makes layers or looks of the open model: computing one from the shape, bringing some over from another scan. The layers
// themselves come to the page like anyone's, when they are done.

import { ApiError, type Api } from "../core/api";
import type { Job, LayerCreate, ProblemBody, Transfer, TransferReport } from "../core/types";
import { follow_job, job_is_over } from "./follow-job";

export interface LayerJob {
  key: number;
  name: string;
  job: Job;
  problem: ProblemBody | null;
  report: TransferReport | null;
}

/** Work that the server has taken on. */
export interface StartedJob {
  /** Ids of the layers it made; none where it was cancelled or failed. */
  done: Promise<readonly number[]>;
}

export const is_busy = (entry: LayerJob): boolean => !entry.problem && !job_is_over(entry.job);

export class LayerJobs {
  entries: readonly LayerJob[] = [];
  private next_key_ = 1;

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly changed_: () => void,
  ) {}

  /** Throws an ApiError where the server refuses it at once. */
  async compute(layer: LayerCreate): Promise<StartedJob> {
    const job = await this.api_.compute_layer(this.model_id_, layer);
    return { done: this.follow(layer.name, job) };
  }

  /** The same. `name`: what the person is told that it is. */
  async transfer(name: string, wish: Transfer): Promise<StartedJob> {
    const job = await this.api_.transfer(this.model_id_, wish);
    return { done: this.follow(name, job) };
  }

  /** Work that something else has started; `made` hears of it once it is done. */
  watch(name: string, job: Job, made: (job: Job) => void): void {
    void this.follow(name, job, made);
  }

  async cancel(key: number): Promise<void> {
    const job = this.entries.find((entry) => entry.key === key)?.job;
    if (job) await this.api_.cancel_job(job.id);
  }

  dismiss(key: number): void {
    this.entries = this.entries.filter((entry) => entry.key !== key);
    this.changed_();
  }

  private async follow(name: string, first: Job, made: (job: Job) => void = () => {}): Promise<readonly number[]> {
    const key = this.next_key_++;
    this.entries = [...this.entries, { key, name, job: first, problem: null, report: null }];
    try {
      const job = await follow_job(this.api_, first, (now) => this.change(key, { job: now }));
      if (job.state === "failed") this.change(key, { problem: job.problem ?? { status: 500, title: job.message } });
      else if (job.report) this.change(key, { report: job.report });
      else this.dismiss(key);
      if (job.state === "done") made(job);
      return job.layers ?? [];
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.change(key, { problem: error.problem });
      return [];
    }
  }

  private change(key: number, change: Partial<LayerJob>): void {
    this.entries = this.entries.map((entry) => (entry.key === key ? { ...entry, ...change } : entry));
    this.changed_();
  }
}
