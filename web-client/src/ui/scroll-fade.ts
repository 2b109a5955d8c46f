// Fades a scrolling row of buttons at each end that has more content.

import type { LitElement, ReactiveController } from "lit";

const kReachedPx = 2; // tolerance at the ends, because browsers round

/**
 * Returns the ends with more content, for a row of length `all` with a visible part of length
 * `seen` that starts at `at`.
 */
export const hiddenEnds = (
  at: number,
  seen: number,
  all: number,
): { before: boolean; after: boolean } => ({
  before: at > kReachedPx,
  after: all - seen - at > kReachedPx,
});

/**
 * Tracks the horizontal scroll position of an element in the attributes `more-before` and
 * `more-after`. The element's own styles draw the fade.
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
  /** Updates the attributes, because the buttons may have changed. */
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
