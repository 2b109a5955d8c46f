// Marks the place on the stage whose photographs are listed.

import { html, nothing, svg, type TemplateResult } from "lit";
import type { ModelSession } from "../../session/model-session";

export function placeOverlay({ photographs, view }: ModelSession): TemplateResult | typeof nothing {
  const place = photographs?.place;
  const seen = place && view.camera.projectInside(place);
  if (!seen) return nothing;
  const [x, y] = [seen.x / view.scale, seen.y / view.scale];
  return html`<svg class="over" aria-hidden="true">
    ${svg`<circle cx=${x} cy=${y} r="9" fill="none" stroke="var(--mark-light)" stroke-width="5" />
      <circle cx=${x} cy=${y} r="9" fill="none" stroke="var(--mark-dark)" stroke-width="2.4" />`}
  </svg>`;
}
