// The direction of raking light, as a point on a round pad. The middle of the pad is light from the
// viewing direction, and the rim is light from the side.

import type { Point3 } from "../core/protocol.gen";

export interface PadPoint {
  x: number; // right, −1…1
  y: number; // up, −1…1
}

/**
 * The lowest angle of the light. Light that is nearly parallel to the image plane shows only edges.
 */
const kLowestDegrees = 6;
const kRim = Math.cos((kLowestDegrees * Math.PI) / 180);

export function onPad({ x, y }: PadPoint): PadPoint {
  const length = Math.hypot(x, y);
  return length > kRim ? { x: (x / length) * kRim, y: (y / length) * kRim } : { x, y };
}

/**
 * Returns the direction to the light in the axes of the eye: x right, y up, z towards the viewer.
 */
export function directionOf(point: PadPoint): Point3 {
  const { x, y } = onPad(point);
  return [x, y, Math.sqrt(1 - x * x - y * y)];
}

export function padPoint(direction: Point3): PadPoint {
  const length = Math.hypot(...direction) || 1;
  return onPad({ x: direction[0] / length, y: direction[1] / length });
}

/**
 * Returns the angles of the light in degrees: clockwise from the top, 0…360, and above the image
 * plane.
 */
export function anglesOf(point: PadPoint): { from: number; above: number } {
  const { x, y } = onPad(point);
  return {
    from: Math.round(((Math.atan2(x, y) * 180) / Math.PI + 360) % 360),
    above: Math.round((Math.acos(Math.min(1, Math.hypot(x, y))) * 180) / Math.PI),
  };
}
