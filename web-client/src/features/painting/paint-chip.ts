// <strata-paint-chip>: a line above the tools with the value that the selected tool paints. It
// appears in windows in which the brush panel covers the model or is closed. A click opens that
// panel.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatNumber } from "../../domain/measure";
import { labelOf } from "../../domain/cells";
import { colorOf, cssColor } from "../../domain/palette";
import { kPaintingTools, kSelectingTools } from "../../tools/tool";
import { describeValue } from "../../session/layer-values";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

@customElement("strata-paint-chip")
export class StrataPaintChip extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "layers", "tools", "tables", "marks");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: none;
      }
      @media (max-width: 820px) {
        :host {
          display: block;
          grid-area: chip;
          z-index: 3;
          min-width: 0;
          background: var(--surface);
        }
      }
      button {
        width: 100%;
        justify-content: start;
        min-height: 2.5rem;
        padding: 0 var(--space-3);
        border: 0;
        border-top: var(--edge) solid var(--line);
        border-radius: 0;
      }
      b {
        font-weight: 600;
      }
      .on {
        flex: 1;
        min-width: 0;
        color: var(--ink-soft);
        text-align: start;
      }
      .width {
        flex: none;
        color: var(--ink-soft);
      }
    `,
  ];

  override render(): TemplateResult | typeof nothing {
    const { session } = this;
    const { painting } = session;
    const tool = session.tools.active;
    const layer = session.layers.selected;
    if (!kPaintingTools.includes(tool) || !layer) return nothing;
    const words = texts.brush;
    const { brush } = painting;
    const areas = kSelectingTools.includes(tool) || tool === "bucket";
    const erases = tool === "eraser" || (areas && brush.areas.erases);
    const value = brush.valueFor(layer);
    const color = erases ? null : colorOf(session.layers.palette(layer), value);
    const what = erases ? texts.areas.erases : describeValue(layer, value, session.tables);
    const width =
      tool === "brush" || tool === "eraser"
        ? `${formatNumber(brush.width[brush.unit])} ${brush.unit === "px" ? words.width_px : words.width_mm}`
        : "";
    return html`<button class="quiet" title=${words.change} @click=${() => this.dispatchEvent(new CustomEvent("options"))}>
      ${session.lockedTarget ? icon("lock") : color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : icon(tool === "face" || tool === "part" ? "brush" : tool)}
      <b class="ellipsis">${what}</b>
      <span class="on ellipsis">${labelOf(layer)}</span>
      ${width ? html`<span class="width">${width}</span>` : nothing} ${icon("up")}
    </button>`;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-paint-chip": StrataPaintChip;
  }
}
