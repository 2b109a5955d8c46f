// A dead network does not say so: the server's silence must. Before the connection is given up, the
// server is asked something that it always answers, because not everything that is sent brings an
// answer of its own.

const kQuietMs = 10_000; // an answer is due but nothing came: ask for a sign of life
const kSilenceMs = 10_000; // nor came one: the connection is dead

export interface SilenceHost {
  ask(): void;
  giveUp(): void;
}

export class SilenceWatch {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _due = false; // something was sent that the server answers

  constructor(private readonly _host: SilenceHost) {}

  expectAnswer(): void {
    if (this._due) return;
    this._due = true;
    this.after(kQuietMs, () => this.askNow());
  }

  askNow(): void {
    this._due = true;
    this.after(kSilenceMs, () => this._host.giveUp());
    this._host.ask();
  }

  /** Gives up after so long without a word. */
  limit(silenceMs: number): void {
    this.after(silenceMs, () => this._host.giveUp());
  }

  /** The server said something, or nobody waits for it any more. */
  heard(): void {
    this._due = false;
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }

  private after(ms: number, action: () => void): void {
    if (this._timer) clearTimeout(this._timer);
    this._timer = setTimeout(action, ms);
  }
}
