// Requests the values under the pointer from the server: one request at a time, with minimum
// intervals, and always for the latest position.

import { newId } from "../core/ids";
import type { PointerSample } from "../ui/input";
import type { Picked } from "../core/protocol.gen";

const kAskEveryMs = 60;
const kGiveUpAfterMs = 2000;

/**
 * The action at the position: only pointing, a tap to look at the values, or taking the value for
 * the brush.
 */
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

  /** Whether no request is waiting or pending. */
  get idle(): boolean {
    return this._asked === null && this._waiting === null;
  }

  /**
   * Requests the values at a position. A waiting press keeps its purpose, regardless of later
   * pointer moves.
   */
  ask(sample: PointerSample, purpose: PickPurpose = "hover"): void {
    this._waiting = {
      sample,
      purpose: purpose === "hover" ? (this._waiting?.purpose ?? "hover") : purpose,
    };
    this.send();
  }

  /** Repeats the request, because the surface may have changed under a resting pointer. */
  askAgain(sample: PointerSample | null): void {
    if (sample && !this._waiting) this.ask(sample);
  }

  /** Handles a response. Returns true if it belongs to this probe's request. */
  answer(message: Picked): boolean {
    const asked = this._asked;
    if (!asked || message.id !== asked.id) return false;
    this._asked = null;
    this._host.answered(message, asked.purpose);
    this.send();
    return true;
  }

  /**
   * Handles a refusal. Returns true if it belongs to this probe's request. The next pointer move
   * sends a new request.
   */
  refused(ref: string | undefined): boolean {
    if (ref === undefined || ref !== this._asked?.id) return false;
    this._asked = null;
    return true;
  }

  /** Discards the pending request, because its response was lost with the connection. */
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
    // The response to the pending request triggers the next request.
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
