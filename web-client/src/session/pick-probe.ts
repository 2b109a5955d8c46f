// Asks the server for the values under the pointer: one request at a time and at limited intervals;
// the latest position wins.

import { newId } from "../core/ids";
import type { PointerSample } from "../ui/input";
import type { Picked } from "../core/protocol.gen";

const kAskEveryMs = 60;
const kGiveUpAfterMs = 2000;

/** The action at the position: only pointing, a tap to look closer, or taking the value. */
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

  /** Whether no request waits and none is pending. */
  get idle(): boolean {
    return this._asked === null && this._waiting === null;
  }

  /** A waiting press keeps its purpose, regardless of later pointer moves. */
  ask(sample: PointerSample, purpose: PickPurpose = "hover"): void {
    this._waiting = {
      sample,
      purpose: purpose === "hover" ? (this._waiting?.purpose ?? "hover") : purpose,
    };
    this.send();
  }

  /** Asks again when the surface may have changed under a resting pointer. */
  askAgain(sample: PointerSample | null): void {
    if (sample && !this._waiting) this.ask(sample);
  }

  /** Returns true for an answer to this probe's request. */
  answer(message: Picked): boolean {
    const asked = this._asked;
    if (!asked || message.id !== asked.id) return false;
    this._asked = null;
    this._host.answered(message, asked.purpose);
    this.send();
    return true;
  }

  /** Returns true for a refusal of this probe's request; the next pointer move asks again. */
  refused(ref: string | undefined): boolean {
    if (ref === undefined || ref !== this._asked?.id) return false;
    this._asked = null;
    return true;
  }

  /** The connection was lost, and with it the answer. */
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
    // its answer triggers the next request
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
