// Jobs that make files for this user, such as figures and condition reports. The file is saved
// immediately if the dialog that started the job is still open. Otherwise a notice offers it.

import type { Api } from "../net/api";
import type { Job } from "../core/types";
import { notices } from "../ui/notices";
import { saveBlob } from "../ui/save-from";
import { texts } from "../texts";
import type { LayerJobs } from "./layer-jobs";

export class FileJobs {
  /**
   * The key of the job that the open dialog waits for. The file of this job is saved immediately.
   * Notices offer the files of other jobs.
   */
  awaited: number | null = null;
  /** The name of the last file that was saved for the open dialog. */
  saved = "";

  constructor(
    private readonly _api: Api,
    private readonly _jobs: LayerJobs,
  ) {}

  /**
   * Starts a job and returns its key. `name` is the displayed name of the job, and `ready` the
   * title of the notice that offers the file. Throws an ApiError if the server refuses the request.
   */
  async start(name: string, ready: string, ask: () => Promise<Job>): Promise<number> {
    this.saved = "";
    const job = await ask();
    this.awaited = this._jobs.watch(name, job, (last, key) => this.done(key, ready, last));
    return this.awaited;
  }

  async save(key: number): Promise<void> {
    const job = this._jobs.entries.find((entry) => entry.key === key)?.job;
    if (!job?.file) return;
    try {
      saveBlob(
        await this._api.blob("GET /jobs/{job}/file", { path: { job: job.id } }),
        job.file.name,
      );
      this.saved = job.file.name;
      this._jobs.dismiss(key);
    } catch (error) {
      notices.error(error);
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
