// The measurement over the 3D view: its points, the straight legs between them, its course on the
// surface, and the point under the plot's pointer.

import { html, nothing, svg, type TemplateResult } from "lit";
import type { OrbitCamera } from "../../math/camera";
import type { Vec3 } from "../../math/vector";
import type { ModelSession } from "../../session/model-session";
import { lengthSoFar } from "../../session/line-length";
import { faces } from "../../session/pin-sight";

interface Seen {
  x: number; // in CSS pixels
  y: number;
  /** Whether the surface at the point faces the camera and is not cut away. */
  towards: boolean;
}

export function measureOverlay({
  measuring,
  view,
  pointer,
}: ModelSession): TemplateResult | typeof nothing {
  const { camera, scale } = view;
  const { places, profile, tip } = measuring;
  const middle = { x: camera.width / scale / 2, y: camera.height / scale / 2 };
  const seen = places.map(({ position, normal }) => project(camera, scale, position, normal));
  const ends = tip ? [...seen, { x: tip[0] / scale, y: tip[1] / scale, towards: true }] : seen;
  const shown = measuring.pointed === null ? undefined : profile?.places[measuring.pointed];
  const mark = shown && project(camera, scale, shown.place, shown.normal);
  const legs = segments(ends, () => true);
  const course = (profile?.course ?? []).map((part) =>
    part.map(({ place, normal }) => project(camera, scale, place, normal)),
  );
  const turned = (towards: boolean): string =>
    course.map((part) => segments(part, (a, b) => (a.towards && b.towards) === towards)).join("");
  const closing =
    measuring.ended && places.length > 2 ? segments([seen.at(-1)!, seen[0]!], () => true) : "";
  const area =
    measuring.ended && places.length > 2 && !seen.includes(null)
      ? seen.map((each) => `${each!.x},${each!.y}`).join(" ")
      : null;
  const line = (path: string, stroke: string, width: number, dashes = "none"): TemplateResult =>
    svg`<path d=${path} fill="none" stroke=${stroke} stroke-width=${width} stroke-dasharray=${dashes} stroke-linejoin="round" stroke-linecap="round" />`;
  return html`<svg class="over measured" aria-hidden="true">
      ${area === null ? nothing : svg`<polygon points=${area} fill="var(--mark-light)" fill-opacity="0.22" stroke="none" />`}
      ${line(turned(false), "var(--mark-rim)", 1.6, "2 4")}
      ${line(legs + closing, "var(--mark-rim)", 3)} ${line(legs, "var(--mark-light)", 1.4, "5 4")} ${line(closing, "var(--mark-light)", 1.4, "1 5")}
      ${line(turned(true), "var(--mark-dark)", 4.4)} ${line(turned(true), "var(--mark-measured)", 2.4)}
      ${seen.map((each, index) =>
        each === null
          ? nothing
          : svg`<circle cx=${each.x} cy=${each.y} r="5" fill=${!each.towards ? "none" : index === 0 ? "var(--mark-dark)" : "var(--mark-light)"}
              stroke=${index === 0 && each.towards ? "var(--mark-light)" : "var(--mark-dark)"} stroke-width="1.6" stroke-dasharray=${each.towards ? "none" : "2 2"} />`,
      )}
      ${
        mark
          ? svg`<circle cx=${mark.x} cy=${mark.y} r="8" fill="none" stroke="var(--mark-light)" stroke-width="5" />
            <circle cx=${mark.x} cy=${mark.y} r="8" fill="none" stroke="var(--mark-dark)" stroke-width="2.4" stroke-dasharray=${mark.towards ? "none" : "3 3"} />`
          : nothing
      }
      ${pointer.at || measuring.ended ? nothing : crossAt(middle)}
    </svg>
    ${tip ? lengthSoFar(view, measuring.soFar, tip) : nothing}`;
}

/** Marks the point that the keyboard command sets. */
const crossAt = ({ x, y }: { x: number; y: number }): TemplateResult =>
  svg`${[
    ["var(--mark-light)", 3.6],
    ["var(--mark-dark)", 1.4],
  ].map(
    ([stroke, width]) =>
      svg`<path d="M${x - 13} ${y}h9M${x + 4} ${y}h9M${x} ${y - 13}v9M${x} ${y + 4}v9" stroke=${stroke} stroke-width=${width} />`,
  )}`;

function project(
  camera: OrbitCamera,
  scale: number,
  position: Vec3,
  normal: Vec3 | null,
): Seen | null {
  const at = camera.project(position);
  if (!at) return null;
  const towards =
    (normal === null || faces(camera, { position, normal })) && !camera.cutsAway(position);
  return { x: at.x / scale, y: at.y / scale, towards };
}

/**
 * Returns the path of the lines between consecutive points that `wanted` accepts. Omits lines to
 * points behind the camera.
 */
function segments(
  places: readonly (Seen | null)[],
  wanted: (from: Seen, to: Seen) => boolean,
): string {
  let path = "";
  let open = false;
  places.forEach((to, index) => {
    const from = places[index - 1];
    const drawn = from && to && wanted(from, to);
    if (drawn)
      path += `${open ? "" : `M${from.x.toFixed(1)} ${from.y.toFixed(1)}`}L${to.x.toFixed(1)} ${to.y.toFixed(1)}`;
    open = Boolean(drawn);
  });
  return path;
}
