// <strata-records-panel>: the tables of the model's layers, each with a button that opens it below
// the 3D view. It also shows the record that is selected in the open table or was clicked on the
// surface.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import type { TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import "../../ui/panel/empty-state";
import { panelHeadingStyles } from "../../ui/panel/panel-styles";
import { sharedStyles } from "../../ui/styles";
import type { TablePanelRequest } from "../../session/requests";
import { texts } from "../../texts";
import { recordDetails, recordDetailStyles } from "./record-details";

const words = texts.records_panel;

@customElement("strata-records-panel")
export class StrataRecordsPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    panelHeadingStyles,
    recordDetailStyles,
    css`
      :host {
        display: block;
      }
      ul {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: flex;
        align-items: center;
        gap: var(--space-half);
        padding: var(--space-1) var(--space-1) var(--space-1) var(--space-half);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      li.open {
        border-color: var(--accent);
        box-shadow: inset 3px 0 0 var(--accent);
      }
      li button.go {
        flex: 1;
        justify-content: flex-start;
        min-width: 0;
        padding: 0 var(--space-2);
      }
      li.open button.go {
        font-weight: 600;
      }
      section {
        display: grid;
        gap: var(--space-2);
        margin-top: var(--space-4);
        padding-top: var(--space-4);
        border-top: var(--edge) solid var(--line);
      }
      section .row {
        flex-wrap: wrap;
      }
    `,
  ];

  /** The layers from top to bottom, as in the list of layers. */
  private get layers(): Layer[] {
    return this.session.layers.all.filter(({ table }) => table !== undefined).reverse();
  }

  override render(): TemplateResult {
    const { layers } = this;
    return html`<div class="heading"><h2>${words.title}</h2></div>
      ${
        layers.length === 0
          ? html`<strata-empty line=${words.none} more=${words.none_more}></strata-empty>`
          : html`<ul>${layers.map((layer) => this.row(layer))}</ul>`
      }
      ${this.chosen()}`;
  }

  private row(layer: Layer): TemplateResult {
    const { session } = this;
    const isOpen = session.tables.view?.layerId === layer.id;
    const open = (): void => (isOpen ? session.tables.close() : session.tables.open(layer));
    const table = session.tables.find(layer.table!);
    const request = (detail: TablePanelRequest): boolean =>
      this.dispatchEvent(new CustomEvent("request", { detail }));
    return html`<li class=${isOpen ? "open" : ""}>
      <button class="quiet go" aria-pressed=${isOpen} title=${isOpen ? texts.tables.close : texts.tables.open} @click=${open}>
        ${icon("table")}<span class="ellipsis">${labelOf(layer)}</span>
      </button>
      ${
        session.canPaint && table
          ? html`<button
            class="icon quiet"
            aria-label=${texts.tables.new_record_of(labelOf(layer))}
            title=${texts.tables.new_record_of(labelOf(layer))}
            @click=${() => request({ dialog: "record", layer, key: null })}
          >
            ${icon("plus")}
          </button>`
          : nothing
      }
    </li>`;
  }

  /**
   * Renders the record that is selected in the open table, or else the record that was clicked on
   * the surface.
   */
  private chosen(): TemplateResult | typeof nothing {
    const { session } = this;
    const { view, card } = session.tables;
    const layer = view ? session.layers.find(view.layerId) : null;
    if (view && layer && view.selected.size > 1)
      return html`<section aria-label=${words.chosen}>
        <b>${texts.tables.chosen(view.selected.size)}</b>
        <div class="row">
          <button @click=${() => view.fly()}>${icon("fit")}${texts.tables.fly}</button>
          <button @click=${() => view.selectNone()}>${texts.tables.choose_none}</button>
        </div>
      </section>`;
    const [key] = view?.selected ?? [];
    if (layer && key !== undefined) return this.record(layer, key);
    return card ? this.record(card.layer, card.key) : nothing;
  }

  /** Returns the record, with its measures if they are known. */
  private find(layer: Layer, key: number): TableRecord | null {
    const { tables } = this.session;
    const { view, card } = tables;
    const row = view?.layerId === layer.id ? view.rows.find(key) : null;
    const clicked = card?.layer.id === layer.id && card.key === key ? card.record : null;
    return row ?? clicked ?? tables.record(layer.table ?? 0, key);
  }

  private record(layer: Layer, key: number): TemplateResult | typeof nothing {
    const { session } = this;
    const table = session.tables.find(layer.table ?? 0);
    const record = this.find(layer, key);
    if (!table || !record) return nothing;
    const request = (detail: TablePanelRequest): boolean =>
      this.dispatchEvent(new CustomEvent("request", { detail }));
    const isInTable = session.tables.view?.layerId === layer.id;
    return html`<section aria-label=${words.chosen}>
      ${recordDetails(session, layer, table, record)}
      <div class="row">
        ${session.canPaint ? html`<button @click=${() => request({ dialog: "record", layer, key })}>${texts.tables.edit}</button>` : nothing}
        ${
          isInTable
            ? html`<button @click=${() => session.tables.view?.fly()}>${texts.tables.fly}</button>`
            : html`<button @click=${() => session.tables.showRow(layer, key)}>${texts.tables.show_row}</button>`
        }
      </div>
    </section>`;
  }
}
