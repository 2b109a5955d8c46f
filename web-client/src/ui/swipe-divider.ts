// <strata-swipe-divider>: a vertical divider between two pictures of the same size. The user drags
// it, or moves it with the keyboard. It covers the pictures, but receives only the pointer on the
// divider.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { icon } from "./icons";
import { shareAfter } from "./keyboard";
import { styled } from "./styled";
import { sharedStyles } from "./styles";

/**
 * The looks of a second picture over the stage, which is compared with the picture of the stage, and
 * of the labels that name both pictures.
 */
export const comparedStyles = css`
  :host {
    overflow: hidden;
    pointer-events: none;
  }
  canvas {
    position: absolute;
    inset: 0;
    width: 100%;
    height: 100%;
    object-fit: contain;
  }
  .label {
    position: absolute;
    top: 0.625rem;
    max-width: calc(50% - 1.5rem);
    padding: var(--space-1) var(--space-3);
    border-radius: var(--radius-round);
    background: var(--accent);
    color: var(--accent-ink);
    font-size: var(--text-small);
    font-weight: 600;
  }
  /* The label of the picture of the stage. */
  .label.open {
    background: var(--calm);
    color: var(--calm-ink);
  }
  .label.left {
    left: 0.75rem;
  }
  .label.right {
    right: 0.75rem;
  }
`;

@customElement("strata-swipe-divider")
export class StrataSwipeDivider extends LitElement {
  @property() label = "";
  /** The share of the width at the left of the divider. The event `divide` requests another one. */
  @property({ attribute: false }) share = 0.5;
  private _drags = false;

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        inset: 0;
        pointer-events: none;
      }
      .divider {
        position: absolute;
        top: 0;
        bottom: 0;
        width: 2.75rem;
        transform: translateX(-50%);
        cursor: ew-resize;
        pointer-events: auto;
        touch-action: none;
      }
      .divider::before {
        content: "";
        position: absolute;
        top: 0;
        bottom: 0;
        left: 50%;
        width: 3px;
        transform: translateX(-50%);
        background: var(--mark-light);
        box-shadow: 0 0 0 1px var(--mark-dark);
      }
      .divider span {
        position: absolute;
        top: 50%;
        left: 50%;
        display: grid;
        place-items: center;
        width: 2.25rem;
        height: 2.25rem;
        border-radius: 50%;
        background: var(--accent);
        color: var(--accent-ink);
        transform: translate(-50%, -50%);
        box-shadow: var(--shadow);
      }
    `,
  ];

  override render(): TemplateResult {
    const percent = this.share * 100;
    return html`<div
      class="divider"
      role="slider"
      tabindex="0"
      aria-label=${this.label}
      aria-valuemin="0"
      aria-valuemax="100"
      aria-valuenow=${Math.round(percent)}
      ${styled({ left: `${percent}%` })}
      @pointerdown=${this.onDown}
      @pointermove=${this.onMove}
      @pointerup=${this.onUp}
      @pointercancel=${this.onUp}
      @keydown=${this.onKey}
    >
      <span>${icon("swipe")}</span>
    </div>`;
  }

  private divide(share: number): void {
    const detail = Math.min(1, Math.max(0, share));
    this.dispatchEvent(new CustomEvent<number>("divide", { detail }));
  }

  private readonly onDown = (event: PointerEvent): void => {
    if (event.button !== 0) return;
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    this._drags = true;
    event.stopPropagation();
  };
  private readonly onMove = (event: PointerEvent): void => {
    if (!this._drags) return;
    const { left, width } = this.getBoundingClientRect();
    if (width > 0) this.divide((event.clientX - left) / width);
  };
  private readonly onUp = (): void => {
    this._drags = false;
  };

  private readonly onKey = (event: KeyboardEvent): void => {
    const share = shareAfter(event, this.share);
    if (share === null) return;
    this.divide(share);
    event.preventDefault();
  };
}
