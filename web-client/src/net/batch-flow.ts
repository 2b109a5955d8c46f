// Whether the server keeps up with the batches of strokes.

import type { StrokeExtend } from "../core/protocol.gen";

/** With fewer batches on their way, the server keeps up. */
export const kMostUnanswered = 4;
/** The server keeps up if it needs this much longer than for its quickest reply. */
export const kUsualDelayMs = 50;
/** The longest round trip of a connection that is not taken for a busy server. */
export const kLongestRoundTripMs = 300;

interface Sent {
  id: string;
  stroke: string;
  n: number;
  atMs: number;
}

/**
 * The batches of all strokes of a connection that the server has not painted. More batches on their
 * way to a busy server would only wait for each other. The quickest reply shows how much of the
 * time is the round trip of a slow connection, during which the server is not busy.
 */
export class BatchFlow {
  private _sent: Sent[] = []; // in the order of sending
  private _quickestMs = kLongestRoundTripMs;

  sent({ id, stroke, n }: StrokeExtend): void {
    this._sent.push({ id, stroke, n, atMs: performance.now() });
  }

  /** The server has painted this batch, and all earlier batches of the stroke. */
  painted(stroke: string, n: number): void {
    const painted = this._sent.find((sent) => sent.stroke === stroke && sent.n === n);
    if (painted) this._quickestMs = Math.min(this._quickestMs, performance.now() - painted.atMs);
    this._sent = this._sent.filter((sent) => sent.stroke !== stroke || sent.n > n);
  }

  /** The server has refused the message with this id. */
  refused(id: string): void {
    this._sent = this._sent.filter((sent) => sent.id !== id);
  }

  /** A new connection begins, which may be to another node. */
  restart(): void {
    this._sent = [];
    this._quickestMs = kLongestRoundTripMs;
  }

  /** Whether further points should wait for a reply. */
  get isBehind(): boolean {
    const oldest = this._sent[0];
    if (!oldest || this._sent.length < kMostUnanswered) return false;
    return performance.now() - oldest.atMs > this._quickestMs + kUsualDelayMs;
  }
}
