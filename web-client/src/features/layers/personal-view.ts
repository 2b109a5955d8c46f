// What a person keeps of how they show the layers of a model: sent to the server soon after each
// change, and before the page goes.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { PersonalView } from "../../core/protocol.gen";

const kPauseMs = 400; // a slider tells many changes
const kMostKeptAlive = 60_000; // characters that browsers send after the page is left

export class PersonalViewKeeper {
  private _timer: ReturnType<typeof setTimeout> | 0 = 0;
  private _sending: Promise<void> | null = null;
  private _wanted: PersonalView | null = null; // what the server does not have yet

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
  ) {}

  /** What the server tells is older than what this page wants to keep. */
  get isAhead(): boolean {
    return this._wanted !== null || this._sending !== null;
  }

  keep(view: PersonalView): void {
    this._wanted = view;
    clearTimeout(this._timer);
    this._timer = setTimeout(() => void this.send(), kPauseMs);
  }

  /** Now, as the page may be gone in a moment; also what could not be sent before. */
  flush(): void {
    clearTimeout(this._timer);
    void this.send();
  }

  private async send(): Promise<void> {
    await this._sending;
    const view = this._wanted;
    if (!view) return;
    this._wanted = null;
    this._sending = this._api
      .send("PUT /me/models/{model}/view", {
        path: { model: this._modelId },
        body: view,
        keepalive: JSON.stringify(view).length < kMostKeptAlive,
      })
      .catch((error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        this._wanted ??= view; // with the next change, or when the connection is back
      })
      .finally(() => (this._sending = null));
    await this._sending;
  }
}
