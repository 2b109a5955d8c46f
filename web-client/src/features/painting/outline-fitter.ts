// Fits a freely drawn outline to edges in the shown frame. Pixels near the outline may be inside or
// outside, and a random walker between the two sides decides. Where it finds no edge, the outline
// stays about where it was drawn.

import { kInside, kOutside, kUnknown, randomWalker } from "../../math/random-walker";
import type { Point } from "../../net/stroke";
import { markNear, partsAbove, signedArea, simplified, type Ring, type Size } from "./masks";
import type { SharpFrame } from "./sharp-frame";

/** The distance in CSS pixels by which an outline can move to an edge. */
export const kFitReach = 12;
/** Outlines in larger rectangles of the frame stay as drawn. */
export const kMostFitPixels = 4_000_000;
/** Outlines with more pixels near them stay as drawn, because the page would not respond. */
export const kMostUnknown = 500_000;

// The reach is at most this share of the width of a long strip, so its middle stays inside.
const kWidthShare = 0.35;
const kLeastReach = 2; // pixels of the frame
const kTolerance = 0.75; // of the simplified outline, in pixels of the frame
// An outline that crosses itself has several parts. If the largest part of the result has less than
// this share of its area, the outline stays as drawn.
const kMainShare = 0.9;

/** A rectangle of the frame. */
interface Box extends Size {
  x: number;
  y: number;
}

/**
 * Returns an outline on edges near a closed outline, or the outline itself if it does not fit.
 * `outline` is in pixels of the frame, and `reach` is the distance in the same pixels by which it
 * can move.
 */
export function fittedOutline(
  frame: SharpFrame,
  outline: readonly Point[],
  reach: number,
): Point[] {
  const asDrawn = [...outline];
  const width = Math.min(reach, kWidthShare * widthOf(outline));
  const box = boxOf(outline, width, frame);
  if (width < kLeastReach || !box || box.width * box.height > kMostFitPixels) return asDrawn;
  const drawn = outline.map(([x, y]): Point => [x - box.x, y - box.y]);
  const given = insideOf(drawn, box);
  // Pixels that are at most as far from the outline as it can move are unknown.
  markNear([...drawn, drawn[0]!], width, box, given, kUnknown);
  const unknown = given.reduce((count, kind) => count + Number(kind === kUnknown), 0);
  if (!given.includes(kInside) || unknown > kMostUnknown) return asDrawn;
  const pixels = frame.read(box.x, box.y, box.width, box.height);
  const picture = { width: box.width, height: box.height, channels: 4 as const, pixels };
  const ring = mainRing(randomWalker(picture, given), box);
  const fitted = ring ? simplified(ring, kTolerance) : [];
  // A row of single pixels can become a line.
  return fitted.length >= 3 ? fitted.map(([x, y]) => [x + box.x, y + box.y]) : asDrawn;
}

/** Returns about the width of a long strip with the same area and border. */
function widthOf(outline: readonly Point[]): number {
  let border = 0;
  outline.forEach(([x, y], at) => {
    const [nextX, nextY] = outline[(at + 1) % outline.length]!;
    border += Math.hypot(nextX - x, nextY - y);
  });
  return border > 0 ? (2 * Math.abs(signedArea(outline))) / border : 0;
}

/** Returns the rectangle of the frame with all pixels that can be inside, and with their neighbors. */
function boxOf(outline: readonly Point[], reach: number, frame: SharpFrame): Box | null {
  const range = (axis: 0 | 1, size: number): { at: number; size: number } => {
    const values = outline.map((point) => point[axis]);
    const from = Math.max(0, Math.floor(Math.min(...values) - reach) - 1);
    const to = Math.min(size, Math.ceil(Math.max(...values) + reach) + 1);
    return { at: from, size: to - from };
  };
  const across = range(0, frame.width);
  const down = range(1, frame.height);
  if (across.size < 1 || down.size < 1) return null;
  return { x: across.at, y: down.at, width: across.size, height: down.size };
}

/** Divides the pixels of a rectangle by the outline that is drawn in it. */
function insideOf(outline: readonly Point[], { width, height }: Box): Uint8Array {
  const given = new Uint8Array(width * height).fill(kOutside);
  for (let y = 0; y < height; ++y) {
    const crossings: number[] = [];
    outline.forEach(([x0, y0], at) => {
      const [x1, y1] = outline[(at + 1) % outline.length]!;
      const middle = y + 0.5;
      if (y0 <= middle === y1 <= middle) return;
      crossings.push(x0 + ((middle - y0) / (y1 - y0)) * (x1 - x0));
    });
    crossings.sort((a, b) => a - b);
    for (let at = 0; at + 1 < crossings.length; at += 2) {
      const from = Math.max(0, Math.ceil(crossings[at]! - 0.5));
      const to = Math.min(width, Math.ceil(crossings[at + 1]! - 0.5));
      if (from < to) given.fill(kInside, y * width + from, y * width + to);
    }
  }
  return given;
}

/** Returns the largest outline around the inside, or null if it does not have most of the inside. */
function mainRing(inside: Float32Array, box: Box): Ring | null {
  const rings = partsAbove(inside, box).map(([outer]) => outer!);
  let [main, most, sum]: [Ring | null, number, number] = [null, 0, 0];
  for (const ring of rings) {
    const area = Math.abs(signedArea(ring));
    sum += area;
    if (area > most) [main, most] = [ring, area];
  }
  return most >= kMainShare * sum ? main : null;
}
