// Measured figures of the open model: this user's jobs, the resulting files, and the draft of the
// next figure.

import type { Api } from "../../net/api";
import type { Face, FigureWords } from "../../domain/figures";
import type { FigureRequest } from "../../core/protocol.gen";
import type { Job } from "../../core/types";
import type { LayerJobs } from "../../session/layer-jobs";
import { notices } from "../../ui/notices";
import { saveBlob } from "../../ui/save-from";
import { texts } from "../../texts";
import type { RolloutInput } from "./rollout-request";

export class Figures {
  /**
   * The input of the dialog. It is kept while the model is open, so the next dialog shows it again.
   */
  draft: {
    words: FigureWords;
    labels: { layer: number; column: string } | null;
    face: Face | null;
    rollout: RolloutInput | null; // null before the first rollout
  } = { words: { title: "", caption: "", credit: "" }, labels: null, face: null, rollout: null };
  /**
   * The key of the job that the open dialog waits for. The file of this job is saved immediately.
   * Notices offer the files of other jobs.
   */
  awaited: number | null = null;
  /** The name of the last saved file. */
  saved = "";

  constructor(
    private readonly _api: Api,
    private readonly _jobs: LayerJobs,
  ) {}

  /** Starts the job and returns its key. Throws an ApiError if the server refuses the request. */
  async make(name: string, wish: FigureRequest): Promise<number> {
    this.saved = "";
    this.awaited = await this._jobs.makeFigure(name, wish, (key, job) => this.done(key, job));
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

  private done(key: number, { file }: Job): void {
    if (!file) return;
    if (this.awaited === key) void this.save(key);
    else
      notices.show("success", texts.figures.ready, file.name, {
        label: texts.figures.save,
        act: () => void this.save(key),
      });
  }
}
