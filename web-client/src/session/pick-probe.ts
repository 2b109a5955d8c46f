// Asks the server what is under the pointer: one question at a time, the newest place wins, and not
// too often.

import { new_id } from "../net/api";
import type { PointerSample } from "../ui/input";
import type { Picked } from "../core/protocol.gen";

const kAskEvery_ms = 60;
const kGiveUpAfter_ms = 2000;

/** What somebody does there: only points, taps to look closer, or takes the value. */
export type PickPurpose = "hover" | "look" | "take";

export interface PickProbeHost {
  ready(): boolean;
  ask(id: string, sample: PointerSample): void;
  answered(message: Picked, purpose: PickPurpose): void;
}

export class PickProbe {
  private asked_: { id: string; at_ms: number; purpose: PickPurpose } | null = null;
  private waiting_: { sample: PointerSample; purpose: PickPurpose } | null = null;
  private timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly host_: PickProbeHost) {}

  /** No question waits, and no answer is on its way. */
  get idle(): boolean {
    return this.asked_ === null && this.waiting_ === null;
  }

  /** A press that still waits keeps its purpose, wherever the pointer goes meanwhile. */
  ask(sample: PointerSample, purpose: PickPurpose = "hover"): void {
    this.waiting_ = {
      sample,
      purpose: purpose === "hover" ? (this.waiting_?.purpose ?? "hover") : purpose,
    };
    this.send();
  }

  /** The surface may have changed under a pointer that rests. */
  ask_again(sample: PointerSample | null): void {
    if (sample && !this.waiting_) this.ask(sample);
  }

  /** True when it was the answer to this probe's question. */
  answer(message: Picked): boolean {
    const asked = this.asked_;
    if (!asked || message.id !== asked.id) return false;
    this.asked_ = null;
    this.host_.answered(message, asked.purpose);
    this.send();
    return true;
  }

  /** True when the refusal is of this probe's question; the next move of the pointer asks anew. */
  refused(ref: string | undefined): boolean {
    if (ref === undefined || ref !== this.asked_?.id) return false;
    this.asked_ = null;
    return true;
  }

  /** The connection is gone, and the answer with it. */
  reset(): void {
    this.asked_ = null;
  }

  stop(): void {
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
    this.waiting_ = this.asked_ = null;
  }

  private send(): void {
    const waiting = this.waiting_;
    if (!waiting || this.timer_ || !this.host_.ready()) return;
    const now_ms = performance.now();
    // its answer sends the next
    if (this.asked_ && now_ms - this.asked_.at_ms < kGiveUpAfter_ms) return;
    this.waiting_ = null;
    this.asked_ = { id: new_id(), at_ms: now_ms, purpose: waiting.purpose };
    this.host_.ask(this.asked_.id, waiting.sample);
    this.timer_ = setTimeout(() => {
      this.timer_ = null;
      this.send();
    }, kAskEvery_ms);
  }
}
