// <strata-selection-statistics>: the size of the selection, and the values of the selected layer
// inside it.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatPercent } from "../../core/locale";
import type { SelectResponse } from "../../core/protocol.gen";
import { formatArea } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../ui/dialog";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { selectionFacts, selectionFactStyles } from "./selection-facts";
import { selectionOf } from "./selection-of";

const words = texts.selection;

@customElement("strata-selection-statistics")
export class StrataSelectionStatistics extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    selectionFactStyles,
    css`
      .total {
        display: flex;
        align-items: baseline;
        gap: var(--space-2);
      }
      .total b {
        font: 600 var(--text-title-1) var(--serif);
      }
    `,
  ];

  override render(): TemplateResult {
    const { isEmpty, unmeasured, measured } = selectionOf(this.session);
    const text = isEmpty ? words.nothing : unmeasured ? words.unmeasured : words.measuring;
    return html`<strata-dialog docked heading=${words.statistics_title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${measured && !isEmpty ? this.content(measured) : html`<p class="hint" role="status">${text}</p>`}
    </strata-dialog>`;
  }

  private content(measured: SelectResponse): TemplateResult {
    const layer = this.session.layers.selected;
    return html`<div class="total">
        <b>${formatArea(measured.area_m2)}</b>
        <span class="hint">${words.share(formatPercent(measured.share))}</span>
      </div>
      ${layer ? selectionFacts(this.session, layer, measured) : nothing}`;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-selection-statistics": StrataSelectionStatistics;
  }
}
