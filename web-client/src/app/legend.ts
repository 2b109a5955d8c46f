// The legend of a palette: gradient with ticks, or swatches with labels.

import { css, html, type TemplateResult } from "lit";
import { format_number, ticks } from "../core/measure";
import { css_color, css_gradient } from "../core/palette";
import type { Layer } from "../core/types";
import { describe_value, type RecordLabels } from "./brush-settings";
import { styled } from "./styled";
import { texts } from "./texts";

export const legend_styles = css`
  .legend-gradient {
    height: 14px;
    border-radius: 4px;
    box-shadow: inset 0 0 0 1px rgb(0 0 0 / 0.18);
  }
  .legend-ticks {
    position: relative;
    height: 20px;
    margin: 0 2px;
    font-size: 0.76rem;
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
    border-left: 1px solid var(--line-strong);
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
    gap: 5px;
    margin: 0;
    padding: 0;
    list-style: none;
    font-size: 0.9rem;
    max-height: 260px;
    overflow: auto;
  }
  .legend-classes li {
    display: flex;
    align-items: center;
    gap: 9px;
    min-width: 0;
  }
`;

export function legend(layer: Layer, records: RecordLabels): TemplateResult {
  const { palette, unit } = layer;
  if (palette.mode === "categorical") {
    if (palette.points.length === 0) {
      return html`<p class="hint">${layer.kind === "database" ? texts.layers.no_records : texts.layers.no_labels}</p>`;
    }
    return html`<ul class="legend-classes">
      ${palette.points.map(
        (point) =>
          html`<li>
            <span class="swatch" ${styled({ background: css_color(point.color) })}></span>
            <span class="ellipsis">${describe_value(layer, point.at, records)}</span>
          </li>`,
      )}
    </ul>`;
  }
  const span = palette.max - palette.min || 1;
  const marks = ticks(palette.min, palette.max);
  return html`<div>
    <div class="legend-gradient" ${styled({ background: css_gradient(palette) })}></div>
    <div class="legend-ticks numeric">
      ${marks.map((mark, index) => {
        const share = (mark - palette.min) / span;
        const edge = share < 0.04 ? "first" : share > 0.96 ? "last" : "";
        const shown_unit = unit && index === marks.length - 1 ? ` ${unit}` : "";
        return html`<span class=${edge} ${styled({ left: `${(share * 100).toFixed(2)}%` })}
          >${format_number(mark, 4)}${shown_unit}</span
        >`;
      })}
    </div>
  </div>`;
}

/** One small square that stands for the layer. */
export function layer_chip(layer: Layer): TemplateResult {
  const { palette } = layer;
  const first = palette.points[0];
  const background =
    palette.mode !== "categorical"
      ? css_gradient(palette, "135deg")
      : palette.points.length > 1
        ? `conic-gradient(${palette.points
            .slice(0, 6)
            .map((point, index, all) => `${css_color(point.color)} ${index / all.length}turn ${(index + 1) / all.length}turn`)
            .join(", ")})`
        : first
          ? css_color(first.color)
          : "conic-gradient(#e69f00, #56b4e9, #009e73, #cc79a7, #e69f00)";
  return html`<span class="swatch" ${styled({ background })}></span>`;
}
