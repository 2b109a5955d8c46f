// <strata-value-readout>: the position and the layers' values under the pointer.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import { formatFixed, formatPlace } from "../../core/locale";
import { colorOf, cssColor } from "../../domain/palette";
import type { Layer } from "../../core/types";
import { describeValue } from "../../session/layer-values";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

@customElement("strata-value-readout")
export class StrataValueReadout extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "pointer", "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        pointer-events: none;
      }
      div.card {
        display: grid;
        gap: var(--space-1);
        padding: var(--space-2) var(--space-3) var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--hint);
        box-shadow: var(--shadow);
        font-size: var(--text-small);
      }
      .line {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
      }
      .swatch {
        width: 0.75rem;
        height: 0.75rem;
      }
      .line b {
        margin-left: auto;
        padding-left: var(--space-3);
        font-weight: 600;
      }
      .line b.none {
        color: var(--ink-soft);
        font-weight: 400;
      }
      .position {
        color: var(--ink-soft);
        font-size: var(--text-tiny);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const { model } = session;
    const { picked } = session.pointer;
    if (!picked?.hit || !picked.position || !model) return html``;
    const { layers } = session;
    const shown = [...layers.all]
      .reverse()
      .filter((layer) => layers.visible(layer) || layer === layers.selected);
    const decimals = model.unit === "mm" ? 2 : model.unit === "cm" ? 3 : 4;
    const coordinates = formatPlace(picked.position.map((each) => formatFixed(each, decimals)));
    return html`<div class="card">
      ${shown.map((layer) => this.line(layer))}
      <span class="position">${texts.value.position} ${coordinates} ${model.unit}</span>
    </div>`;
  }

  private line(layer: Layer): TemplateResult {
    const found = this.session.pointer.picked?.values?.[layer.slug];
    const valid = found?.valid === true && found.value !== undefined;
    const color = valid ? colorOf(this.session.layers.palette(layer), found.value!) : null;
    return html`<span class="line">
      ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}
      <span class="ellipsis">${labelOf(layer)}</span>
      <b class=${valid ? "" : "none"}>${valid ? describeValue(layer, found.value!, this.session.tables) : texts.value.nothing}</b>
    </span>`;
  }
}
