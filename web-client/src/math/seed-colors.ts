// Compares the colors of a picture with the colors that are given inside and outside. Runs in any
// thread and has no access to the page.

import type { Picture } from "./edge-costs";
import { kInside, kOutside, kUnknown } from "./random-walker";

const kBits = 5; // of each color, so a cell of the histogram has 8 levels
const kCells = 1 << kBits;
const kSmoothing = [1, 4, 6, 4, 1].map((weight) => weight / 16);
// A color with a smaller share of both sides is rare. It leans weakly to the outside, which usually
// has more colors than the strokes cover.
const kRareShare = 1e-4;
const kRareLeaning = 0.25; // of the largest leaning

/** The largest amount of a leaning: the weight of a step between two equal pixels is 1. */
export const kMostLeaning = 0.03;

/**
 * Returns the `leaning` of each pixel for the random walker. It is positive if the color of the
 * pixel is more frequent inside, and negative if it is more frequent outside or rare on both sides.
 * It is weak if the colors of both sides hardly differ, because the edges divide the picture then.
 * It is 0 for all pixels while only one side is given.
 */
export function colorLeaning(picture: Picture, given: Uint8Array): Float32Array {
  const leaning = new Float32Array(given.length);
  const inside = sharesOf(picture, given, kInside);
  const outside = sharesOf(picture, given, kOutside);
  if (!inside || !outside) return leaning;
  const difference =
    1 - inside.reduce((sum, share, cell) => sum + Math.min(share, outside[cell]!), 0);
  const most = kMostLeaning * difference * difference;
  for (let pixel = 0; pixel < given.length; ++pixel) {
    if (given[pixel] !== kUnknown) continue;
    const cell = cellOf(picture, pixel);
    const [more, less] = [inside[cell]!, outside[cell]!];
    leaning[pixel] =
      (most * (more - less - kRareLeaning * kRareShare)) / (more + less + kRareShare);
  }
  return leaning;
}

function cellOf({ channels, pixels }: Picture, pixel: number): number {
  const levels = (channel: number): number => pixels[pixel * channels + channel]! >> (8 - kBits);
  return channels === 1 ? levels(0) : (levels(0) << (2 * kBits)) | (levels(1) << kBits) | levels(2);
}

/** Returns the share of each color on a side, smoothed. Null if no pixel is given there. */
function sharesOf(picture: Picture, given: Uint8Array, side: number): Float32Array | null {
  const strides = picture.channels === 1 ? [1] : [1, kCells, kCells * kCells];
  const shares = new Float32Array(kCells ** strides.length);
  let count = 0;
  for (let pixel = 0; pixel < given.length; ++pixel) {
    if (given[pixel] !== side) continue;
    shares[cellOf(picture, pixel)]! += 1;
    count += 1;
  }
  if (count === 0) return null;
  for (const stride of strides) smooth(shares, stride);
  return shares.map((share) => share / count);
}

function smooth(shares: Float32Array, stride: number): void {
  const margin = kSmoothing.length >> 1;
  const line = new Float32Array(kCells + 2 * margin);
  for (let start = 0; start < shares.length; ++start) {
    if (Math.floor(start / stride) % kCells !== 0) continue;
    for (let at = 0; at < kCells; ++at) line[at + margin] = shares[start + at * stride]!;
    for (let at = 0; at < kCells; ++at)
      shares[start + at * stride] = kSmoothing.reduce(
        (sum, weight, step) => sum + weight * line[at + step]!,
        0,
      );
  }
}
