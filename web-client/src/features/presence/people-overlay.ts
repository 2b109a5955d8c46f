// <strata-people-overlay>: the pointers of other participants over the 3D view. Mouse events pass
// through it. While the pointers move, only this element is rendered again, not the page.

import { css, html, LitElement, svg, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { inkOn } from "../../domain/people-here";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import type { PersonCursor } from "./people-cursors";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { nameOf } from "./together";

const kLeastRadiusPx = 4; // a smaller brush appears as a pointer
const kRoomForNamePx = 150;

@customElement("strata-people-overlay")
export class StrataPeopleOverlay extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  private _next = 0; // id of requestAnimationFrame; 0 if no request is pending

  constructor() {
    super();
    followSession(this, "together", "view");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        inset: 0;
        overflow: hidden;
        pointer-events: none;
      }
      .person {
        position: absolute;
        left: 0;
        top: 0;
        transition: opacity var(--slow);
      }
      .person.hidden {
        opacity: 0;
        transition: opacity var(--fast);
      }
      .person.faded {
        opacity: 0;
        transition: opacity 1500ms;
      }
      svg {
        position: absolute;
        overflow: visible;
        width: 18px;
        height: 18px;
        filter: drop-shadow(0 1px 1px var(--mark-shadow));
      }
      b {
        position: absolute;
        left: 12px;
        top: 15px;
        max-width: 140px;
        padding: var(--space-half) var(--space-2);
        border-radius: var(--radius-round);
        font-size: var(--text-tiny);
        font-weight: 600;
        line-height: 1.35;
        box-shadow: 0 1px 3px var(--mark-shadow);
      }
      .leftwards b {
        left: auto;
        right: 4px;
      }
      @media (prefers-reduced-motion: reduce) {
        .person {
          transition: none !important;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    // the page's header lists the participants for screen readers
    this.setAttribute("aria-hidden", "true");
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    if (this._next) cancelAnimationFrame(this._next);
    this._next = 0;
  }

  override willUpdate(): void {
    this.session.cursors.onChange = () => this.requestUpdate();
  }

  override render(): TemplateResult {
    return html`${repeat(
      this.session.cursors.now(),
      ({ viewer }) => viewer.session,
      (cursor) => this.person(cursor),
    )}`;
  }

  override updated(): void {
    if (this._next || !this.session.cursors.gliding) return;
    this._next = requestAnimationFrame(() => {
      this._next = 0;
      this.requestUpdate();
    });
  }

  private person({ viewer, x, y, radius, hidden, faded }: PersonCursor): TemplateResult {
    const { color } = viewer;
    const leftwards = x > this.clientWidth - kRoomForNamePx && x > kRoomForNamePx;
    const classes = [
      "person",
      leftwards ? "leftwards" : "",
      hidden ? "hidden" : "",
      faded ? "faded" : "",
    ].join(" ");
    const brush = radius !== null && radius >= kLeastRadiusPx;
    const beside = brush ? Math.min(radius, 40) * 0.7 : 0; // the name is at the edge of the brush
    return html`<div class=${classes} data-session=${viewer.session} ${styled({ transform: `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)` })}>
      <svg>
        ${
          brush
            ? svg`<circle r=${radius} fill=${color} fill-opacity="0.14" stroke="var(--mark-light)" stroke-width="3.6" />
              <circle r=${radius} fill="none" stroke=${color} stroke-width="2" /><circle r="1.8" fill=${color} stroke="var(--mark-light)" stroke-width="0.8" />`
            : svg`<path d="M0 0l5.2 14.5 2.4-6.1 6.3-2.200z" fill=${color} stroke="var(--mark-light)" stroke-width="1.3" />`
        }
      </svg>
      <b class="ellipsis" ${styled({ background: color, color: inkOn(color), transform: brush ? `translate(${leftwards ? -beside : beside}px, ${beside - 8}px)` : null })}
        >${nameOf(viewer)}</b
      >
    </div>`;
  }
}
