// <strata-record-card>: the record that was clicked on the surface: its name, values and area.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { firstPicture, labelOf, tellingColumns } from "../../domain/cells";
import { cssColor, recordColor } from "../../domain/palette";
import type { Table, TableRecord } from "../../core/protocol.gen";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { measuresOf } from "../../session/fields/record-measures";
import { shownValue } from "../../session/fields/shown-value";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import type { TablePanelRequest } from "../../session/requests";
import { texts } from "../../texts";

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
      .row b {
        font: 600 var(--text-large) var(--serif);
      }
      .row button.icon {
        width: 1.75rem;
        min-height: var(--control-small);
      }
      .picture img {
        display: block;
        width: 100%;
        max-height: min(11.25rem, 14dvh);
        object-fit: cover;
        border-radius: var(--radius-small);
      }
      dl {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr);
        gap: var(--space-1) var(--space-3);
        margin: 0;
        max-height: 8.125rem;
        overflow: auto;
      }
      dt {
        color: var(--ink-soft);
      }
      dd {
        margin: 0;
        overflow-wrap: anywhere;
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
    const color = recordColor(session.layers.palette(layer), record);
    const request = (detail: TablePanelRequest): boolean =>
      this.dispatchEvent(new CustomEvent("request", { detail }));
    return html`<section aria-label=${words.card}>
      <div class="row">
        ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}
        <b class="grow ellipsis">${session.tables.label(table.id, key) ?? words.record(key)}</b>
        <button class="icon quiet" aria-label=${words.card_close} title=${words.card_close} @click=${() => session.tables.closeCard()}>${icon("close")}</button>
      </div>
      ${this.picture(table, record)} ${this.lines(table, record)}
      <div class="row">
        ${session.canPaint ? html`<button @click=${() => request({ dialog: "record", layer, key })}>${words.edit}</button>` : nothing}
        <button @click=${() => session.tables.showRow(layer, key)}>${words.show_row}</button>
      </div>
    </section>`;
  }

  private picture(table: Table, record: TableRecord): TemplateResult | typeof nothing {
    const { api } = this.session;
    const id = firstPicture(table, record);
    if (id === null) return nothing;
    return html`<a class="picture" href=${api.url("GET /attachments/{attachment}", { path: { attachment: id } })} target="_blank" rel="noopener">
      <img src=${api.url("GET /attachments/{attachment}", { path: { attachment: id }, query: { thumbnail: 512 } })} alt=${texts.files.file(id)} />
    </a>`;
  }

  /** The first columns with a value; the record's name is the heading. */
  private lines(table: Table, record: TableRecord): TemplateResult {
    const words = texts.tables;
    return html`<dl>
      <dt>${words.key}</dt>
      <dd>${record.key}</dd>
      ${tellingColumns(table, record)
        .slice(0, kMostLines)
        .map(
          (column) =>
            html`<dt>${labelOf(column)}</dt>
            <dd>${shownValue(this.session, column, record.values[column.slug] ?? null)}${column.unit ? ` ${column.unit}` : nothing}</dd>`,
        )}
      ${measuresOf(table).map(
        ({ label, text }) =>
          html`<dt>${label}</dt>
            <dd>${text(record) || "–"}</dd>`,
      )}
    </dl>`;
  }
}
