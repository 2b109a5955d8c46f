// <strata-record-card>: the record that was clicked on the surface: its name, values and area.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import type { TablePanelRequest } from "../../session/requests";
import { texts } from "../../texts";
import { recordDetails, recordDetailStyles } from "./record-details";

const kMostLines = 6;

@customElement("strata-record-card")
export class StrataRecordCard extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    recordDetailStyles,
    css`
      :host {
        display: block;
        width: min(18.75rem, 100%);
        pointer-events: auto;
      }
      section {
        display: grid;
        gap: var(--space-2);
        padding: var(--space-2) var(--space-2) var(--space-2) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        box-shadow: var(--shadow);
        font-size: var(--text-small);
      }
      .row button.icon {
        width: 1.75rem;
        min-height: var(--control-small);
      }
      dl {
        max-height: 8.125rem;
        overflow: auto;
      }
      .row button {
        min-height: var(--control-small);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const words = texts.tables;
    const { card } = session.tables;
    const { table: id } = card?.layer ?? {};
    const table = id === undefined ? null : session.tables.find(id);
    if (!card || !table || !card.record) return html``;
    const { layer, key, record } = card;
    const request = (detail: TablePanelRequest): boolean =>
      this.dispatchEvent(new CustomEvent("request", { detail }));
    const close = html`<button class="icon quiet" aria-label=${words.card_close} title=${words.card_close} @click=${() => session.tables.closeCard()}>${icon("close")}</button>`;
    return html`<section aria-label=${words.card}>
      ${recordDetails(session, layer, table, record, { most: kMostLines, tools: close })}
      <div class="row">
        ${session.canPaint ? html`<button @click=${() => request({ dialog: "record", layer, key })}>${words.edit}</button>` : nothing}
        <button @click=${() => session.tables.showRow(layer, key)}>${words.show_row}</button>
      </div>
    </section>`;
  }
}
