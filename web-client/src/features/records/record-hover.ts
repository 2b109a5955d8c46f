// The record that a mouse rests on, where a tap would show its card. Nothing is asked for it: the
// pointer's own questions tell what lies there.

import type { PointerSample } from "../../ui/input";
import type { Layer } from "../../core/types";

const kRest_ms = 350;
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
  private shown_: RecordAt | null = null;
  private from_: PointerSample | null = null; // where the mouse came to rest
  // null while `from_` is set: it has rested
  private timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly host_: RecordHoverHost) {}

  /** Null once the pointer is no longer on it, however that came. */
  get shown(): RecordAt | null {
    const here = this.shown_ && this.host_.here();
    return here && here.layer.id === this.shown_?.layer.id && here.key === this.shown_.key
      ? here
      : null;
  }

  /** A mouse is there with nothing pressed; null: there is none. */
  move(sample: PointerSample | null): void {
    if (!sample) this.end();
    else if (
      !this.shown &&
      !(this.from_ && Math.hypot(sample.x - this.from_.x, sample.y - this.from_.y) <= kTremble)
    )
      this.rest_from(sample);
    else if (this.shown) this.from_ = sample;
  }

  /** What lies under the pointer has become known anew. */
  picked(): void {
    if (this.shown) return;
    // it moved off, and another card has to wait as the first
    if (this.shown_ && this.from_) this.rest_from(this.from_);
    else if (this.from_ && !this.timer_) this.show();
  }

  /** The view moved under the mouse, and the rest begins anew. */
  wait_again(): void {
    const told = this.shown !== null;
    if (this.from_) this.rest_from(this.from_);
    if (told) this.host_.changed();
  }

  /** The person does something else: the next move of the mouse begins anew. */
  end(): void {
    const told = this.shown !== null;
    this.stop_waiting();
    this.shown_ = this.from_ = null;
    if (told) this.host_.changed();
  }

  private rest_from(sample: PointerSample): void {
    this.stop_waiting();
    this.shown_ = null;
    this.from_ = sample;
    this.timer_ = setTimeout(() => {
      this.timer_ = null;
      this.show();
    }, kRest_ms);
  }

  private show(): void {
    this.shown_ = this.host_.settled() ? this.host_.here() : null;
    if (this.shown_) this.host_.changed();
  }

  private stop_waiting(): void {
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
  }
}
