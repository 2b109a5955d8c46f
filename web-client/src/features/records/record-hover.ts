// The record that a mouse rests on, where a tap would show its card. Nothing is asked for it: the
// pointer's own questions tell what lies there.

import type { PointerSample } from "../../ui/input";
import type { Layer } from "../../core/types";

const kRestMs = 350;
const kTremble = 4; // window pixels that a resting hand moves

export interface RecordAt {
  layer: Layer;
  key: number;
}

export interface RecordHoverHost {
  /** What is known to lie under the pointer. */
  here(): RecordAt | null;
  /** That is of where the pointer is now, and no answer is on its way. */
  settled(): boolean;
  changed(): void;
}

export class RecordHover {
  private _shown: RecordAt | null = null;
  private _from: PointerSample | null = null; // where the mouse came to rest
  // null while `_from` is set: it has rested
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: RecordHoverHost) {}

  /** Null once the pointer is no longer on it, however that came. */
  get shown(): RecordAt | null {
    const here = this._shown && this._host.here();
    return here && here.layer.id === this._shown?.layer.id && here.key === this._shown.key
      ? here
      : null;
  }

  /** A mouse is there with nothing pressed; null: there is none. */
  move(sample: PointerSample | null): void {
    if (!sample) this.end();
    else if (
      !this.shown &&
      !(this._from && Math.hypot(sample.x - this._from.x, sample.y - this._from.y) <= kTremble)
    )
      this.restFrom(sample);
    else if (this.shown) this._from = sample;
  }

  /** What lies under the pointer has become known anew. */
  picked(): void {
    if (this.shown) return;
    // it moved off, and another card has to wait as the first
    if (this._shown && this._from) this.restFrom(this._from);
    else if (this._from && !this._timer) this.show();
  }

  /** The view moved under the mouse, and the rest begins anew. */
  waitAgain(): void {
    const told = this.shown !== null;
    if (this._from) this.restFrom(this._from);
    if (told) this._host.changed();
  }

  /** The person does something else: the next move of the mouse begins anew. */
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
