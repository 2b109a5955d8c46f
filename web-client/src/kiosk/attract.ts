// The automatic loop of a tour. It shows the stops one after the other, each for its duration, with
// a single timer.

export interface AttractHost {
  /** Returns the durations of the transition to the current stop and of the display after it. */
  times(): { transition_s: number; attract_s: number } | null;
  next(): void;
}

const kLeastS = 1;

export class AttractLoop {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _playing = false;

  constructor(private readonly _host: AttractHost) {}

  get playing(): boolean {
    return this._playing;
  }

  start(): void {
    this.stop();
    this._playing = true;
    this.wait();
  }

  stop(): void {
    this._playing = false;
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }

  private wait(): void {
    const times = this._host.times();
    this._timer = setTimeout(
      () => this.onTime(),
      Math.max(kLeastS, times ? times.transition_s + times.attract_s : 0) * 1000,
    );
  }

  private onTime(): void {
    this._timer = null;
    this._host.next();
    if (this._playing) this.wait();
  }
}
