// The outline of polygon, lasso and line while it is drawn, and the finished outlines of the
// selection. They are over the 3D view.

import { html, nothing, svg, type TemplateResult } from "lit";
import { colorOf, cssColor } from "../../domain/palette";
import { kSnapPx } from "../../tools/outline";
import type { Outline } from "../../tools/tool";
import type { ModelSession } from "../../session/model-session";
import { lengthSoFar } from "../../session/line-length";
import { middleAfter } from "./area-selection";

export function outlineOverlay(
  session: ModelSession,
  { points, corners, pointer, closable, area }: Outline,
): TemplateResult {
  const { scale } = session.view;
  const layer = session.layers.selected;
  const { brush } = session.painting;
  const color =
    layer && !(area && brush.areas.erases) ? colorOf(layer.palette, brush.valueFor(layer)) : null;
  const line = [...points, ...(pointer ? [pointer] : [])]
    .map(([x, y]) => `${x / scale},${y / scale}`)
    .join(" ");
  const [first] = points;
  const atFirst =
    closable &&
    first &&
    pointer &&
    Math.hypot(pointer[0] - first[0], pointer[1] - first[1]) <= kSnapPx * scale;
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

const kDashes = { add: "none", subtract: "3 5", intersect: "9 4" };

/** Renders the outlines that were drawn in the current view, with handles at their corners. */
export function selectionOverlay(session: ModelSession): TemplateResult | typeof nothing {
  const { area } = session.painting;
  if (area.isEmpty) return nothing;
  const { scale } = session.view;
  const at = ([x, y]: readonly number[]): [number, number] => [x! / scale, y! / scale];
  const outlines = area.outlines.flatMap((outline, index) =>
    area.isInView(outline) ? [{ outline, index }] : [],
  );
  return html`<svg class="over" aria-hidden="true">
    ${outlines.map(({ outline: { path, combine, corners }, index }) => {
      const points = path.map((point) => at(point).join(",")).join(" ");
      return svg`<polygon points=${points} fill="none" stroke="var(--mark-rim)" stroke-width="3.4" stroke-linejoin="round" />
        <polygon points=${points} fill="none" stroke="var(--mark-light)" stroke-width="1.6" stroke-linejoin="round" stroke-dasharray=${kDashes[combine]} />
        ${corners ? path.map((_, corner) => handle(at(middleAfter(path, corner)), 3, false)) : nothing}
        ${
          corners
            ? path.map((point, corner) =>
                handle(
                  at(point),
                  5,
                  area.active?.outline === index && area.active.corner === corner,
                ),
              )
            : nothing
        }`;
    })}
  </svg>`;
}

const handle = ([x, y]: [number, number], size: number, active: boolean): TemplateResult =>
  svg`<circle cx=${x} cy=${y} r=${active ? size + 2 : size} fill=${active ? "var(--lit)" : "var(--mark-light)"} stroke="var(--mark-dark)" stroke-width="1.5" fill-opacity=${size > 3 ? 1 : 0.75} />`;
