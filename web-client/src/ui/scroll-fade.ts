// A row of buttons that scrolls fades at each end beyond which there is more of it.

import type { LitElement, ReactiveController } from "lit";

const kReached_px = 2; // nearer to an end it is there: browsers round

/** Ends beyond which there is more, of what has `all` and shows `seen` of it from `at` on. */
export const hidden_ends = (
  at: number,
  seen: number,
  all: number,
): { before: boolean; after: boolean } => ({
  before: at > kReached_px,
  after: all - seen - at > kReached_px,
});

/**
 * Follows how far an element is scrolled across, and marks it by the attributes `more-before` and
 * `more-after`: what they look like is its own.
 */
export class ScrollFade implements ReactiveController {
  private readonly sized_ = new ResizeObserver(() => this.mark());

  constructor(private readonly host_: LitElement) {
    host_.addController(this);
  }

  hostConnected(): void {
    this.host_.addEventListener("scroll", this.mark, { passive: true });
    this.sized_.observe(this.host_);
  }
  hostDisconnected(): void {
    this.host_.removeEventListener("scroll", this.mark);
    this.sized_.disconnect();
  }
  /** Buttons may have come or gone. */
  hostUpdated(): void {
    this.mark();
  }

  private readonly mark = (): void => {
    const { scrollLeft, clientWidth, scrollWidth } = this.host_;
    const { before, after } = hidden_ends(scrollLeft, clientWidth, scrollWidth);
    this.host_.toggleAttribute("more-before", before);
    this.host_.toggleAttribute("more-after", after);
  };
}
