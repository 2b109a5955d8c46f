// <strata-past-overlay>: marks the 3D view while it shows a past state. While comparing, it shows
// the past state at the left of a divider and the newest state at its right.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { FrameCanvas } from "../../net/frame-canvas";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { toldTime } from "../../domain/times";
import { icon } from "../../ui/icons";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const words = texts.past;
const kKeyStep = 0.02;

@customElement("strata-past-overlay")
export class StrataPastOverlay extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @query("canvas") private _canvas!: HTMLCanvasElement | null;
  private _frames: FrameCanvas | null = null;
  private _drags = false;

  constructor() {
    super();
    followSession(this, "past");
  }

  static override styles = [
    sharedStyles,
    css`
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
      .frame {
        position: absolute;
        inset: 0;
        border: 4px solid var(--accent);
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
      .label.only {
        left: 50%;
        max-width: calc(100% - 1.5rem);
        transform: translateX(-50%);
      }
      .label.then {
        left: 0.75rem;
      }
      .label.now {
        right: 0.75rem;
        background: var(--calm);
        color: var(--calm-ink);
      }
      @media (max-width: 820px) {
        .label {
          top: 3.5rem; /* below the scale bar */
        }
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

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.hasUpdated) this.takeFrames();
  }
  override firstUpdated(): void {
    this.takeFrames();
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.session.past.onFrame = () => {};
  }

  private takeFrames(): void {
    this._frames = new FrameCanvas(this._canvas!, {
      drawn: (part) => this.session.thenDrawn(part),
      failed: (reason) => notices.show("problem", texts.problems.picture, reason),
    });
    this.session.past.onFrame = (part) => this._frames?.push(part);
  }

  override render(): TemplateResult {
    const { past } = this.session;
    const comparing = past.isActive && past.compares;
    const hasPicture = comparing && past.drawn !== null;
    const when = past.time === null ? words.before_first : words.state_of(toldTime(past.time));
    const share = past.divider * 100;
    return html`<canvas
        width="2"
        height="2"
        data-then=${hasPicture ? String(past.drawn) : nothing}
        ?hidden=${!hasPicture}
        ${styled({ "clip-path": `inset(0 ${100 - share}% 0 0)` })}
      ></canvas>
      ${
        comparing
          ? html`<span class="label then ellipsis">${when}</span>
            <span class="label now ellipsis">${words.now}</span>
            <div
              class="divider"
              role="slider"
              tabindex="0"
              aria-label=${words.divider}
              aria-valuemin="0"
              aria-valuemax="100"
              aria-valuenow=${Math.round(share)}
              ${styled({ left: `${share}%` })}
              @pointerdown=${this.onDown}
              @pointermove=${this.onMove}
              @pointerup=${this.onUp}
              @pointercancel=${this.onUp}
              @keydown=${this.onKey}
            >
              <span>${icon("swipe")}</span>
            </div>`
          : past.isActive
            ? html`<div class="frame"></div>
              <span class="label only ellipsis">${when}</span>`
            : nothing
      }`;
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
    if (width > 0) this.session.past.setDivider((event.clientX - left) / width);
  };
  private readonly onUp = (): void => {
    this._drags = false;
  };

  private readonly onKey = (event: KeyboardEvent): void => {
    const { past } = this.session;
    const step = event.shiftKey ? 5 * kKeyStep : kKeyStep;
    if (event.key === "ArrowLeft") past.setDivider(past.divider - step);
    else if (event.key === "ArrowRight") past.setDivider(past.divider + step);
    else if (event.key === "Home") past.setDivider(0);
    else if (event.key === "End") past.setDivider(1);
    else return;
    event.preventDefault();
  };
}
