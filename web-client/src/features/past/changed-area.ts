// The difference between a past state and the newest one on the visible layers. The surface
// highlights it, and the server measures it.

import type { SelectResponse } from "../../core/protocol.gen";
import { ApiError } from "../../net/api-error";
import type { LitArea } from "../../session/lit-area";

const kWaitMs = 300; // the user may move the handle again, or another edit may follow

export interface ComparedLayer {
  slug: string;
  sequence: number;
}

export class ChangedArea {
  /** The measured difference; null while it is unknown. */
  measured: Pick<SelectResponse, "texels" | "area_m2" | "share"> | null = null;
  problem = "";
  private _followed = "";
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly _lit: Pick<LitArea, "show" | "clear">,
    private readonly _changed: () => void,
  ) {}

  /**
   * Call this after each change of the state, the layers, or their edits. A null state removes the
   * highlight.
   */
  follow(from: number | null, layers: readonly ComparedLayer[]): void {
    const followed = from === null ? "" : JSON.stringify([from, layers]);
    if (followed === this._followed) return;
    this._followed = followed;
    this.measured = null;
    this.problem = "";
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
    if (from === null || layers.length === 0) {
      this._lit.clear();
      if (from !== null) this.measured = { texels: 0, area_m2: 0, share: 0 };
    } else {
      this._timer = setTimeout(() => {
        void this.light(
          from,
          layers.map(({ slug }) => slug),
        );
      }, kWaitMs);
    }
    this._changed();
  }

  stop(): void {
    this.follow(null, []);
  }

  private async light(from: number, layers: string[]): Promise<void> {
    const asked = this._followed;
    try {
      const measured = await this._lit.show({ changed: { from, layers } });
      if (asked !== this._followed) return;
      this.measured = measured;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._followed || error.status === 499) return;
      this.problem = error.message;
    }
    this._changed();
  }
}
