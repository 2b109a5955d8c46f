// Shows the length of a line during drawing, over the frame.

import { html, nothing, type TemplateResult } from "lit";
import { beside } from "../ui/beside";
import type { Point } from "../net/stroke";
import { formatLength } from "../domain/measure";
import { styled } from "../ui/styled";
import type { ViewControl } from "./view-control";

const kLength = { width: 96, height: 28 };

// The distance from the end of the line in CSS pixels.
const kGapPx = 14;

/**
 * Shows the length next to the end of the line, at a window pixel. Screen readers read the length
 * when the line is finished.
 */
export function lengthSoFar(
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
    kGapPx,
  );
  if (!place) return nothing;
  const at = {
    left: `${place.left}px`,
    top: `${place.top}px`,
    width: `${kLength.width}px`,
    "justify-content": place.left < end[0] ? "end" : "start",
  };
  return html`<div class="length" aria-hidden="true" ${styled(at)}><b>${formatLength(metres)}</b></div>`;
}
