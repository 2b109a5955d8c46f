// A bar between two parts of a window. The user sets the size of one part by dragging the bar or
// with the arrow keys. The browser stores the size.

import { html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";

const kStep = 20; // change by an arrow key

export interface SplitterOptions {
  label: string;
  /** The key of the stored size. */
  key: string;
  first: number;
  least: number;
  most(): number;
  /** The largest size, for screen readers. */
  largest?: number;
  /**
   * Whether the bar is horizontal with its part below. Otherwise it is vertical with its part on
   * the right.
   */
  isAcross?: boolean;
  /** Returns the size of the part if the bar is at the pointer. */
  sizeAt(pointer: PointerEvent): number;
}

export class Splitter {
  size: number;

  constructor(
    private readonly _host: ReactiveControllerHost,
    private readonly _options: SplitterOptions,
  ) {
    this.size = Number(localStorage.getItem(_options.key)) || _options.first;
  }

  resize(size: number): void {
    const { key, least, most } = this._options;
    this.size = Math.round(Math.min(most(), Math.max(least, size)));
    localStorage.setItem(key, String(this.size));
    this._host.requestUpdate();
  }

  render(): TemplateResult {
    const { label, least, largest, isAcross } = this._options;
    return html`<div
      class="splitter ${isAcross ? "across" : ""}"
      role="separator"
      aria-orientation=${isAcross ? "horizontal" : "vertical"}
      aria-label=${label}
      aria-valuenow=${this.size}
      aria-valuemin=${least}
      aria-valuemax=${largest ?? nothing}
      tabindex="0"
      @pointerdown=${this.onPointerDown}
      @keydown=${this.onKey}
    ></div>`;
  }

  private readonly onPointerDown = (event: PointerEvent): void => {
    const bar = event.currentTarget as HTMLElement;
    const move = (at: PointerEvent): void => this.resize(this._options.sizeAt(at));
    bar.setPointerCapture(event.pointerId);
    bar.addEventListener("pointermove", move);
    bar.addEventListener("lostpointercapture", () => bar.removeEventListener("pointermove", move), {
      once: true,
    });
  };

  private readonly onKey = (event: KeyboardEvent): void => {
    const [more, less] = this._options.isAcross
      ? ["ArrowUp", "ArrowDown"]
      : ["ArrowLeft", "ArrowRight"];
    const step = event.key === more ? kStep : event.key === less ? -kStep : 0;
    if (step === 0) return;
    event.preventDefault();
    this.resize(this.size + step);
  };
}
