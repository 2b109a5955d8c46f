// Jobs that make files for this user, such as figures and condition reports. The file is saved
// immediately if the dialog that started the job is still open. Otherwise a notice offers it. The
// file of a preview is only for the dialog that shows it.

import type { Api } from "../net/api";
import { ApiError } from "../net/api-error";
import type { JobFile } from "../core/protocol.gen";
import type { Job } from "../core/types";
import { notices } from "../ui/notices";
import { saveBlob } from "../ui/save-from";
import { texts } from "../texts";
import { isBusy, type LayerJobs } from "./layer-jobs";

/** Receives the file of a preview and its name. */
export type ShowFile = (file: Blob, name: string) => void;

export class FileJobs {
  /**
   * The key of the job that the open dialog waits for. The file of this job is saved or shown
   * immediately. Notices offer the files of other jobs.
   */
  awaited: number | null = null;
  /** The last file that was saved for the open dialog. */
  saved: JobFile | null = null;
  private _preview: number | null = null; // the key of the last preview

  constructor(
    private readonly _api: Api,
    private readonly _jobs: LayerJobs,
  ) {}

  /**
   * Starts a job and returns its key. `name` is the displayed name of the job, and `ready` the
   * title of the notice that offers the file. Throws an ApiError if the server refuses the request.
   */
  async start(name: string, ready: string, ask: () => Promise<Job>): Promise<number> {
    this.saved = null;
    const job = await ask();
    this.awaited = this._jobs.watch(name, job, (last, key) => this.done(key, ready, last));
    return this.awaited;
  }

  /**
   * Starts a job whose file the open dialog shows, and returns its key. `show` is not called if the
   * dialog has stopped waiting for the job. Throws an ApiError if the server refuses the request.
   */
  async preview(name: string, ask: () => Promise<Job>, show: ShowFile): Promise<number> {
    this.saved = null;
    const job = await ask();
    this.awaited = this._jobs.watch(name, job, (last, key) => void this.show(key, last, show));
    this._preview = this.awaited;
    return this.awaited;
  }

  /** Whether the open dialog waits for a preview. */
  get awaitsPreview(): boolean {
    return this.awaited !== null && this.awaited === this._preview;
  }

  /**
   * The dialog has closed. A notice will offer the file of the job that it waited for. A preview is
   * canceled.
   */
  async leave(): Promise<void> {
    const { awaited, awaitsPreview } = this;
    this.awaited = null;
    if (!awaitsPreview || !this._jobs.entries.some((job) => job.key === awaited && isBusy(job)))
      return;
    try {
      await this._jobs.cancel(awaited!);
    } catch (error) {
      // the job continues, and show() ignores its file
      if (!(error instanceof ApiError)) throw error;
    }
  }

  async save(key: number): Promise<void> {
    const job = this._jobs.entries.find((entry) => entry.key === key)?.job;
    if (!job?.file) return;
    try {
      saveBlob(
        await this._api.blob("GET /jobs/{job}/file", { path: { job: job.id } }),
        job.file.name,
      );
      this.saved = job.file;
      this._jobs.dismiss(key);
    } catch (error) {
      notices.error(error);
    }
  }

  private async show(key: number, { id, file }: Job, show: ShowFile): Promise<void> {
    try {
      if (!file || this.awaited !== key) return;
      const blob = await this._api.blob("GET /jobs/{job}/file", { path: { job: id } });
      if (this.awaited === key) show(blob, file.name);
    } catch (error) {
      notices.error(error);
    } finally {
      this._jobs.dismiss(key);
    }
  }

  private done(key: number, ready: string, { file }: Job): void {
    if (!file) return;
    if (this.awaited === key) void this.save(key);
    else
      notices.show("success", ready, file.name, {
        label: texts.figures.save,
        act: () => void this.save(key),
      });
  }
}
