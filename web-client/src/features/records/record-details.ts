// The content of a record, for its card over the 3D view and for the side panel: its name, first
// picture, values and measures.

import { css, html, nothing, type TemplateResult } from "lit";
import { firstPicture, labelOf, tellingColumns } from "../../domain/cells";
import { cssColor, recordColor } from "../../domain/palette";
import type { Table, TableRecord } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { measuresOf } from "../../session/fields/record-measures";
import { shownValue } from "../../session/fields/shown-value";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

export const recordDetailStyles = css`
  .row b {
    font: 600 var(--text-large) var(--serif);
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
    font-size: var(--text-small);
  }
  dt {
    color: var(--ink-soft);
  }
  dd {
    margin: 0;
    overflow-wrap: anywhere;
  }
`;

/**
 * `most` is the largest number of columns with a value to show. The record's name is the heading.
 * `tools` appear after the name.
 */
export function recordDetails(
  session: ModelSession,
  layer: Layer,
  table: Table,
  record: TableRecord,
  { most = Infinity, tools = nothing }: { most?: number; tools?: unknown } = {},
): TemplateResult {
  const words = texts.tables;
  const color = recordColor(session.layers.palette(layer), record);
  return html`<div class="row">
      ${color ? html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>` : nothing}
      <b class="grow ellipsis">${session.tables.label(table.id, record.key) ?? words.record(record.key)}</b>
      ${tools}
    </div>
    ${picture(session, table, record)}
    <dl>
      <dt>${words.key}</dt>
      <dd>${record.key}</dd>
      ${tellingColumns(table, record)
        .slice(0, most)
        .map(
          (column) =>
            html`<dt>${labelOf(column)}</dt>
            <dd>${shownValue(session, column, record.values[column.slug] ?? null)}${column.unit ? ` ${column.unit}` : nothing}</dd>`,
        )}
      ${measuresOf(table).map(
        ({ label, text }) =>
          html`<dt>${label}</dt>
            <dd>${text(record) || "–"}</dd>`,
      )}
    </dl>`;
}

function picture(
  { api }: ModelSession,
  table: Table,
  record: TableRecord,
): TemplateResult | typeof nothing {
  const id = firstPicture(table, record);
  if (id === null) return nothing;
  return html`<a class="picture" href=${api.url("GET /attachments/{attachment}", { path: { attachment: id } })} target="_blank" rel="noopener">
    <img src=${api.url("GET /attachments/{attachment}", { path: { attachment: id }, query: { thumbnail: 512 } })} alt=${texts.files.file(id)} />
  </a>`;
}
