// Sends unsaved changes again, in order, and no faster than the server accepts. New changes wait
// until the earlier changes are sent.

import type { ChangeMessage } from "./outbox";

const kFirstRetryMs = 250;
export const kLastRetryMs = 8000;

/** Returns the time before the next attempt. It doubles with each attempt, and varies at random. */
export const retryDelayMs = (attempts: number, random: number, lastMs = kLastRetryMs): number =>
  Math.min(lastMs, kFirstRetryMs * 2 ** attempts) * (0.75 + random / 2);

export class Resender {
  /** The rate of messages, which is below the server's limit. */
  messagesPerSecond = 100;
  private _left: ChangeMessage[] = [];
  private _delayMs = kFirstRetryMs;
  private _startTimer: ReturnType<typeof setTimeout> | null = null;
  private _sliceTimer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _send: (message: ChangeMessage) => void) {}

  /** Starts to send messages. They replace the remaining messages of an earlier start. */
  start(messages: ChangeMessage[]): void {
    this._left = messages;
    this.sendSlice();
  }

  /**
   * Queues a message. Returns false if no messages are being sent again, so the caller can send the
   * message directly.
   */
  queue(message: ChangeMessage): boolean {
    if (this._left.length === 0) return false;
    this._left.push(message);
    return true;
  }

  /** Starts again after a delay, which doubles each time until a change is saved. */
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
