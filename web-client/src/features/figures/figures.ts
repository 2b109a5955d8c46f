// Measured figures of the open model: the request for a figure, and the draft of the next one.

import { pageLocale } from "../../core/locale";
import type { Api } from "../../net/api";
import { emptyBlock, type BlockTexts } from "../../domain/figure-block";
import type { Face, FigureWords } from "../../domain/figures";
import type { FigureRequest } from "../../core/protocol.gen";
import type { FileJobs } from "../../session/file-jobs";
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
    block: BlockTexts;
    views: readonly number[]; // the chosen saved views, by id
  } = {
    words: { title: "", caption: "", credit: "" },
    labels: null,
    face: null,
    rollout: null,
    block: emptyBlock(),
    views: [],
  };

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _files: FileJobs,
  ) {}

  /** Starts the job and returns its key. Throws an ApiError if the server refuses the request. */
  make(name: string, wish: FigureRequest): Promise<number> {
    return this._files.start(name, texts.figures.ready, () =>
      this._api.json("POST /models/{model}/figures", {
        path: { model: this._modelId },
        query: { lang: pageLocale() },
        body: wish,
        header: { Prefer: "respond-async" },
      }),
    );
  }
}
