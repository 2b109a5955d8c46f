// The outline of polygon, lasso and line while it is drawn. It is over the 3D view.

import { html, nothing, svg, type TemplateResult } from "lit";
import { colorOf, cssColor } from "../../domain/palette";
import type { Outline } from "../../tools/tool";
import type { ModelSession } from "../../session/model-session";
import { lengthSoFar } from "../../session/line-length";

export function outlineOverlay(
  session: ModelSession,
  { points, corners, edge = [], pointer, closable, area }: Outline,
): TemplateResult {
  const { scale } = session.view;
  const layer = session.layers.selected;
  const { brush } = session.painting;
  const color =
    layer && !(area && brush.areas.erases) ? colorOf(layer.palette, brush.valueFor(layer)) : null;
  const line = [...points, ...edge, ...(pointer ? [pointer] : [])]
    .map(([x, y]) => `${x / scale},${y / scale}`)
    .join(" ");
  const [first] = points;
  const atFirst = closable && first?.[0] === pointer?.[0] && first?.[1] === pointer?.[1];
  return html`<svg class="over" aria-hidden="true">
      ${area ? svg`<polygon points=${line} fill=${color ? cssColor(color) : "var(--mark-light)"} fill-opacity="0.28" stroke="none" />` : nothing}
      <polyline points=${line} fill="none" stroke="var(--mark-rim)" stroke-width="3.4" stroke-linejoin="round" />
      <polyline points=${line} fill="none" stroke=${area || !color ? "var(--mark-light)" : cssColor(color)} stroke-width="1.6" stroke-linejoin="round" />
      ${corners.map(
        ([x, y], index) =>
          svg`<circle cx=${x / scale} cy=${y / scale} r=${index === 0 && atFirst ? 8 : 4} fill=${index === 0 ? "var(--mark-dark)" : "var(--mark-light)"}
            stroke=${index === 0 ? "var(--mark-light)" : "var(--mark-dark)"} stroke-width="1.5" />`,
      )}
    </svg>
    ${area ? nothing : lengthSoFar(session.view, session.marks.metresSoFar, pointer ?? points[points.length - 1]!)}`;
}
