// Files that a dialog sends: how far they are, and what is wrong.

import type { ReactiveController, ReactiveControllerHost } from "lit";
import { ApiError } from "../net/api-error";
import type { Upload } from "../net/upload";
import { texts } from "../texts";

export type Begin<T> = (progress: (share: number) => void) => Upload<T>;

/**
 * One at a time: a new one takes the place of the one before. What is under way when the element
 * leaves is given up where `givesUp` says so.
 */
export class Sending implements ReactiveController {
  busy = false;
  share: number | null = null; // of the bytes; null: not known
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

  /** Null: it was refused, or another one took its place. */
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
