// Sends the images of photographs one after another, so that hundreds of files need little memory and
// can be stopped at any time. A file that the server refuses does not stop the others.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";

export interface RefusedFile {
  name: string;
  reason: string;
}

export class PictureImport {
  done = 0;
  total = 0;
  refused: RefusedFile[] = [];
  private _running: AbortController | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _changed: () => void,
  ) {}

  get isRunning(): boolean {
    return this._running !== null;
  }

  stop(): void {
    this._running?.abort();
    this._running = null;
    this._changed();
  }

  /** Returns the number of stored images. */
  async send(files: readonly File[]): Promise<number> {
    this.stop();
    const running = (this._running = new AbortController());
    [this.done, this.total, this.refused] = [0, files.length, []];
    this._changed();
    let stored = 0;
    for (const file of files) {
      try {
        await this._api.json("POST /models/{model}/photographs", {
          path: { model: this._modelId },
          query: { filename: file.webkitRelativePath || file.name },
          body: file,
          type: file.type,
          signal: running.signal,
        });
        ++stored;
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (running.signal.aborted) break;
        this.refused.push({ name: file.name, reason: error.message });
      }
      ++this.done;
      this._changed();
    }
    if (this._running === running) this._running = null;
    this._changed();
    return stored;
  }
}
