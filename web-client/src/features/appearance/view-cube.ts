// <strata-view-cube>: a cube that shows the viewing direction. Its faces select the standard views,
// and dragging it orbits the camera. Its only Tab stop is the face towards the viewer. The arrow
// keys move to the neighboring views.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import type { StandardView } from "../../math/camera";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { kStandardViews, neighborView, standardViewOf, viewTowards } from "../../math/view-cube";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const kDragSpeed = 4; // pixels of the 3D view per pixel of the cube
const kClickPx = 4; // the largest movement of the pointer during a click

@customElement("strata-view-cube")
export class StrataViewCube extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  private _drag: { x: number; y: number; moved: boolean } | null = null;

  constructor() {
    super();
    followSession(this, "view");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        --side: 3.25rem;
        display: block;
      }
      .room {
        display: grid;
        place-items: center;
        width: calc(var(--side) * 1.6);
        height: calc(var(--side) * 1.6);
        perspective: calc(var(--side) * 6);
        touch-action: none;
        cursor: grab;
      }
      .cube {
        position: relative;
        width: var(--side);
        height: var(--side);
        transform-style: preserve-3d;
        pointer-events: none; /* this element's plane lies between the faces */
      }
      button {
        pointer-events: auto;
        position: absolute;
        inset: 0;
        min-height: 0;
        padding: 0;
        border: 1px solid var(--line-strong);
        border-radius: var(--radius-tiny);
        background: var(--raised);
        color: var(--ink);
        font-size: var(--text-tiny);
        font-weight: 600;
        backface-visibility: hidden;
        transition: background var(--fast);
      }
      button:hover:not(:disabled) {
        background: var(--accent-soft);
        border-color: var(--accent);
      }
      button[aria-checked="true"] {
        background: var(--accent);
        border-color: var(--accent);
        color: var(--accent-ink);
      }
      button:focus-visible {
        outline-offset: -3px;
      }
      [data-view="front"] {
        transform: translateZ(calc(var(--side) / 2));
      }
      [data-view="right"] {
        transform: rotateY(90deg) translateZ(calc(var(--side) / 2));
      }
      [data-view="back"] {
        transform: rotateY(180deg) translateZ(calc(var(--side) / 2));
      }
      [data-view="left"] {
        transform: rotateY(-90deg) translateZ(calc(var(--side) / 2));
      }
      [data-view="top"] {
        transform: rotateX(90deg) translateZ(calc(var(--side) / 2));
      }
      [data-view="bottom"] {
        transform: rotateX(-90deg) translateZ(calc(var(--side) / 2));
      }
      @media (max-width: 820px) {
        :host {
          --side: 2.75rem;
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { camera } = this.session.view;
    const { azimuth, elevation } = camera;
    const [chosen, stop] = [standardViewOf(camera), viewTowards(camera)];
    return html`<div
      class="room"
      role="radiogroup"
      aria-label=${texts.picture_bar.cube}
      @keydown=${this.onKey}
      @pointerdown=${this.onDown}
      @pointermove=${this.onMove}
      @pointerup=${this.onUp}
      @pointercancel=${this.onUp}
      @click=${{ handleEvent: this.onClick, capture: true }}
    >
      <div class="cube" ${styled({ transform: `rotateX(${-elevation}rad) rotateY(${-azimuth}rad)` })}>
        ${kStandardViews.map(
          (view, index) =>
            html`<button
              type="button"
              role="radio"
              aria-checked=${view === chosen}
              tabindex=${view === stop ? 0 : -1}
              data-view=${view}
              title="${texts.views[view]} (${index + 1})"
              @click=${() => this.session.view.flyToStandard(view)}
            >
              ${texts.views[view]}
            </button>`,
        )}
      </div>
    </div>`;
  }

  private onKey(event: KeyboardEvent): void {
    const at = (event.target as HTMLElement).dataset["view"] as StandardView | undefined;
    const to = at && neighborView(at, event.key);
    if (!to) return;
    event.preventDefault();
    this.session.view.flyToStandard(to);
    this.renderRoot.querySelector<HTMLElement>(`[data-view="${to}"]`)?.focus();
  }

  private onDown(event: PointerEvent): void {
    this._drag = { x: event.clientX, y: event.clientY, moved: false };
  }

  private onMove(event: PointerEvent): void {
    const { _drag: drag } = this;
    if (!drag) return;
    const [dx, dy] = [event.clientX - drag.x, event.clientY - drag.y];
    if (!drag.moved && Math.hypot(dx, dy) < kClickPx) return;
    if (!drag.moved) (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    this._drag = { x: event.clientX, y: event.clientY, moved: true };
    const scale = kDragSpeed * this.session.view.scale;
    this.session.view.orbitPixels(dx * scale, dy * scale);
  }

  private onUp(): void {
    if (!this._drag?.moved)
      this._drag = null; // after a drag, onClick() resets it
    else setTimeout(() => (this._drag = null));
  }

  private readonly onClick = (event: Event): void => {
    if (this._drag?.moved) event.stopPropagation(); // a drag that rotated the model is not a click
    this._drag = null;
  };
}
