// Asks the server what is under the pointer: one question at a time, the newest place wins, and not
// too often.

import { newId } from "../core/ids";
import type { PointerSample } from "../ui/input";
import type { Picked } from "../core/protocol.gen";

const kAskEveryMs = 60;
const kGiveUpAfterMs = 2000;

/** What somebody does there: only points, taps to look closer, or takes the value. */
export type PickPurpose = "hover" | "look" | "take";

export interface PickProbeHost {
  ready(): boolean;
  ask(id: string, sample: PointerSample): void;
  answered(message: Picked, purpose: PickPurpose): void;
}

export class PickProbe {
  private _asked: { id: string; atMs: number; purpose: PickPurpose } | null = null;
  private _waiting: { sample: PointerSample; purpose: PickPurpose } | null = null;
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: PickProbeHost) {}

  /** No question waits, and no answer is on its way. */
  get idle(): boolean {
    return this._asked === null && this._waiting === null;
  }

  /** A press that still waits keeps its purpose, wherever the pointer goes meanwhile. */
  ask(sample: PointerSample, purpose: PickPurpose = "hover"): void {
    this._waiting = {
      sample,
      purpose: purpose === "hover" ? (this._waiting?.purpose ?? "hover") : purpose,
    };
    this.send();
  }

  /** The surface may have changed under a pointer that rests. */
  askAgain(sample: PointerSample | null): void {
    if (sample && !this._waiting) this.ask(sample);
  }

  /** True when it was the answer to this probe's question. */
  answer(message: Picked): boolean {
    const asked = this._asked;
    if (!asked || message.id !== asked.id) return false;
    this._asked = null;
    this._host.answered(message, asked.purpose);
    this.send();
    return true;
  }

  /** True when the refusal is of this probe's question; the next move of the pointer asks anew. */
  refused(ref: string | undefined): boolean {
    if (ref === undefined || ref !== this._asked?.id) return false;
    this._asked = null;
    return true;
  }

  /** The connection is gone, and the answer with it. */
  reset(): void {
    this._asked = null;
  }

  stop(): void {
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
    this._waiting = this._asked = null;
  }

  private send(): void {
    const waiting = this._waiting;
    if (!waiting || this._timer || !this._host.ready()) return;
    const nowMs = performance.now();
    // its answer sends the next
    if (this._asked && nowMs - this._asked.atMs < kGiveUpAfterMs) return;
    this._waiting = null;
    this._asked = { id: newId(), atMs: nowMs, purpose: waiting.purpose };
    this._host.ask(this._asked.id, waiting.sample);
    this._timer = setTimeout(() => {
      this._timer = null;
      this.send();
    }, kAskEveryMs);
  }
}
