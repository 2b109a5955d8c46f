// Sends unsaved changes again, in order, and no faster than the server accepts. New changes wait
// behind them.

import type { ChangeMessage } from "./outbox";

export const kFirstRetryMs = 250;
export const kLastRetryMs = 8000;

export class Resender {
  /** Below the server's limit. */
  messagesPerSecond = 100;
  private _left: ChangeMessage[] = [];
  private _delayMs = kFirstRetryMs;
  private _startTimer: ReturnType<typeof setTimeout> | null = null;
  private _sliceTimer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _send: (message: ChangeMessage) => void) {}

  /** Replaces the rest of an earlier start. */
  start(messages: ChangeMessage[]): void {
    this._left = messages;
    this.sendSlice();
  }

  /** Returns false if no resending is active and the message need not wait. */
  queue(message: ChangeMessage): boolean {
    if (this._left.length === 0) return false;
    this._left.push(message);
    return true;
  }

  /** Waits twice as long each time, until a change was saved. */
  later(start: () => void): void {
    if (this._startTimer) return;
    this._startTimer = setTimeout(() => {
      this._startTimer = null;
      start();
    }, this._delayMs);
    this._delayMs = Math.min(kLastRetryMs, this._delayMs * 2);
  }

  succeeded(): void {
    this._delayMs = kFirstRetryMs;
  }

  stop(): void {
    for (const timer of [this._startTimer, this._sliceTimer]) if (timer) clearTimeout(timer);
    this._startTimer = this._sliceTimer = null;
    this._left = [];
  }

  private sendSlice(): void {
    for (const message of this._left.splice(0, this.messagesPerSecond)) this._send(message);
    if (this._sliceTimer) clearTimeout(this._sliceTimer);
    this._sliceTimer = this._left.length > 0 ? setTimeout(() => this.sendSlice(), 1000) : null;
  }
}
