// When to read anew what is told of before it is saved: soon after the first news, and once more
// when the last of them has surely been saved.

const kSoon_ms = 1000; // what happens in one go is read once
const kSaved_ms = 3000; // after the last of it

export class ReadAgain {
  private timer_: ReturnType<typeof setTimeout> | null = null;
  private newest_ms_ = 0;

  /** `last`: nothing follows, unless there is more news. */
  constructor(private readonly read_: (last: boolean) => void) {}

  news(): void {
    this.newest_ms_ = performance.now();
    this.timer_ ??= setTimeout(this.look_, kSoon_ms);
  }

  stop(): void {
    if (this.timer_ !== null) clearTimeout(this.timer_);
    this.timer_ = null;
  }

  private readonly look_ = (): void => {
    const left_ms = this.newest_ms_ + kSaved_ms - performance.now();
    this.timer_ = left_ms > 0 ? setTimeout(this.look_, left_ms) : null;
    this.read_(left_ms <= 0);
  };
}
