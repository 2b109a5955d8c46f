// <strata-light-sliders>: the exposure of this user's view and, in raking light, the fill light and
// the strength of the layers. Part of the controls over the 3D view.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatFixed } from "../../core/locale";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const kMostExposure = 3; // in EV, as in the contract
const kExposureStep = 0.25;

@customElement("strata-light-sliders")
export class StrataLightSliders extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "appearance");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-half);
      }
      label {
        display: grid;
        grid-template-columns: 6.5rem minmax(0, 1fr) 4rem;
        align-items: center;
        gap: var(--space-2);
        font-size: var(--text-small);
      }
      output {
        text-align: right;
        white-space: nowrap;
      }
    `,
  ];

  override render(): TemplateResult {
    const { appearance } = this.session;
    const { mode, exposure, fill, layer_opacity: opacity } = appearance.light;
    const words = texts.view;
    const percent = (share: number): string => `${Math.round(share * 100)} %`;
    return html`${this.slider({
      name: words.exposure,
      hint: words.exposure_hint,
      range: [-kMostExposure, kMostExposure, kExposureStep],
      value: exposure,
      said: saidExposure(exposure),
      choose: (value) => appearance.setLight({ exposure: value }),
    })}
    ${
      mode === "raking"
        ? html`${this.slider({
            name: words.fill_light,
            hint: words.fill_light_hint,
            range: [0, 1, 0.05],
            value: fill,
            said: percent(fill),
            choose: (value) => appearance.setLight({ fill: value }),
          })}
          ${this.slider({
            name: words.raking_layers,
            hint: words.raking_layers_hint,
            range: [0, 1, 0.05],
            value: opacity,
            said: percent(opacity),
            choose: (value) => appearance.setLight({ layer_opacity: value }),
          })}`
        : nothing
    }`;
  }

  private slider(of: {
    name: string;
    hint: string;
    range: [number, number, number];
    value: number;
    said: string;
    choose(value: number): void;
  }): TemplateResult {
    const [least, most, step] = of.range;
    return html`<label title=${of.hint}>
      <span>${of.name}</span>
      <input
        type="range"
        min=${least}
        max=${most}
        step=${step}
        .value=${String(of.value)}
        aria-valuetext=${of.said}
        @input=${(event: Event) => of.choose(Number((event.target as HTMLInputElement).value))}
      />
      <output class="numeric">${of.said}</output>
    </label>`;
  }
}

/** Returns a text such as "+0.75 EV". */
function saidExposure(ev: number): string {
  const sign = ev > 0 ? "+" : ev < 0 ? "−" : "";
  return `${sign}${formatFixed(Math.abs(ev), Number.isInteger(ev) ? 0 : 2)} EV`;
}
