// What a person keeps of how they show the layers of a model: sent to the server soon after each
// change, and before the page goes.

import { ApiError, type Api } from "../../net/api";
import type { PersonalView } from "../../core/protocol.gen";

const kPause_ms = 400; // a slider tells many changes

export class PersonalViewKeeper {
  private timer_: ReturnType<typeof setTimeout> | 0 = 0;
  private sending_: Promise<void> | null = null;
  private wanted_: PersonalView | null = null; // what the server does not have yet

  constructor(
    private readonly api_: Pick<Api, "keep_personal_view">,
    private readonly model_id_: string,
  ) {}

  /** What the server tells is older than what this page wants to keep. */
  get is_ahead(): boolean {
    return this.wanted_ !== null || this.sending_ !== null;
  }

  keep(view: PersonalView): void {
    this.wanted_ = view;
    clearTimeout(this.timer_);
    this.timer_ = setTimeout(() => void this.send(), kPause_ms);
  }

  /** Now, as the page may be gone in a moment; also what could not be sent before. */
  flush(): void {
    clearTimeout(this.timer_);
    void this.send();
  }

  private async send(): Promise<void> {
    await this.sending_;
    const view = this.wanted_;
    if (!view) return;
    this.wanted_ = null;
    this.sending_ = this.api_
      .keep_personal_view(this.model_id_, view)
      .catch((error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        this.wanted_ ??= view; // with the next change, or when the connection is back
      })
      .finally(() => (this.sending_ = null));
    await this.sending_;
  }
}
