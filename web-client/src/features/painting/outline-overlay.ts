// What polygon, lasso and line have drawn so far, over the picture.

import { html, nothing, svg, type TemplateResult } from "lit";
import { color_of, css_color } from "../../domain/palette";
import { kSnap_px } from "../../tools/outline";
import type { Outline } from "../../tools/tool";
import type { ModelSession } from "../../session/model-session";
import { length_so_far } from "../../session/line-length";

export function outline_overlay(
  session: ModelSession,
  { points, corners, pointer, closable, area }: Outline,
): TemplateResult {
  const { scale } = session.view;
  const layer = session.layers.selected;
  const { brush } = session.painting;
  const color =
    layer && !(area && brush.areas.erases) ? color_of(layer.palette, brush.value_of(layer)) : null;
  const line = [...points, ...(pointer ? [pointer] : [])]
    .map(([x, y]) => `${x / scale},${y / scale}`)
    .join(" ");
  const [first] = points;
  const at_first =
    closable &&
    first &&
    pointer &&
    Math.hypot(pointer[0] - first[0], pointer[1] - first[1]) <= kSnap_px * scale;
  return html`<svg class="over" aria-hidden="true">
      ${area ? svg`<polygon points=${line} fill=${color ? css_color(color) : "var(--mark-light)"} fill-opacity="0.28" stroke="none" />` : nothing}
      <polyline points=${line} fill="none" stroke="var(--mark-rim)" stroke-width="3.4" stroke-linejoin="round" />
      <polyline points=${line} fill="none" stroke=${area || !color ? "var(--mark-light)" : css_color(color)} stroke-width="1.6" stroke-linejoin="round" />
      ${corners.map(
        ([x, y], index) =>
          svg`<circle cx=${x / scale} cy=${y / scale} r=${index === 0 && at_first ? 8 : 4} fill=${index === 0 ? "var(--mark-dark)" : "var(--mark-light)"}
            stroke=${index === 0 ? "var(--mark-light)" : "var(--mark-dark)"} stroke-width="1.5" />`,
      )}
    </svg>
    ${area ? nothing : length_so_far(session.view, session.marks.metres_so_far, pointer ?? points[points.length - 1]!)}`;
}
