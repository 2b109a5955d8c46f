// Masks of the pixels in a rectangle of the frame, and outlines around their parts.

import { contours } from "d3-contour";
import { simplifyLine } from "../../domain/marks";
import type { Point } from "../../net/stroke";

export type Ring = [number, number][];

export interface Size {
  width: number;
  height: number;
}

/** Sets all pixels of a mask that are at most `reach` from a line. */
export function markNear(
  line: readonly Point[],
  reach: number,
  { width, height }: Size,
  mask: Uint8Array,
  value: number,
): void {
  const markAround = (centerX: number, centerY: number): void => {
    const first = Math.max(0, Math.ceil(centerY - reach - 0.5));
    const last = Math.min(height - 1, Math.floor(centerY + reach - 0.5));
    for (let y = first; y <= last; ++y) {
      const half = Math.sqrt(Math.max(0, reach ** 2 - (y + 0.5 - centerY) ** 2));
      const from = Math.max(0, Math.ceil(centerX - half - 0.5));
      const to = Math.min(width, Math.floor(centerX + half - 0.5) + 1);
      if (from < to) mask.fill(value, y * width + from, y * width + to);
    }
  };
  line.forEach(([x, y], at) => {
    const [nextX, nextY] = line[Math.min(at + 1, line.length - 1)]!;
    const steps = Math.max(1, Math.ceil(Math.hypot(nextX - x, nextY - y)));
    for (let step = 0; step < steps; ++step)
      markAround(x + ((nextX - x) * step) / steps, y + ((nextY - y) * step) / steps);
  });
}

/**
 * Returns the parts of a picture whose values are above 0.5. The first ring of a part is around it,
 * and the others are around its holes. The last point of a ring equals the first.
 */
export function partsAbove(values: Float32Array, { width, height }: Size): Ring[][] {
  const { coordinates } = contours().size([width, height]).contour(Array.from(values), 0.5);
  return coordinates as Ring[][];
}

/** Returns the area of a ring or outline. The sign depends on its direction. */
export function signedArea(ring: readonly (readonly [number, number])[]): number {
  let twice = 0;
  ring.forEach(([x, y], at) => {
    const [nextX, nextY] = ring[(at + 1) % ring.length]!;
    twice += x * nextY - nextX * y;
  });
  return twice / 2;
}

/** Returns fewer points of a ring, at most `tolerance` pixels away, and the first one only once. */
export function simplified(ring: Ring, tolerance: number): Ring {
  const places = ring.map(([x, y]): [number, number, number] => [x, y, 0]);
  return simplifyLine(places, () => tolerance)
    .slice(0, -1)
    .map(([x, y]) => [x, y]);
}
