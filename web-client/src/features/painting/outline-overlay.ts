// What polygon, lasso and line have drawn so far, over the picture.

import { html, nothing, svg, type TemplateResult } from "lit";
import { beside } from "../../ui/beside";
import type { Point } from "../../net/connection";
import { format_length } from "../../domain/measure";
import { color_of, css_color } from "../../domain/palette";
import { kSnap_px, type Outline } from "../../tools/outline";
import type { ModelSession } from "../../shell/model-session";
import { styled } from "../../ui/styled";
import type { ViewControl } from "../../session/view-control";

const kLength = { width: 96, height: 28 }; // room for how long a line is, CSS pixels
const kGap_px = 14;

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

/**
 * Beside the end of a line that is being drawn, at a window pixel. Who cannot see it is told when
 * the line is finished.
 */
export function length_so_far(
  { camera, scale }: ViewControl,
  metres: number | null,
  [x, y]: Point,
): TemplateResult | typeof nothing {
  if (metres === null) return nothing;
  const end = [x / scale, y / scale] as const;
  const place = beside(
    end,
    kLength,
    { width: camera.width / scale, height: camera.height / scale },
    kGap_px,
  );
  if (!place) return nothing;
  const at = {
    left: `${place.left}px`,
    top: `${place.top}px`,
    width: `${kLength.width}px`,
    "justify-content": place.left < end[0] ? "end" : "start",
  };
  return html`<div class="length numeric" aria-hidden="true" ${styled(at)}><b>${format_length(metres)}</b></div>`;
}
