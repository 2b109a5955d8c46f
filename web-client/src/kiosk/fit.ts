// The camera of a stop in the kiosk's window. A saved view has a different aspect ratio than most
// kiosk screens, and empty space around the object. The kiosk shows only the part of the object
// inside the saved window, in the middle of its own window.

import type { Bounds, CameraMessage, OrbitCamera, Place } from "../math/camera";
import { kHalfFieldTangent } from "../math/camera";
import { placeLike } from "../math/fit-to-window";
import { add, length, scale, transform, type Vec3 } from "../math/vector";

const kMargin = 1.02; // the bounding box already leaves some space around the object
const kRounds = 4; // sufficient to find the middle

/**
 * Converts the camera `theirs` to a position of `own` that shows the object as large as possible.
 */
export function placeOfObject(
  theirs: Pick<CameraMessage, "view" | "projection">,
  own: OrbitCamera,
): Place {
  const place = placeLike(theirs, own);
  const { view, projection } = theirs;
  const perspective = projection[11] !== 0;
  const depth = perspective ? place.distance : 1;
  const [across, along] = [1 / Math.abs(projection[0]!), 1 / Math.abs(projection[5]!)];
  const corners = cornersOf(view, own.bounds);
  // the eye is inside the box
  if (perspective && corners.some(([, , back]) => back >= 0)) return place;
  let [aside, above] = [0, 0]; // offset of the eye
  let [halfWidth, halfHeight] = [0, 0];
  // If the eye moves, near corners shift more than far corners, so several rounds are necessary.
  for (let round = 0; round < kRounds; ++round) {
    const xs = corners.map(([x, , back]) => (x - aside) / (perspective ? -back : 1));
    const ys = corners.map(([, y, back]) => (y - above) / (perspective ? -back : 1));
    const left = Math.max(Math.min(...xs), -across - aside / depth);
    const right = Math.min(Math.max(...xs), across - aside / depth);
    const bottom = Math.max(Math.min(...ys), -along - above / depth);
    const top = Math.min(Math.max(...ys), along - above / depth);
    [halfWidth, halfHeight] = [(right - left) / 2, (top - bottom) / 2];
    if (halfWidth <= 0 || halfHeight <= 0) return place; // the view shows no part of the object
    aside += ((left + right) / 2) * depth;
    above += ((bottom + top) / 2) * depth;
  }
  const half = Math.min(
    perspective ? place.halfField : place.distance * kHalfFieldTangent,
    kMargin * Math.max(halfHeight, (halfWidth * own.height) / own.width),
  );
  const axis = (row: number): Vec3 => {
    const unscaled: Vec3 = [view[row]!, view[4 + row]!, view[8 + row]!];
    return scale(unscaled, 1 / length(unscaled));
  };
  const target = add(place.target, add(scale(axis(0), aside), scale(axis(1), above)));
  return perspective
    ? { ...place, target, halfField: half }
    : { ...place, target, distance: half / kHalfFieldTangent };
}

/** Returns the corners of the box in the axes of the view: right, up, and towards the eye. */
function cornersOf(view: readonly number[], { min, max }: Bounds): Vec3[] {
  const enlarged = Math.hypot(view[2]!, view[6]!, view[10]!);
  return Array.from({ length: 8 }, (_, corner): Vec3 => {
    const [x, y, back] = transform(view, [
      corner & 1 ? max[0] : min[0],
      corner & 2 ? max[1] : min[1],
      corner & 4 ? max[2] : min[2],
      1,
    ]);
    return [x / enlarged, y / enlarged, back / enlarged];
  });
}
