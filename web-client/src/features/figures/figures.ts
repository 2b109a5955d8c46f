// Measured figures that this person makes of the open model: the work on the server, the file that
// comes of it, and what was written for one until then.

import type { Api } from "../../net/api";
import type { Face, FigureWords } from "../../domain/figures";
import type { FigureRequest } from "../../core/protocol.gen";
import type { Job } from "../../core/types";
import type { LayerJobs } from "../../session/layer-jobs";
import { notices } from "../../ui/notices";
import { saveBlob } from "../../ui/save-from";
import { texts } from "../../texts";

export class Figures {
  /** Is there again when the dialog is opened anew, for as long as the model is open. */
  draft: {
    words: FigureWords;
    labels: { layer: number; column: string } | null;
    face: Face | null;
  } = { words: { title: "", caption: "", credit: "" }, labels: null, face: null };
  /**
   * Key of the job that somebody waits for: its file is saved as soon as it is there, and others
   * are offered.
   */
  awaited: number | null = null;
  /** Name of the file that was saved last. */
  saved = "";

  constructor(
    private readonly _api: Api,
    private readonly _jobs: LayerJobs,
  ) {}

  /**
   * Returns the key of the job, which is awaited. Throws an ApiError where the server refuses it at
   * once.
   */
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
