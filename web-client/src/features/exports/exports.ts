// 3D models for other programs: the request for a file, and the input of the next one.

import type { Api } from "../../net/api";
import type { ModelExportRequest } from "../../core/protocol.gen";
import { kUsualExport, type ExportInput } from "../../domain/exports";
import type { FileJobs } from "../../session/file-jobs";

export class ModelExports {
  /** The input of the dialog. It is kept while the model is open. */
  draft: ExportInput = kUsualExport;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _files: FileJobs,
  ) {}

  /**
   * Starts the job and returns its key. `name` is the displayed name of the job, and `ready` the
   * title of the notice that offers the file. `lang` is the language of the labels of terms. Throws
   * an ApiError if the server refuses the request.
   */
  make(name: string, ready: string, wish: ModelExportRequest, lang: string): Promise<number> {
    return this._files.start(name, ready, () =>
      this._api.json("POST /models/{model}/exports", {
        path: { model: this._modelId },
        query: { lang },
        body: wish,
        header: { Prefer: "respond-async" },
      }),
    );
  }
}
