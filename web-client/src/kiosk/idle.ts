// Detects whether a visitor uses the screen. After the tour's idle time without a touch, the page
// asks a question with a countdown. If the visitor does not respond, the tour restarts and plays
// automatically until the next touch. Uses at most one timer, regardless of the number of touches.

/**
 * alone: no visitor is present. visited: a visitor is present. asked: the idle time has passed
 * without a touch, and the visitor has `leftS` seconds to respond.
 */
export type Presence = { is: "alone" } | { is: "visited" } | { is: "asked"; leftS: number };

export interface IdleHost {
  /** The number of seconds without a touch before the question. */
  idleS(): number;
  /** A visitor has arrived. */
  came(): void;
  /** The visitor has left. */
  left(): void;
  changed(): void;
}

export const kAskedS = 10;
const kLeastS = 30; // minimum for all tours, since visitors who read do not touch the screen

export class IdleWatch {
  presence: Presence = { is: "alone" };
  private _touchedMs = 0;
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: IdleHost) {}

  /** Call this for each action of a visitor. */
  touched(): void {
    this._touchedMs = performance.now();
    const { is } = this.presence;
    if (is === "visited") return; // the timer reads `_touchedMs` when it fires
    this.enter({ is: "visited" }, this._host.idleS());
    if (is === "alone") this._host.came();
  }

  stop(): void {
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }

  private enter(presence: Presence, forS: number): void {
    this.presence = presence;
    this.stop();
    if (presence.is !== "alone")
      this._timer = setTimeout(
        () => this.onTime(),
        Math.max(presence.is === "asked" ? 0 : kLeastS, forS) * 1000,
      );
    this._host.changed();
  }

  private onTime(): void {
    this._timer = null;
    const { presence } = this;
    if (presence.is === "visited") {
      const leftS =
        Math.max(kLeastS, this._host.idleS()) - (performance.now() - this._touchedMs) / 1000;
      if (leftS > 0.05) this._timer = setTimeout(() => this.onTime(), leftS * 1000);
      else this.enter({ is: "asked", leftS: kAskedS }, 1);
    } else if (presence.is === "asked" && presence.leftS > 1) {
      this.enter({ is: "asked", leftS: presence.leftS - 1 }, 1);
    } else if (presence.is === "asked") {
      this.enter({ is: "alone" }, 0);
      this._host.left();
    }
  }
}
