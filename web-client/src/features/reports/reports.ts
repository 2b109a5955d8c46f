// Condition reports of the open model: the request for a report, and the draft of the next one.

import type { Api } from "../../net/api";
import type { ReportInput } from "../../domain/reports";
import type { ReportRequest } from "../../core/protocol.gen";
import type { Job } from "../../core/types";
import { Kept } from "../../core/kept";
import type { FileJobs, ShowFile } from "../../session/file-jobs";

export class Reports {
  /**
   * The input of the dialog. It is kept while the model is open, so the next dialog shows it again.
   * Null before the first dialog.
   */
  draft: ReportInput | null = null;
  private _choices: Kept<unknown> | null = null;
  private _logo: Kept<unknown> | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _files: FileJobs,
  ) {}

  /**
   * Starts the job and returns its key. `name` is the displayed name of the job, and `ready` the
   * title of the notice that offers the file. Throws an ApiError if the server refuses the request.
   */
  make(name: string, ready: string, wish: ReportRequest): Promise<number> {
    return this._files.start(name, ready, () => this.ask(wish));
  }

  /**
   * Starts the job of a preview and returns its key. `show` receives the file while the dialog
   * waits for it. Throws like make().
   */
  preview(name: string, wish: ReportRequest, show: ShowFile): Promise<number> {
    return this._files.preview(name, () => this.ask(wish), show);
  }

  private ask(wish: ReportRequest): Promise<Job> {
    return this._api.json("POST /models/{model}/report", {
      path: { model: this._modelId },
      body: wish,
      header: { Prefer: "respond-async" },
    });
  }

  /** The choices that are kept for reports of other models. They are read at the first dialog. */
  get choices(): Kept<unknown> {
    return (this._choices ??= new Kept<unknown>(() => localStorage, "strata.report", null));
  }

  /** The kept logo. It stays in memory if it is too large for the browser's storage. */
  get logo(): Kept<unknown> {
    return (this._logo ??= new Kept<unknown>(() => localStorage, "strata.report.logo", null));
  }
}
