// The values of a layer inside the selection.

import { css, html, type TemplateResult } from "lit";
import { formatPercent } from "../../core/locale";
import type { SelectResponse } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { formatArea } from "../../domain/measure";
import { describeValue } from "../../session/layer-values";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import { hasClasses } from "./wand";

const kMostClasses = 60;

export const selectionFactStyles = css`
  .facts {
    display: grid;
    grid-template-columns: auto 1fr;
    gap: var(--space-half) var(--space-3);
    margin: var(--space-1) 0 var(--space-2);
    font-size: var(--text-body);
  }
  .facts dt {
    color: var(--ink-soft);
    overflow-wrap: anywhere;
  }
  .facts dd {
    margin: 0;
    text-align: right;
  }
`;

/** Renders what the layer contains inside the selection, with the largest areas first. */
export function selectionFacts(
  session: ModelSession,
  layer: Layer,
  { area_m2: wholeM2, layers }: SelectResponse,
): TemplateResult {
  const words = texts.selection;
  const found = layers[layer.slug];
  if (!found) return html``;
  const amount = (value: number | null | undefined): string =>
    value === null || value === undefined ? "–" : describeValue(layer, value, session.tables);
  const area = (m2: number): string =>
    wholeM2 > 0 ? `${formatArea(m2)} (${formatPercent(m2 / wholeM2)})` : formatArea(m2);
  const classes = [...(found.keys ?? [])].sort((a, b) => b.area_m2 - a.area_m2);
  const values: [string, string][] = hasClasses(layer)
    ? classes.slice(0, kMostClasses).map((each) => [amount(each.key), area(each.area_m2)])
    : found.texels > 0
      ? [
          [words.lowest, amount(found.min)],
          [words.mean, amount(found.mean)],
          [words.highest, amount(found.max)],
        ]
      : [];
  const rows = [[words.painted, area(found.area_m2)], ...values];
  return html`<div>
    <h3 class="caption">${words.in_layer(labelOf(layer))}</h3>
    <dl class="facts">${rows.map(([what, value]) => html`<dt>${what}</dt><dd class="numeric">${value}</dd>`)}</dl>
  </div>`;
}
