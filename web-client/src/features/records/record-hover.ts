// The record that a mouse rests on, where a click would open its card. It sends no requests: it
// uses the answers to the pointer's own ones.

import type { PointerSample } from "../../ui/input";
import type { Layer } from "../../core/types";

const kRestMs = 350;
const kTremble = 4; // window pixels of movement by a resting hand

export interface RecordAt {
  layer: Layer;
  key: number;
}

export interface RecordHoverHost {
  /** The record under the pointer, as far as known. */
  here(): RecordAt | null;
  /** Whether that is for the pointer's current position, and no answer is pending. */
  settled(): boolean;
  changed(): void;
}

export class RecordHover {
  private _shown: RecordAt | null = null;
  private _from: PointerSample | null = null; // the position where the mouse stopped
  // null while `_from` is set: the waiting time is over
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: RecordHoverHost) {}

  /** Null after the pointer has left the record for any reason. */
  get shown(): RecordAt | null {
    const here = this._shown && this._host.here();
    return here && here.layer.id === this._shown?.layer.id && here.key === this._shown.key
      ? here
      : null;
  }

  /** A mouse without a pressed button; null: no mouse. */
  move(sample: PointerSample | null): void {
    if (!sample) this.end();
    else if (
      !this.shown &&
      !(this._from && Math.hypot(sample.x - this._from.x, sample.y - this._from.y) <= kTremble)
    )
      this.restFrom(sample);
    else if (this.shown) this._from = sample;
  }

  /** Call this when the values under the pointer are known again. */
  picked(): void {
    if (this.shown) return;
    // the mouse left the record; the next card waits like the first
    if (this._shown && this._from) this.restFrom(this._from);
    else if (this._from && !this._timer) this.show();
  }

  /** The view moved under the mouse: the waiting time starts again. */
  waitAgain(): void {
    const told = this.shown !== null;
    if (this._from) this.restFrom(this._from);
    if (told) this._host.changed();
  }

  /** The person does something else: the next mouse move starts the waiting time. */
  end(): void {
    const told = this.shown !== null;
    this.stopWaiting();
    this._shown = this._from = null;
    if (told) this._host.changed();
  }

  private restFrom(sample: PointerSample): void {
    this.stopWaiting();
    this._shown = null;
    this._from = sample;
    this._timer = setTimeout(() => {
      this._timer = null;
      this.show();
    }, kRestMs);
  }

  private show(): void {
    this._shown = this._host.settled() ? this._host.here() : null;
    if (this._shown) this._host.changed();
  }

  private stopWaiting(): void {
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }
}
