// Where raking light comes from, as a point of a round pad: the middle is the viewer's own
// direction, the rim the side.

import type { Point3 } from "../core/protocol.gen";

export interface PadPoint {
  x: number; // right, −1…1
  y: number; // up, −1…1
}

/** Light that only grazes the picture's plane shows nothing but edges. */
const kLowest_degrees = 6;
const kRim = Math.cos((kLowest_degrees * Math.PI) / 180);

export function on_pad({ x, y }: PadPoint): PadPoint {
  const length = Math.hypot(x, y);
  return length > kRim ? { x: (x / length) * kRim, y: (y / length) * kRim } : { x, y };
}

/** Towards the light in the eye's axes: x right, y up, z towards the viewer. */
export function direction_of(point: PadPoint): Point3 {
  const { x, y } = on_pad(point);
  return [x, y, Math.sqrt(1 - x * x - y * y)];
}

export function pad_point(direction: Point3): PadPoint {
  const length = Math.hypot(...direction) || 1;
  return on_pad({ x: direction[0] / length, y: direction[1] / length });
}

/** Degrees clockwise from the top, 0…360, and above the picture's plane. */
export function angles_of(point: PadPoint): { from: number; above: number } {
  const { x, y } = on_pad(point);
  return {
    from: Math.round(((Math.atan2(x, y) * 180) / Math.PI + 360) % 360),
    above: Math.round((Math.acos(Math.min(1, Math.hypot(x, y))) * 180) / Math.PI),
  };
}
