// The record under the mouse pointer while the pointer does not move. A click at this position
// opens the card of the record. This class sends no requests, because it uses the responses to the
// pointer's requests.

import type { PointerSample } from "../../ui/input";
import type { Layer } from "../../core/types";

const kRestMs = 350;
const kTremble = 4; // in window pixels; tolerated movement of a resting hand

export interface RecordAt {
  layer: Layer;
  key: number;
}

export interface RecordHoverHost {
  /** Returns the known record under the pointer. */
  here(): RecordAt | null;
  /**
   * Returns whether `here` is valid for the pointer's current position, without a pending request.
   */
  settled(): boolean;
  changed(): void;
}

export class RecordHover {
  private _shown: RecordAt | null = null;
  private _from: PointerSample | null = null; // the position where the mouse stopped
  // null although `_from` is set: the delay has ended
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: RecordHoverHost) {}

  /** The record to show; null after the pointer has left it for any reason. */
  get shown(): RecordAt | null {
    const here = this._shown && this._host.here();
    return here && here.layer.id === this._shown?.layer.id && here.key === this._shown.key
      ? here
      : null;
  }

  /**
   * Handles a mouse position without a pressed button. Null means that the mouse has left, or that
   * another pointer is used.
   */
  move(sample: PointerSample | null): void {
    if (!sample) this.end();
    else if (
      !this.shown &&
      !(this._from && Math.hypot(sample.x - this._from.x, sample.y - this._from.y) <= kTremble)
    )
      this.restFrom(sample);
    else if (this.shown) this._from = sample;
  }

  /** Call this after a response with the values under the pointer. */
  picked(): void {
    if (this.shown) return;
    // the mouse has left the record; the next card appears after the same delay
    if (this._shown && this._from) this.restFrom(this._from);
    else if (this._from && !this._timer) this.show();
  }

  /** Starts the delay again, because the view moved under the mouse. */
  waitAgain(): void {
    const told = this.shown !== null;
    if (this._from) this.restFrom(this._from);
    if (told) this._host.changed();
  }

  /**
   * Hides the record, because the user does something else. The next mouse movement starts the
   * delay.
   */
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
