// Whether somebody stands before the screen. After the tour's time without a touch they are asked,
// with a countdown, and when nobody answers the screen is alone: it begins anew and plays by itself
// until the next touch. One timer at most, whatever is touched how often.

/**
 * alone: nobody is there. visited: somebody is. asked: they have not touched for long, and `leftS`
 * seconds to say that they are there.
 */
export type Presence = { is: "alone" } | { is: "visited" } | { is: "asked"; leftS: number };

export interface IdleHost {
  /** Seconds without a touch before somebody is asked. */
  idleS(): number;
  /** Somebody came. */
  came(): void;
  /** Nobody is there any more. */
  left(): void;
  changed(): void;
}

export const kAskedS = 10;
const kLeastS = 30; // whatever the tour says: who reads touches nothing

export class IdleWatch {
  presence: Presence = { is: "alone" };
  private _touchedMs = 0;
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: IdleHost) {}

  /** Anything that a person does. */
  touched(): void {
    this._touchedMs = performance.now();
    const { is } = this.presence;
    if (is === "visited") return; // the timer sees when it fires that it is too early
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
