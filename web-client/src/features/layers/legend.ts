// The legend of a palette: a gradient with ticks, or swatches with labels.

import { css, html, nothing, type TemplateResult } from "lit";
import { labelOf } from "../../domain/cells";
import { formatNumber, ticks } from "../../domain/measure";
import { cssColor, cssGradient, kNoValueColor, swatchStyle } from "../../domain/palette";
import type { Layer, Palette, PalettePoint } from "../../core/types";
import type { Column, Table } from "../../core/protocol.gen";
import { describeValue, type RecordLabels } from "../../session/layer-values";
import { styled } from "../../ui/styled";
import type { TermTree } from "../../session/fields/term-tree";
import { texts } from "../../texts";

export const legendStyles = css`
  .legend-gradient {
    height: 0.875rem;
    border-radius: var(--radius-tiny);
    box-shadow: inset 0 0 0 1px var(--swatch-rim);
  }
  .legend-ticks {
    position: relative;
    height: 1.25rem;
    margin: 0 var(--space-half);
    font-size: var(--text-tiny);
    color: var(--ink-soft);
  }
  .legend-ticks span {
    position: absolute;
    top: 5px;
    transform: translateX(-50%);
    white-space: nowrap;
  }
  .legend-ticks span::before {
    content: "";
    position: absolute;
    left: 50%;
    top: -5px;
    height: 4px;
    border-left: var(--edge) solid var(--line-strong);
  }
  .legend-ticks span.first {
    transform: none;
  }
  .legend-ticks span.last {
    transform: translateX(-100%);
  }
  .legend-ticks span.first::before {
    left: 0;
  }
  .legend-ticks span.last::before {
    left: 100%;
  }
  .legend-classes {
    display: grid;
    gap: var(--space-1);
    margin: 0;
    padding: 0;
    list-style: none;
    font-size: var(--text-small);
    max-height: 16.25rem;
    overflow: auto;
  }
  .legend-column {
    display: grid;
    gap: var(--space-2);
  }
  .legend-classes li {
    display: flex;
    align-items: center;
    gap: var(--space-2);
    min-width: 0;
  }
`;

/** The records, terms and tables that the legend reads. */
export interface LegendNames extends RecordLabels {
  find(table: number): Table | null;
  terms(table: number): TermTree | null;
  lacks(table: number, key: number): boolean;
}

/** `palette` is this user's palette for the layer. */
export function legend(layer: Layer, palette: Palette, records: LegendNames): TemplateResult {
  if (palette.column) return columnLegend(layer, palette, records);
  const { unit } = layer;
  if (palette.mode === "categorical") {
    const { table } = layer;
    const terms = table === undefined ? null : records.terms(table);
    // a palette also has colors for future records
    const there =
      table === undefined
        ? palette.points
        : palette.points.filter(({ at }) => !records.lacks(table, at));
    if (there.length === 0)
      return html`<p class="hint">${layer.kind === "database" ? texts.layers.no_records : texts.layers.no_labels}</p>`;
    const points = inTree(there, terms);
    return html`<ul class="legend-classes" aria-label=${labelOf(layer)} tabindex=${points.length > kLinesInSight ? 0 : nothing}>
      ${points.slice(0, kMostLines).map(({ point, depth }) => line(point, describeValue(layer, point.at, records), depth))}
      ${points.length > kMostLines ? html`<li class="hint">${texts.layers.more_classes(points.length - kMostLines)}</li>` : nothing}
    </ul>`;
  }
  return gradient(palette, unit);
}

/** Renders the legend of a palette whose values are neither keys nor terms. */
export const paletteLegend = (palette: Palette, unit: string, label: string): TemplateResult =>
  palette.mode === "categorical"
    ? html`<ul class="legend-classes" aria-label=${label}>
        ${palette.points.slice(0, kMostLines).map((point) => line(point, point.label ?? formatNumber(point.at)))}
      </ul>`
    : gradient(palette, unit);

/**
 * Sorts the points by their position in the list of terms. Adds the depth of each term in the tree.
 */
function inTree(
  points: readonly PalettePoint[],
  terms: TermTree | null,
): { point: PalettePoint; depth: number }[] {
  terms?.want();
  if (!terms?.loaded) return points.map((point) => ({ point, depth: 0 }));
  const places = new Map(terms.terms.map(({ key, depth }, place) => [key, { place, depth }]));
  const last = { place: Infinity, depth: 0 }; // the position of points that are not terms
  return points
    .map((point) => ({ point, ...(places.get(point.at) ?? last) }))
    .sort((a, b) => (a.place === b.place ? 0 : a.place - b.place));
}

const kLinesInSight = 8; // a longer legend scrolls, also with the keyboard
const kMostLines = 300; // a list of terms may contain thousands
const kIndentPx = 14;

const line = (
  point: Pick<PalettePoint, "color" | "pattern" | "angle">,
  text: string,
  depth = 0,
): TemplateResult =>
  html`<li ${styled({ "padding-left": depth > 0 ? `${depth * kIndentPx}px` : null })}>
    <span class="swatch" ${styled(swatchStyle(point))}></span>
    <span class="ellipsis">${text}</span>
  </li>`;

/** Renders the legend for colors from a column of the records. */
function columnLegend(layer: Layer, palette: Palette, records: LegendNames): TemplateResult {
  const column =
    layer.table === undefined
      ? undefined
      : records.find(layer.table)?.columns.find((each) => each.slug === palette.column);
  const unit = column?.unit ?? "";
  const lines =
    palette.mode === "categorical"
      ? palette.points.map((point) => line(point, valueLabel(point, column, records)))
      : palette.points.map((point, index) =>
          line(point, classRange(point.at, palette.points[index + 1]?.at ?? palette.max, unit)),
        );
  return html`<div class="legend-column">
    <p class="caption">${texts.colors.by(column ? labelOf(column) : (palette.column ?? ""))}</p>
    ${palette.mode === "linear" ? gradient(palette, unit) : nothing}
    <ul class="legend-classes">
      ${palette.mode === "linear" ? nothing : lines}
      ${line({ color: palette.others ?? kNoValueColor }, palette.mode === "categorical" ? texts.colors.others : texts.colors.without)}
    </ul>
  </div>`;
}

export const classRange = (from: number, to: number, unit: string): string =>
  `${formatNumber(from, 4)} – ${formatNumber(to, 4)}${unit ? ` ${unit}` : ""}`;

/** Returns the label of a class of a column's values. */
export function valueLabel(
  { label, value, at }: PalettePoint,
  column: Column | undefined,
  records: RecordLabels,
): string {
  if (label) return label;
  if (value === undefined || value === "")
    return `${formatNumber(at, 6)}${column?.unit ? ` ${column.unit}` : ""}`;
  if (column?.kind === "term")
    return records.label(column.target ?? 0, Number(value)) ?? texts.tables.record(Number(value));
  if (column?.kind === "boolean") return value === "true" ? texts.tables.yes : texts.tables.no;
  return value;
}

function gradient(palette: Palette, unit: string): TemplateResult {
  const span = palette.max - palette.min || 1;
  const marks = ticks(palette.min, palette.max);
  return html`<div>
    <div class="legend-gradient" ${styled({ background: cssGradient(palette) })}></div>
    <div class="legend-ticks">
      ${marks.map((mark, index) => {
        const share = (mark - palette.min) / span;
        const shownUnit = unit && index === marks.length - 1 ? ` ${unit}` : "";
        // With its unit, the last label is too long to be centered near the end.
        const edge = share < 0.04 ? "first" : share > (shownUnit ? 0.85 : 0.96) ? "last" : "";
        return html`<span class=${edge} ${styled({ left: `${(share * 100).toFixed(2)}%` })}
          >${formatNumber(mark, 4)}${shownUnit}</span
        >`;
      })}
    </div>
  </div>`;
}

/** Renders a small square with the layer's colors. */
export function layerChip(palette: Palette): TemplateResult {
  const first = palette.points[0];
  const background =
    palette.mode !== "categorical"
      ? cssGradient(palette, "135deg")
      : palette.points.length > 1
        ? `conic-gradient(${palette.points
            .slice(0, 6)
            .map(
              (point, index, all) =>
                `${cssColor(point.color)} ${index / all.length}turn ${(index + 1) / all.length}turn`,
            )
            .join(", ")})`
        : first
          ? cssColor(first.color)
          : "conic-gradient(#e69f00, #56b4e9, #009e73, #cc79a7, #e69f00)";
  return html`<span class="swatch" ${styled({ background })}></span>`;
}
