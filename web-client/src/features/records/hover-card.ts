// <strata-hover-card>: a summary of the record under the mouse pointer while the pointer does not
// move. It is only for display, so pointer events pass through it. Users without a mouse open the
// card with a tap.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { beside } from "../../ui/beside";
import { firstPicture, labelOf, tellingColumns } from "../../domain/cells";
import { cssColor, recordColor } from "../../domain/palette";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { shownValue } from "../../session/fields/shown-value";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const kMostLines = 4;
const kGapPx = 18; // the size of the mouse pointer

@customElement("strata-hover-card")
export class StrataHoverCard extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @query("section") private _section!: HTMLElement | null;

  constructor() {
    super();
    followSession(this, "hovered", "pointer", "view", "tools", "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        position: absolute;
        inset: 0;
        overflow: hidden;
        pointer-events: none;
      }
      section {
        position: absolute;
        display: grid;
        gap: var(--space-2);
        width: max-content;
        max-width: 14.75rem;
        padding: var(--space-2) var(--space-3) var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        box-shadow: var(--shadow);
        font-size: var(--text-small);
        animation: appear var(--fast);
      }
      @keyframes appear {
        from {
          opacity: 0;
        }
      }
      .row {
        gap: var(--space-2);
      }
      .swatch {
        width: 0.8125rem;
        height: 0.8125rem;
      }
      b {
        font: 600 var(--text-large) var(--serif);
      }
      img {
        display: block;
        width: 13.125rem;
        max-width: 100%;
        height: 6.5rem; /* reserved before the picture loads, so the card keeps its size */
        object-fit: cover;
        border-radius: var(--radius-small);
        background: var(--stage);
      }
      dl {
        display: grid;
        grid-template-columns: minmax(0, auto) minmax(0, 1.6fr);
        gap: var(--space-half) var(--space-3);
        margin: 0;
      }
      dt {
        color: var(--ink-soft);
      }
      dd {
        display: -webkit-box;
        -webkit-box-orient: vertical;
        -webkit-line-clamp: 2;
        margin: 0;
        overflow: hidden;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.setAttribute("aria-hidden", "true");
    // receives the keys of every focused element
    addEventListener("keydown", this.onKey, { capture: true });
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("keydown", this.onKey, { capture: true });
  }

  private readonly onKey = ({ key }: KeyboardEvent): void => {
    if (key === "Escape") this.session.hovered.end();
  };

  override render(): TemplateResult {
    const { session } = this;
    const { layer, key } = session.hovered.shown ?? {};
    const table = layer?.table === undefined ? null : session.tables.find(layer.table);
    const record = table && key !== undefined ? session.tables.record(table.id, key) : null;
    if (!layer || !table || !record) return html``;
    const color = recordColor(session.layers.palette(layer), record);
    const picture = firstPicture(table, record);
    const told = tellingColumns(table, record).slice(0, kMostLines);
    return html`<section>
      <div class="row">
        ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}
        <b class="ellipsis">${session.tables.title(table, record) || texts.tables.record(record.key)}</b>
      </div>
      ${picture === null ? nothing : html`<img src=${session.api.url("GET /attachments/{attachment}", { path: { attachment: picture }, query: { thumbnail: 256 } })} alt="" />`}
      ${
        told.length === 0
          ? nothing
          : html`<dl>
            ${told.map(
              (column) =>
                html`<dt class="ellipsis">${labelOf(column)}</dt>
                  <dd>${shownValue(session, column, record.values[column.slug] ?? null)}${column.unit ? ` ${column.unit}` : nothing}</dd>`,
            )}
          </dl>`
      }
    </section>`;
  }

  /** Positions the card, because its size is known only after rendering. */
  override updated(): void {
    const { _section: section } = this;
    const { at } = this.session.pointer;
    if (!section || !at) return;
    const { scale } = this.session.view;
    const size = { width: section.offsetWidth, height: section.offsetHeight };
    const place = beside(
      [at.x / scale, at.y / scale],
      size,
      { width: this.clientWidth, height: this.clientHeight },
      kGapPx,
    );
    section.style.visibility = place ? "visible" : "hidden";
    section.style.left = `${place?.left ?? 0}px`;
    section.style.top = `${place?.top ?? 0}px`;
  }
}
