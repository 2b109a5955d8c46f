// A row of buttons that scrolls fades at each end beyond which there is more of it.

import type { LitElement, ReactiveController } from "lit";

const kReachedPx = 2; // nearer to an end it is there: browsers round

/** Ends beyond which there is more, of what has `all` and shows `seen` of it from `at` on. */
export const hiddenEnds = (
  at: number,
  seen: number,
  all: number,
): { before: boolean; after: boolean } => ({
  before: at > kReachedPx,
  after: all - seen - at > kReachedPx,
});

/**
 * Follows how far an element is scrolled across, and marks it by the attributes `more-before` and
 * `more-after`: what they look like is its own.
 */
export class ScrollFade implements ReactiveController {
  private readonly _sized = new ResizeObserver(() => this.mark());

  constructor(private readonly _host: LitElement) {
    _host.addController(this);
  }

  hostConnected(): void {
    this._host.addEventListener("scroll", this.mark, { passive: true });
    this._sized.observe(this._host);
  }
  hostDisconnected(): void {
    this._host.removeEventListener("scroll", this.mark);
    this._sized.disconnect();
  }
  /** Buttons may have come or gone. */
  hostUpdated(): void {
    this.mark();
  }

  private readonly mark = (): void => {
    const { scrollLeft, clientWidth, scrollWidth } = this._host;
    const { before, after } = hiddenEnds(scrollLeft, clientWidth, scrollWidth);
    this._host.toggleAttribute("more-before", before);
    this._host.toggleAttribute("more-after", after);
  };
}
