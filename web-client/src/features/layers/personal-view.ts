// A user's stored settings for the layers of a model. They are sent to the server shortly after
// each change, and before the page closes.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { PersonalView } from "../../core/protocol.gen";

const kPauseMs = 400; // a slider reports many changes
const kMostKeptAlive = 60_000; // in characters; the browsers' limit for `keepalive`

export class PersonalViewKeeper {
  private _timer: ReturnType<typeof setTimeout> | 0 = 0;
  private _sending: Promise<void> | null = null;
  private _wanted: PersonalView | null = null; // settings that the server does not have yet

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
  ) {}

  /** Whether this page has newer settings than the server. */
  get isAhead(): boolean {
    return this._wanted !== null || this._sending !== null;
  }

  keep(view: PersonalView): void {
    this._wanted = view;
    clearTimeout(this._timer);
    this._timer = setTimeout(() => void this.send(), kPauseMs);
  }

  /**
   * Sends the settings immediately, because the page may close. They include settings of failed
   * requests.
   */
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
        this._wanted ??= view; // the next change or a reconnection sends them again
      })
      .finally(() => (this._sending = null));
    await this._sending;
  }
}
