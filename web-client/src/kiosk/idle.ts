// Whether somebody stands before the screen. After the tour's time without a touch they are asked,
// with a countdown, and when nobody answers the screen is alone: it begins anew and plays by itself
// until the next touch. One timer at most, whatever is touched how often.

/**
 * alone: nobody is there. visited: somebody is. asked: they have not touched for long, and `left_s`
 * seconds to say that they are there.
 */
export type Presence = { is: "alone" } | { is: "visited" } | { is: "asked"; left_s: number };

export interface IdleHost {
  /** Seconds without a touch before somebody is asked. */
  idle_s(): number;
  /** Somebody came. */
  came(): void;
  /** Nobody is there any more. */
  left(): void;
  changed(): void;
}

export const kAsked_s = 10;
const kLeast_s = 30; // whatever the tour says: who reads touches nothing

export class IdleWatch {
  presence: Presence = { is: "alone" };
  private touched_ms_ = 0;
  private timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly host_: IdleHost) {}

  /** Anything that a person does. */
  touched(): void {
    this.touched_ms_ = performance.now();
    const { is } = this.presence;
    if (is === "visited") return; // the timer sees when it fires that it is too early
    this.enter({ is: "visited" }, this.host_.idle_s());
    if (is === "alone") this.host_.came();
  }

  stop(): void {
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
  }

  private enter(presence: Presence, for_s: number): void {
    this.presence = presence;
    this.stop();
    if (presence.is !== "alone")
      this.timer_ = setTimeout(
        () => this.on_time(),
        Math.max(presence.is === "asked" ? 0 : kLeast_s, for_s) * 1000,
      );
    this.host_.changed();
  }

  private on_time(): void {
    this.timer_ = null;
    const { presence } = this;
    if (presence.is === "visited") {
      const left_s =
        Math.max(kLeast_s, this.host_.idle_s()) - (performance.now() - this.touched_ms_) / 1000;
      if (left_s > 0.05) this.timer_ = setTimeout(() => this.on_time(), left_s * 1000);
      else this.enter({ is: "asked", left_s: kAsked_s }, 1);
    } else if (presence.is === "asked" && presence.left_s > 1) {
      this.enter({ is: "asked", left_s: presence.left_s - 1 }, 1);
    } else if (presence.is === "asked") {
      this.enter({ is: "alone" }, 0);
      this.host_.left();
    }
  }
}
