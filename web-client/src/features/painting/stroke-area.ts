// Finds an area of the shown frame from strokes inside and outside of it, with a random walker. The
// whole frame is divided at a low resolution. Then the border of the area is divided again in the
// resolution of the frame.

import type { Picture } from "../../math/edge-costs";
import { kInside, kOutside, kUnknown, randomWalker } from "../../math/random-walker";
import { colorLeaning } from "../../math/seed-colors";
import type { Point } from "../../net/stroke";
import { markNear, partsAbove, signedArea, simplified, type Ring, type Size } from "./masks";
import type { SharpFrame } from "./sharp-frame";

export interface AreaStroke {
  inside: boolean;
  path: readonly Point[];
}

/** An outline around a part of the area, or around a hole of the parts before it. */
export interface AreaRing {
  hole: boolean;
  path: Point[];
}

/** The longer side of the frame at low resolution, in pixels. It limits the time. */
export const kMostSide = 400;
/** The largest number of outlines of an area. */
export const kMostRings = 16;
/** The largest number of points of all outlines of an area. */
export const kMostRingPoints = 4096;
// A border with more pixels of the frame keeps the low resolution.
const kMostBorder = 300_000;
const kLeastRadius = 0.75; // of a stroke at low resolution
const kTolerance = 0.75; // of the simplified outlines, in pixels of the frame

/**
 * Returns the outlines of the area, with large parts first. The result is empty if all strokes are
 * on the same side. `strokes` are in pixels of the frame, where later ones cover earlier ones. Parts
 * and holes of the area that are smaller than a dot of a stroke are left out.
 */
export function areaOfStrokes(
  frame: SharpFrame,
  strokes: readonly AreaStroke[],
  radius: number,
): AreaRing[] {
  const step = Math.ceil(Math.max(frame.width, frame.height) / kMostSide);
  const picture = shrunk(frame, step);
  const given = seedsOf(picture, strokes, step, radius);
  if (!given.includes(kInside) || !given.includes(kOutside)) return [];
  const values = randomWalker(picture, given, colorLeaning(picture, given));
  keepReached(values, given, picture);
  const fine = step > 1 ? borderOf(frame, values, picture, step, strokes, radius) : null;
  const parts = fine
    ? moved(partsAbove(fine.values, fine), fine, 1)
    : moved(partsAbove(values, picture), { x: 0, y: 0 }, step);
  return ringsOf(parts, Math.PI * radius ** 2);
}

/** Returns the frame at a lower resolution. A pixel is the mean of `step` × `step` pixels. */
function shrunk(frame: SharpFrame, step: number): Picture {
  const { width, height } = frame;
  const pixels = frame.read(0, 0, width, height);
  if (step === 1) return { width, height, channels: 4, pixels };
  const [across, down] = [Math.ceil(width / step), Math.ceil(height / step)];
  const small = new Uint8ClampedArray(4 * across * down);
  for (let y = 0; y < down; ++y)
    for (let x = 0; x < across; ++x) {
      let [red, green, blue, count] = [0, 0, 0, 0];
      for (let fromY = y * step; fromY < Math.min(height, (y + 1) * step); ++fromY)
        for (let fromX = x * step; fromX < Math.min(width, (x + 1) * step); ++fromX) {
          const at = 4 * (fromY * width + fromX);
          red += pixels[at]!;
          green += pixels[at + 1]!;
          blue += pixels[at + 2]!;
          count += 1;
        }
      const to = 4 * (y * across + x);
      small[to] = red / count;
      small[to + 1] = green / count;
      small[to + 2] = blue / count;
      small[to + 3] = 255;
    }
  return { width: across, height: down, channels: 4, pixels: small };
}

/** Returns the sides of the pixels that strokes cover. */
function seedsOf(
  size: Size,
  strokes: readonly AreaStroke[],
  step: number,
  radius: number,
): Uint8Array {
  const given = new Uint8Array(size.width * size.height);
  const reach = Math.max(radius / step, kLeastRadius);
  for (const { inside, path } of strokes) {
    const line = path.map(([x, y]): Point => [x / step, y / step]);
    markNear(line, reach, size, given, inside ? kInside : kOutside);
  }
  return given;
}

/** Removes the parts above 0.5 that no inside pixel is connected with. */
function keepReached(values: Float32Array, given: Uint8Array, { width, height }: Size): void {
  const reached = new Uint8Array(values.length);
  const waiting: number[] = [];
  const reach = (pixel: number): void => {
    if (reached[pixel] || values[pixel]! <= 0.5) return;
    reached[pixel] = 1;
    waiting.push(pixel);
  };
  given.forEach((kind, pixel) => {
    if (kind === kInside) reach(pixel);
  });
  for (let pixel = waiting.pop(); pixel !== undefined; pixel = waiting.pop()) {
    const x = pixel % width;
    if (x > 0) reach(pixel - 1);
    if (x + 1 < width) reach(pixel + 1);
    if (pixel >= width) reach(pixel - width);
    if (pixel + width < width * height) reach(pixel + width);
  }
  values.forEach((value, pixel) => {
    if (value > 0.5 && !reached[pixel]) values[pixel] = 0;
  });
}

interface Divided extends Size {
  x: number;
  y: number;
  values: Float32Array;
}

/**
 * Divides the pixels of the frame near the border of the area. Returns null if there are too many
 * of them. The other pixels have the side that they have at low resolution.
 */
function borderOf(
  frame: SharpFrame,
  values: Float32Array,
  size: Size,
  step: number,
  strokes: readonly AreaStroke[],
  radius: number,
): Divided | null {
  const kinds = kindsOf(values, size);
  const box = boxAround(kinds, size, step, frame);
  const given = new Uint8Array(box.width * box.height);
  let unknown = 0;
  for (let y = 0; y < box.height; ++y) {
    const row = Math.floor((y + box.y) / step) * size.width;
    for (let x = 0; x < box.width; ++x) {
      const kind = kinds[row + Math.floor((x + box.x) / step)]!;
      given[y * box.width + x] = kind;
      unknown += Number(kind === kUnknown);
    }
  }
  if (unknown > kMostBorder) return null;
  const local = strokes.map(({ inside, path }) => ({
    inside,
    path: path.map(([x, y]): Point => [x - box.x, y - box.y]),
  }));
  seedsOf(box, local, 1, radius).forEach((kind, pixel) => {
    if (kind !== kUnknown) given[pixel] = kind;
  });
  const pixels = frame.read(box.x, box.y, box.width, box.height);
  const picture = { width: box.width, height: box.height, channels: 4 as const, pixels };
  return { ...box, values: randomWalker(picture, given, colorLeaning(picture, given)) };
}

/** Returns the sides of the pixels. Those with a neighbor on the other side are unknown. */
function kindsOf(values: Float32Array, { width, height }: Size): Uint8Array {
  return Uint8Array.from(values, (value, pixel) => {
    const [x, y] = [pixel % width, Math.floor(pixel / width)];
    const isInside = value > 0.5;
    for (let nearY = Math.max(0, y - 1); nearY <= Math.min(height - 1, y + 1); ++nearY)
      for (let nearX = Math.max(0, x - 1); nearX <= Math.min(width - 1, x + 1); ++nearX)
        if (values[nearY * width + nearX]! > 0.5 !== isInside) return kUnknown;
    return isInside ? kInside : kOutside;
  });
}

/** Returns the rectangle of the frame with all pixels that can be inside, and their neighbors. */
function boxAround(
  kinds: Uint8Array,
  { width, height }: Size,
  step: number,
  frame: SharpFrame,
): Size & { x: number; y: number } {
  let [left, top, right, bottom] = [width, height, 0, 0];
  kinds.forEach((kind, pixel) => {
    if (kind === kOutside) return;
    const [x, y] = [pixel % width, Math.floor(pixel / width)];
    [left, right] = [Math.min(left, x), Math.max(right, x)];
    [top, bottom] = [Math.min(top, y), Math.max(bottom, y)];
  });
  const x = Math.max(0, left * step - 1);
  const y = Math.max(0, top * step - 1);
  return {
    x,
    y,
    width: Math.min(frame.width, (right + 1) * step + 1) - x,
    height: Math.min(frame.height, (bottom + 1) * step + 1) - y,
  };
}

const moved = (parts: Ring[][], by: { x: number; y: number }, step: number): Ring[][] =>
  parts.map((rings) =>
    rings.map((ring) => ring.map(([x, y]) => [x * step + by.x, y * step + by.y])),
  );

/** Returns the outlines of the largest parts and of their holes. */
function ringsOf(parts: readonly Ring[][], leastArea: number): AreaRing[] {
  const areaOf = (ring: Ring): number => Math.abs(signedArea(ring));
  const rings = parts
    .map((part) => part.filter((ring) => areaOf(ring) >= leastArea))
    .filter(([outer], at) => outer !== undefined && outer === parts[at]![0])
    .sort(([a], [b]) => areaOf(b!) - areaOf(a!))
    .flatMap((part) => part.map((ring, at) => ({ ring, hole: at > 0 })))
    .slice(0, kMostRings);
  for (let tolerance = kTolerance; ; tolerance *= 2) {
    const found = rings
      .map(({ ring, hole }) => ({ hole, path: simplified(ring, tolerance) }))
      .filter(({ path }) => path.length >= 3);
    if (found.reduce((sum, { path }) => sum + path.length, 0) <= kMostRingPoints) return found;
  }
}
