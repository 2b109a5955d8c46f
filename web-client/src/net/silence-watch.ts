// Detects a dead network by the server's silence, because no event reports it. Before the
// connection is closed, the page sends a request to which the server always responds, since not
// every message has a response.

const kQuietMs = 10_000; // after this time without a due response, a liveness check is sent
const kSilenceMs = 10_000; // after this further time, the connection is dead

export interface SilenceHost {
  ask(): void;
  giveUp(): void;
}

export class SilenceWatch {
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _due = false; // the server must respond to a message

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

  /** Gives up after this time without a message from the server. */
  limit(silenceMs: number): void {
    this.after(silenceMs, () => this._host.giveUp());
  }

  /** Ends the wait, because the server sent a message or no response is expected. */
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
