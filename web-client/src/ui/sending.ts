// Handles the uploads of a dialog, with progress and problems.

import type { ReactiveController, ReactiveControllerHost } from "lit";
import { ApiError } from "../net/api-error";
import type { Upload } from "../net/upload";
import { texts } from "../texts";

export type Begin<T> = (progress: (share: number) => void) => Upload<T>;

/**
 * Handles one upload at a time. A new upload replaces the previous one. If `givesUp` is set, an
 * upload is canceled when the element is removed.
 */
export class Sending implements ReactiveController {
  busy = false;
  share: number | null = null; // fraction of the sent bytes, or null if unknown
  problem = "";
  givesUp = true;
  private _upload: Upload<unknown> | null = null;

  constructor(private readonly _host: ReactiveControllerHost) {
    _host.addController(this);
  }

  hostDisconnected(): void {
    if (this.givesUp) this.cancel();
  }

  cancel(): void {
    this._upload?.cancel();
    this._upload = null;
    this.put({ busy: false, share: null });
  }

  refuse(problem: string): void {
    this.put({ problem });
  }

  /** Runs an upload. Returns null if it was refused or replaced by another upload. */
  async run<T>(begin: Begin<T>): Promise<T | null> {
    this.cancel();
    this.put({ busy: true, problem: "" });
    const upload = begin((share) => this.put({ share }));
    this._upload = upload;
    try {
      return await upload.done;
    } catch (error) {
      const cancelled = error instanceof ApiError && error.status === 499;
      if (!cancelled)
        this.put({
          problem: error instanceof ApiError ? error.message : texts.problems.unexpected,
        });
      return null;
    } finally {
      if (this._upload === upload) this.put({ busy: false });
    }
  }

  private put(change: Partial<Pick<Sending, "busy" | "share" | "problem">>): void {
    Object.assign(this, change);
    this._host.requestUpdate();
  }
}
