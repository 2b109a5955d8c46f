// When to read anew what is told of before it is saved: soon after the first news, and once more
// when the last of them has surely been saved.

const kSoonMs = 1000; // what happens in one go is read once
const kSavedMs = 3000; // after the last of it

export class ReadAgain {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _newestMs = 0;

  /** `last`: nothing follows, unless there is more news. */
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
