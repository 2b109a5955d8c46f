// Times to read again after events that precede the saving: soon after the first event, and again
// when the last one is certainly saved.

const kSoonMs = 1000; // events in this time cause one read
const kSavedMs = 3000; // after the last event

export class ReadAgain {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _newestMs = 0;

  /** `last`: no further read follows, unless there are new events. */
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
