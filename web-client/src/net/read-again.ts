// Schedules new reads after events. The server sends these events before it has saved a change. One
// read follows soon after the first event, and another when the last change is certainly saved.

const kSoonMs = 1000; // events in this time cause a single read
const kSavedMs = 3000; // time after the last event

export class ReadAgain {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _newestMs = 0;

  /** `last` is true if no further read follows without new events. */
  constructor(private readonly _read: (last: boolean) => void) {}

  news(): void {
    this._newestMs = performance.now();
    this._timer ??= setTimeout(this._look, kSoonMs);
  }

  stop(): void {
    if (this._timer !== null) clearTimeout(this._timer);
    this._timer = null;
  }

  private readonly _look = (): void => {
    const leftMs = this._newestMs + kSavedMs - performance.now();
    this._timer = leftMs > 0 ? setTimeout(this._look, leftMs) : null;
    this._read(leftMs <= 0);
  };
}
