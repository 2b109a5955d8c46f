// <strata-brush-panel>: what the brush paints in the selected layer, and how wide.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { format_length, format_number } from "../core/measure";
import { css_color, purpose_of } from "../core/palette";
import type { Layer } from "../core/types";
import { describe_value, kWidths, value_problem, type WidthUnit } from "./brush-settings";
import { ask } from "./dialog";
import { icon } from "./icons";
import type { ModelSession } from "./model-session";
import { radio_group } from "./radio-group";
import { styled } from "./styled";
import { shared_styles } from "./styles";
import { texts } from "./texts";

const kSliderSteps = 1000;

@customElement("strata-brush-panel")
export class StrataBrushPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private wrong_value_ = "";
  private unsubscribe_: (() => void) | null = null;

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        gap: 13px;
      }
      h2 {
        font-size: 1.08rem;
      }
      .width {
        display: grid;
        grid-template-columns: 1fr 92px;
        align-items: center;
        gap: 8px 12px;
      }
      .number {
        position: relative;
      }
      .number input {
        padding-right: 34px;
        text-align: right;
      }
      .number span {
        position: absolute;
        right: 10px;
        top: 50%;
        transform: translateY(-50%);
        color: var(--ink-soft);
        font-size: 0.85rem;
        pointer-events: none;
      }
      .pair {
        display: flex;
        flex-wrap: wrap;
        gap: 10px;
      }
      .pair .segments {
        flex: 1 1 auto;
      }
      .classes {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(118px, 1fr));
        gap: 6px;
        max-height: 208px;
        overflow: auto;
        padding: 2px;
        margin: -2px;
      }
      .classes button {
        justify-content: flex-start;
        min-width: 0;
        padding: 0 10px;
      }
      .classes button[aria-checked="true"] {
        border-color: var(--accent);
        box-shadow: inset 0 0 0 1px var(--accent);
        font-weight: 600;
      }
      .line {
        display: flex;
        align-items: center;
        gap: 9px;
        min-width: 0;
      }
      .value {
        display: grid;
        gap: 6px;
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("session")) return;
    this.unsubscribe_?.();
    this.unsubscribe_ = this.session.subscribe(() => this.requestUpdate());
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unsubscribe_?.();
  }

  override render(): TemplateResult {
    const { session } = this;
    const layer = session.layers.selected;
    const erases = session.tools.active === "eraser";
    if (!layer) return html`<p class="hint">${texts.brush.no_layer}</p>`;
    return html`<h2>${erases ? texts.brush.eraser_title : texts.brush.title}</h2>
      ${erases ? html`<p class="hint">${texts.brush.erases(layer.name)}</p>` : this.value(layer)} ${this.width()}
      ${erases
        ? nothing
        : html`<button class="quiet" @click=${() => void this.fill(layer)}>${icon("drop")}${texts.brush.fill}</button>`}`;
  }

  private value(layer: Layer): TemplateResult {
    const value = this.session.painting.brush.value_of(layer);
    const purpose = purpose_of(layer);
    const { points } = layer.palette;
    if (purpose === "presence") {
      return html`<div class="line">
        <span class="swatch" ${styled({ background: css_color(points[0]!.color) })}></span>
        <span class="ellipsis">${texts.brush.paints(describe_value(layer, value))}</span>
      </div>`;
    }
    if (purpose === "classes" && points.length > 0) {
      return radio_group({
        label: texts.brush.class,
        class: "classes",
        choices: points.map(({ at, color }) => ({
          value: at,
          content: html`<span class="swatch" ${styled({ background: css_color(color) })}></span>
            <span class="ellipsis">${describe_value(layer, at)}</span>`,
          title: describe_value(layer, at),
        })),
        chosen: value,
        choose: (at) => this.set_value(layer, at),
      });
    }
    const steps = layer.type.startsWith("f") ? "any" : "1";
    return html`<div class="value">
      <label class="field">
        <span>${purpose === "records" ? texts.brush.record : texts.brush.value}</span>
        <span class="number">
          <input
            type="number"
            step=${steps}
            .value=${String(value)}
            aria-invalid=${this.wrong_value_ ? "true" : "false"}
            @change=${(event: Event) => this.on_value(layer, event)}
          />
          <span>${layer.unit}</span>
        </span>
      </label>
      ${purpose === "measurement"
        ? html`<input
            type="range"
            min=${layer.palette.min}
            max=${layer.palette.max}
            step=${steps === "any" ? (layer.palette.max - layer.palette.min) / 200 : 1}
            .value=${String(value)}
            aria-label=${texts.brush.value}
            @input=${(event: Event) => this.on_value(layer, event)}
          />`
        : nothing}
      ${this.wrong_value_ ? html`<p class="error" role="alert">${this.wrong_value_}</p>` : nothing}
    </div>`;
  }

  private width(): TemplateResult {
    const { session } = this;
    const { unit, width, shape } = session.painting.brush;
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
          aria-valuetext="${format_number(now)} ${unit}"
          @input=${(event: Event) => {
            const share = Number((event.target as HTMLInputElement).value) / kSliderSteps;
            const value = range.min * Math.pow(range.max / range.min, share);
            this.set_width(unit, unit === "px" ? Math.round(value) : Number(value.toPrecision(2)));
          }}
        />
        <span class="number">
          <input
            type="number"
            min=${range.min}
            max=${range.max}
            step="any"
            .value=${String(now)}
            aria-label="${texts.brush.width}, ${unit}"
            @change=${(event: Event) => this.set_width(unit, Number((event.target as HTMLInputElement).value))}
          />
          <span>${unit === "px" ? texts.brush.width_px : texts.brush.width_mm}</span>
        </span>
      </div>
      <p class="hint numeric">${this.equivalent(unit)}</p>
      <div class="pair">
        ${radio_group<WidthUnit>({
          label: texts.brush.fixed_on,
          class: "segments",
          choices: [
            { value: "px", content: texts.brush.on_screen },
            { value: "mm", content: texts.brush.on_object },
          ],
          chosen: unit,
          choose: (chosen) => this.set_unit(chosen),
        })}
        ${radio_group<typeof shape>({
          label: texts.brush.shape,
          class: "segments",
          choices: [
            { value: "disc", content: texts.brush.disc },
            { value: "square", content: texts.brush.square },
          ],
          chosen: shape,
          choose: (chosen) => session.painting.set_brush((brush) => (brush.shape = chosen)),
        })}
      </div>`;
  }

  /** The width in the other unit, at the surface under the pointer. */
  private equivalent(unit: WidthUnit): string {
    const { session } = this;
    if (!session.model) return "";
    const radius_px = session.painting.radius_window_px();
    if (unit === "mm") return `≈ ${format_number((2 * radius_px) / session.view.scale, 2)} ${texts.brush.width_px} ${texts.brush.on_screen}`;
    const metres = session.painting.width_metres();
    return `≈ ${format_length(metres)} ${texts.brush.on_object}`;
  }

  /** Keeps the brush as wide as it looks now. */
  private set_unit(unit: WidthUnit): void {
    const { session } = this;
    if (session.painting.brush.unit === unit || !session.model) return;
    const radius_px = session.painting.radius_window_px();
    const mm = session.painting.width_metres() * 1000;
    session.painting.set_brush((brush) => {
      brush.unit = unit;
      if (unit === "mm") brush.set_width("mm", Number(mm.toPrecision(2)));
      else brush.set_width("px", Math.round((2 * radius_px) / session.view.scale));
    });
  }

  private set_width(unit: WidthUnit, width: number): void {
    this.session.painting.set_brush((brush) => brush.set_width(unit, width));
  }

  private set_value(layer: Layer, value: number): void {
    this.session.painting.set_brush((brush) => brush.set_value(layer, value));
  }

  private on_value(layer: Layer, event: Event): void {
    const typed = (event.target as HTMLInputElement).value.trim();
    const number = typed === "" ? Number.NaN : Number(typed);
    const value = layer.type.startsWith("f") ? Number(number.toPrecision(6)) : number;
    this.wrong_value_ = value_problem(layer, value) ?? "";
    if (!this.wrong_value_) this.set_value(layer, value);
  }

  private async fill(layer: Layer): Promise<void> {
    const what = describe_value(layer, this.session.painting.brush.value_of(layer));
    const words = texts.brush;
    if (await ask({ heading: words.fill_title(layer.name), lead: words.fill_lead(`“${what}”`), yes: words.fill })) {
      this.session.painting.fill(layer);
    }
  }
}
