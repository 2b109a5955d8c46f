// A dead network does not report itself, so the server's silence is the signal. Before the
// connection is closed, the server gets a request that it always answers, since not every message
// has an answer.

const kQuietMs = 10_000; // an answer is due but none came: request a sign of life
const kSilenceMs = 10_000; // no sign of life: the connection is dead

export interface SilenceHost {
  ask(): void;
  giveUp(): void;
}

export class SilenceWatch {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _due = false; // a message was sent that the server answers

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

  /** Gives up after this time without a message. */
  limit(silenceMs: number): void {
    this.after(silenceMs, () => this._host.giveUp());
  }

  /** The server sent a message, or no answer is expected. */
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
