// <strata-past-overlay>: marks the 3D view while it shows a past state. While comparing, it shows
// the past state at the left of a divider and the newest state at its right.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { FrameCanvas } from "../../net/frame-canvas";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { toldTime } from "../../domain/times";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { comparedStyles } from "../../ui/swipe-divider";
import { texts } from "../../texts";

const words = texts.past;

@customElement("strata-past-overlay")
export class StrataPastOverlay extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @query("canvas") private _canvas!: HTMLCanvasElement | null;
  private _frames: FrameCanvas | null = null;

  constructor() {
    super();
    followSession(this, "past");
  }

  static override styles = [
    sharedStyles,
    comparedStyles,
    css`
      .frame {
        position: absolute;
        inset: 0;
        border: 4px solid var(--accent);
      }
      .label.only {
        left: 50%;
        max-width: calc(100% - 1.5rem);
        transform: translateX(-50%);
      }
      @media (max-width: 820px) {
        .label {
          top: 3.5rem; /* below the scale bar */
        }
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
          ? html`<span class="label left ellipsis">${when}</span>
            <span class="label right open ellipsis">${words.now}</span>
            <strata-swipe-divider
              label=${words.divider}
              .share=${past.divider}
              @divide=${({ detail }: CustomEvent<number>) => past.setDivider(detail)}
            ></strata-swipe-divider>`
          : past.isActive
            ? html`<div class="frame"></div>
              <span class="label only ellipsis">${when}</span>`
            : nothing
      }`;
  }
}
