// What differs between a state and now on the visible layers: lit on the surface, and measured.

import type { SelectResponse } from "../../core/protocol.gen";
import { ApiError } from "../../net/api-error";
import type { LitArea } from "../../session/lit-area";

const kWaitMs = 300; // the handle moves on, or another edit follows

export interface ComparedLayer {
  slug: string;
  sequence: number;
}

export class ChangedArea {
  /** Null: not known yet. */
  measured: Pick<SelectResponse, "texels" | "area_m2" | "share"> | null = null;
  problem = "";
  private _followed = "";
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly _lit: Pick<LitArea, "show" | "clear">,
    private readonly _changed: () => void,
  ) {}

  /** Call after each change: of the state (null: nothing is lit), the layers, or their edits. */
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
