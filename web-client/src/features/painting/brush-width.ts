// <strata-brush-width>: the width of the brush, on the screen or on the object.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { readNumber, typedNumber } from "../../core/locale";
import { formatLength, formatNumber } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { kWidths, type WidthUnit } from "./brush-settings";

const kSliderSteps = 1000;

@customElement("strata-brush-width")
export class StrataBrushWidth extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "view");
  }

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-3);
      }
      .width {
        display: grid;
        grid-template-columns: 1fr 5.75rem;
        align-items: center;
        gap: var(--space-2) var(--space-3);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const { unit, width } = session.painting.brush;
    const range = kWidths[unit];
    const now = width[unit];
    const slider = (kSliderSteps * Math.log(now / range.min)) / Math.log(range.max / range.min);
    return html`<div class="width">
        <span class="caption">${texts.brush.width}</span><span></span>
        <input
          type="range"
          min="0"
          max=${kSliderSteps}
          .value=${String(Math.round(slider))}
          aria-label=${texts.brush.width}
          aria-valuetext="${formatNumber(now)} ${unit}"
          @input=${(event: Event) => {
            const share = Number((event.target as HTMLInputElement).value) / kSliderSteps;
            const value = range.min * Math.pow(range.max / range.min, share);
            this.setWidth(unit, unit === "px" ? Math.round(value) : Number(value.toPrecision(2)));
          }}
        />
        <span class="number">
          ${numberInput({
            label: `${texts.brush.width}, ${unit}`,
            value: now,
            ...range,
            changed: (text, input) => {
              this.setWidth(unit, readNumber(text));
              input.value = typedNumber(this.session.painting.brush.width[unit]);
            },
          })}
          <span>${unit === "px" ? texts.brush.width_px : texts.brush.width_mm}</span>
        </span>
      </div>
      <p class="hint">${this.equivalent(unit)}</p>
      <div class="pair">
        ${radioGroup<WidthUnit>({
          label: texts.brush.fixed_on,
          class: "segments",
          choices: [
            { value: "px", content: texts.brush.on_screen },
            { value: "mm", content: texts.brush.on_object },
          ],
          chosen: unit,
          choose: (chosen) => this.setUnit(chosen),
        })}
      </div>`;
  }

  /** Returns the width in the other unit, on the surface under the pointer. */
  private equivalent(unit: WidthUnit): string {
    const { session } = this;
    if (!session.model) return "";
    const radiusPx = session.painting.radiusWindowPx();
    if (unit === "mm")
      return `≈ ${formatNumber((2 * radiusPx) / session.view.scale, 2)} ${texts.brush.width_px} ${texts.brush.on_screen}`;
    const metres = session.painting.widthMetres();
    return `≈ ${formatLength(metres)} ${texts.brush.on_object}`;
  }

  /** Changes the unit, and keeps the brush's current width on the screen. */
  private setUnit(unit: WidthUnit): void {
    const { session } = this;
    if (session.painting.brush.unit === unit || !session.model) return;
    const radiusPx = session.painting.radiusWindowPx();
    const mm = session.painting.widthMetres() * 1000;
    session.painting.setBrush((brush) => {
      brush.unit = unit;
      if (unit === "mm") brush.setWidth("mm", Number(mm.toPrecision(2)));
      else brush.setWidth("px", Math.round((2 * radiusPx) / session.view.scale));
    });
  }

  private setWidth(unit: WidthUnit, width: number): void {
    this.session.painting.setBrush((brush) => brush.setWidth(unit, width));
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-brush-width": StrataBrushWidth;
  }
}
