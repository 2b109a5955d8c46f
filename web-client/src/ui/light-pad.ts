// <strata-light-pad>: a round pad with a handle that sets the direction of raking light. The user
// drags the handle or presses the arrow keys.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { anglesOf, directionOf, onPad, padPoint, type PadPoint } from "../math/light";
import type { Point3 } from "../core/protocol.gen";
import { sharedStyles } from "./styles";
import { styled } from "./styled";
import { texts } from "../texts";

const kKeyStep = 0.08;
const kKeys: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

@customElement("strata-light-pad")
export class StrataLightPad extends LitElement {
  @property({ attribute: false }) direction: Point3 = [0, 0, 1];
  @query(".pad") private _pad!: HTMLElement;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: 7rem 1fr;
        align-items: center;
        gap: var(--space-3);
      }
      .pad {
        position: relative;
        width: 7rem;
        height: 7rem;
        border: var(--edge) solid var(--line-strong);
        border-radius: 50%;
        background: radial-gradient(circle at var(--x) var(--y), var(--ball-lit) 0, var(--ball-bright) 30%, var(--ball-dim) 72%, var(--ball-dark) 100%);
        cursor: crosshair;
        touch-action: none;
      }
      .pad::before {
        content: "";
        position: absolute;
        inset: 26%;
        border: 1px dashed var(--ball-rim);
        border-radius: 50%;
      }
      .handle {
        position: absolute;
        left: var(--x);
        top: var(--y);
        width: 1.25rem;
        height: 1.25rem;
        margin: calc(-1 * var(--space-2)) 0 0 calc(-1 * var(--space-2));
        border: 2px solid var(--mark-light);
        border-radius: 50%;
        background: var(--accent);
        box-shadow: 0 1px 4px var(--mark-shadow);
        pointer-events: none;
      }
      @media (pointer: coarse) {
        :host {
          grid-template-columns: 8.5rem 1fr;
        }
        .pad {
          width: 8.5rem;
          height: 8.5rem;
        }
        .handle {
          width: 1.75rem;
          height: 1.75rem;
          margin: calc(-1 * var(--space-3)) 0 0 calc(-1 * var(--space-3));
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const point = padPoint(this.direction);
    const { from, above } = anglesOf(point);
    const place = { "--x": `${50 + 50 * point.x}%`, "--y": `${50 - 50 * point.y}%` };
    return html`<div
        class="pad"
        role="slider"
        tabindex="0"
        aria-label=${texts.view.light_direction}
        aria-valuemin="0"
        aria-valuemax="360"
        aria-valuenow=${from}
        aria-valuetext=${texts.view.light_from(from, above)}
        ${styled(place)}
        @pointerdown=${this.onDown}
        @keydown=${this.onKey}
      >
        <span class="handle"></span>
      </div>
      <p class="hint">${texts.view.light_pad_hint}<br /><span>${texts.view.light_from(from, above)}</span></p>`;
  }

  private choose(point: PadPoint): void {
    this.direction = directionOf(point);
    this.dispatchEvent(new CustomEvent<Point3>("direction", { detail: this.direction }));
  }

  private onDown(event: PointerEvent): void {
    const pad = this._pad;
    pad.setPointerCapture(event.pointerId);
    const move = (moved: PointerEvent): void => {
      const box = pad.getBoundingClientRect();
      this.choose({
        x: ((moved.clientX - box.left) / box.width) * 2 - 1,
        y: 1 - ((moved.clientY - box.top) / box.height) * 2,
      });
    };
    const up = (): void => {
      pad.removeEventListener("pointermove", move);
      pad.removeEventListener("pointerup", up);
      pad.removeEventListener("pointercancel", up);
    };
    pad.addEventListener("pointermove", move);
    pad.addEventListener("pointerup", up);
    pad.addEventListener("pointercancel", up);
    move(event);
  }

  private onKey(event: KeyboardEvent): void {
    const step = kKeys[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const { x, y } = padPoint(this.direction);
    this.choose(onPad({ x: x + step[0] * kKeyStep, y: y + step[1] * kKeyStep }));
  }
}
