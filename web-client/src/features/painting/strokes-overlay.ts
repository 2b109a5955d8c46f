// The strokes inside and outside of an area. They are over the 3D view.

import { html, svg, type TemplateResult } from "lit";
import { kStrokeRadius, type Strokes } from "./strokes";

/** Renders the strokes. `scale` is the number of window pixels per CSS pixel. */
export function strokesOverlay({ shown }: Strokes, scale: number): TemplateResult {
  return html`<svg class="over" aria-hidden="true">
    ${shown.map(({ inside, path }) => {
      // A line with only one point would not be drawn.
      const points = [path[0]!, ...path].map(([x, y]) => `${x / scale},${y / scale}`).join(" ");
      const line = (width: number, color: string, dashes = "none"): TemplateResult =>
        svg`<polyline points=${points} fill="none" stroke=${color} stroke-width=${width} stroke-linecap="round" stroke-linejoin="round" stroke-dasharray=${dashes} />`;
      return inside
        ? svg`${line(2 * kStrokeRadius + 2, "var(--mark-dark)")}${line(2 * kStrokeRadius, "var(--mark-light)")}`
        : svg`${line(2 * kStrokeRadius + 2, "var(--mark-light)")}${line(2 * kStrokeRadius, "var(--mark-dark)")}${line(1.6, "var(--mark-light)", "1 6")}`;
    })}
  </svg>`;
}
