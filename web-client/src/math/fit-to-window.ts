// Follows another camera: computes the position from which this window shows the content of the
// other camera's window.

import {
  boundingRadius,
  centre,
  kFrames,
  kHalfFieldTangent,
  placeOf,
  type CameraMessage,
  type OrbitCamera,
  type Place,
} from "./camera";
import { add, dot, length, scale, subtract, type Vec3 } from "./vector";

// The distance of the target from the eye, relative to the model's radius, if the middle of the
// model is behind the eye.
const kNearest = 0.02;
// A tolerance for lengths relative to the distance, and for radians. It is less than a pixel in
// most windows.
const kArrived = 5e-4;

/**
 * Returns the position for `own` with the eye and direction of the other camera. The field of view
 * includes the other camera's whole window, for any aspect ratio of this window. A tilted horizon
 * and an off-axis window are ignored, because cameras of this page never have them.
 */
export function placeLike(
  theirs: Pick<CameraMessage, "view" | "projection">,
  own: OrbitCamera,
): Place {
  const { view, projection } = theirs;
  const row = (r: number): Vec3 => [view[r]!, view[4 + r]!, view[8 + r]!];
  const enlarged = length(row(2));
  const [right, up, back] = [row(0), row(1), row(2)].map((axis) =>
    scale(axis, 1 / length(axis)),
  ) as [Vec3, Vec3, Vec3];
  const eye = scale(
    add(add(scale(right, view[12]!), scale(up, view[13]!)), scale(back, view[14]!)),
    -1 / enlarged,
  );
  const perspective = projection[11] !== 0;
  const [across, along] = [1 / Math.abs(projection[0]!), 1 / Math.abs(projection[5]!)];
  const half = Math.max(along, (across * own.height) / own.width);
  const toMiddle = dot(subtract(eye, centre(own.bounds)), back);
  const depth = perspective ? Math.max(toMiddle, boundingRadius(own.bounds) * kNearest) : toMiddle;
  const frame = kFrames[own.up];
  return {
    target: subtract(eye, scale(back, depth)),
    distance: perspective ? depth : half / kHalfFieldTangent,
    azimuth: Math.atan2(dot(right, frame.into), dot(right, frame.right)),
    elevation: Math.asin(Math.min(1, Math.max(-1, dot(back, frame.up)))),
    perspective,
    halfField: perspective ? half : kHalfFieldTangent,
  };
}

/** Whether the remaining distance to `place` is too small to be visible. */
export function hasArrived(camera: OrbitCamera, place: Place): boolean {
  const here = placeOf(camera);
  const close = (a: number, b: number): boolean => Math.abs(a - b) <= kArrived;
  return (
    here.perspective === place.perspective &&
    length(subtract(here.target, place.target)) <= kArrived * place.distance &&
    close(here.distance / place.distance, 1) &&
    close(here.halfField / place.halfField, 1) &&
    close(Math.cos(here.azimuth - place.azimuth), 1) &&
    close(Math.sin(here.azimuth - place.azimuth), 0) &&
    close(here.elevation, place.elevation)
  );
}
