// The tour that plays by itself: a stop after the other, each for its time. One timer.

export interface AttractHost {
  /** Of the stop that is seen: how long until it stands still, and how long it is shown then. */
  times(): { transition_s: number; attract_s: number } | null;
  next(): void;
}

const kLeast_s = 1;

export class AttractLoop {
  private timer_: ReturnType<typeof setTimeout> | null = null;
  private playing_ = false;

  constructor(private readonly host_: AttractHost) {}

  get playing(): boolean {
    return this.playing_;
  }

  start(): void {
    this.stop();
    this.playing_ = true;
    this.wait();
  }

  stop(): void {
    this.playing_ = false;
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
  }

  private wait(): void {
    const times = this.host_.times();
    this.timer_ = setTimeout(
      () => this.on_time(),
      Math.max(kLeast_s, times ? times.transition_s + times.attract_s : 0) * 1000,
    );
  }

  private on_time(): void {
    this.timer_ = null;
    this.host_.next();
    if (this.playing_) this.wait();
  }
}
