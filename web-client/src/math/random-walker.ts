// Divides a picture into inside and outside, as in "Random walks for image segmentation" (Grady,
// 2006). A walker from a pixel between the given inside and outside rarely crosses strong
// edges. The probability that it reaches the inside first is the solution of a sparse linear system.
// Runs in any thread and has no access to the page.

import type { Picture } from "./edge-costs";

/** The side on which a pixel is known to be. */
export const kUnknown = 0;
export const kInside = 1;
export const kOutside = 2;

// The weight of a step between two pixels falls with the square of their difference. It is 1 / e for
// this multiple of the mean square. Without the last term, a walker could not leave some pixels.
const kContrast = 1;
const kLeastWeight = 1e-4;
const kAccuracy = 1e-3; // the size of the residual relative to the first one
const kMostSteps = 400; // A solution that is not accurate then still divides the picture.

/**
 * Returns the probability that a walker from each pixel reaches a given inside pixel before a given
 * outside pixel. It is 1 and 0 for the given pixels, and 0.5 where no given pixel can be reached.
 * `given` has one entry for each pixel. Time is proportional to the number of unknown pixels times
 * the number of steps, which grows with the width of the unknown area. Throws a RangeError if a
 * number of pixels does not match the size.
 */
export function randomWalker(picture: Picture, given: Uint8Array): Float32Array {
  const { width, height, channels, pixels } = picture;
  const count = width * height;
  if (pixels.length !== count * channels || given.length !== count)
    throw new RangeError(`${pixels.length} and ${given.length} values for ${width} × ${height}`);
  const result = Float32Array.from(given, (kind) => (kind === kInside ? 1 : 0));
  const system = systemOf(picture, given);
  const solution = solve(system);
  system.pixelOf.forEach((pixel, at) => (result[pixel] = solution[at]!));
  return result;
}

/** The linear system. Its rows are the unknown pixels. */
interface System {
  pixelOf: Int32Array;
  /** The rows of the four neighbors; -1 for a neighbor that is given or absent. */
  neighbors: Int32Array;
  weights: Float32Array; // of the same four neighbors
  diagonal: Float32Array;
  right: Float32Array;
}

function systemOf({ width, height, channels, pixels }: Picture, given: Uint8Array): System {
  const rowOf = new Int32Array(given.length).fill(-1);
  let rows = 0;
  given.forEach((kind, pixel) => {
    if (kind === kUnknown) rowOf[pixel] = rows++;
  });
  const pixelOf = new Int32Array(rows);
  const neighbors = new Int32Array(4 * rows).fill(-1);
  const weights = new Float32Array(4 * rows);
  const diagonal = new Float32Array(rows);
  const right = new Float32Array(rows);
  const colors = channels === 1 ? 1 : 3;
  const squareBetween = (a: number, b: number): number => {
    let square = 0;
    for (let color = 0; color < colors; ++color) {
      const difference = pixels[a * channels + color]! - pixels[b * channels + color]!;
      square += difference * difference;
    }
    return square;
  };

  const steps = [-1, 1, -width, width] as const;
  let [sum, pairs] = [0, 0];
  given.forEach((kind, pixel) => {
    if (kind !== kUnknown) return;
    const row = rowOf[pixel]!;
    pixelOf[row] = pixel;
    const x = pixel % width;
    const exists = [x > 0, x + 1 < width, pixel >= width, pixel + width < width * height];
    steps.forEach((step, side) => {
      const at = 4 * row + side;
      weights[at] = exists[side] ? squareBetween(pixel, pixel + step) : -1;
      if (exists[side]) [sum, pairs] = [sum + weights[at], pairs + 1];
    });
  });
  const scale = kContrast * Math.max(sum / Math.max(pairs, 1), 1e-6);
  for (let row = 0; row < rows; ++row)
    for (let side = 0; side < 4; ++side) {
      const at = 4 * row + side;
      if (weights[at]! < 0) {
        weights[at] = 0;
        continue;
      }
      const weight = Math.exp(-weights[at]! / scale) + kLeastWeight;
      const neighbor = pixelOf[row]! + steps[side]!;
      neighbors[at] = rowOf[neighbor]!;
      weights[at] = weight;
      diagonal[row]! += weight;
      if (given[neighbor] === kInside) right[row]! += weight;
    }
  return { pixelOf, neighbors, weights, diagonal, right };
}

/** Solves the system with the conjugate gradient method, preconditioned by the diagonal. */
function solve({ neighbors, weights, diagonal, right }: System): Float32Array {
  const rows = diagonal.length;
  const solution = new Float32Array(rows).fill(0.5);
  const applied = new Float32Array(rows);
  const apply = (vector: Float32Array): void => {
    for (let row = 0; row < rows; ++row) {
      let sum = diagonal[row]! * vector[row]!;
      for (let at = 4 * row; at < 4 * row + 4; ++at) {
        const neighbor = neighbors[at]!;
        if (neighbor >= 0) sum -= weights[at]! * vector[neighbor]!;
      }
      applied[row] = sum;
    }
  };
  const inverse = diagonal.map((value) => (value > 0 ? 1 / value : 0));
  apply(solution);
  const residual = right.map((value, row) => value - applied[row]!);
  const direction = residual.map((value, row) => value * inverse[row]!);
  let square = dotOf(residual, direction);
  const enough = square * kAccuracy * kAccuracy;
  for (let step = 0; step < kMostSteps && square > enough; ++step) {
    apply(direction);
    const length = square / dotOf(direction, applied);
    for (let row = 0; row < rows; ++row) {
      solution[row]! += length * direction[row]!;
      residual[row]! -= length * applied[row]!;
    }
    let next = 0;
    for (let row = 0; row < rows; ++row) next += residual[row]! * residual[row]! * inverse[row]!;
    const turn = next / square;
    square = next;
    for (let row = 0; row < rows; ++row)
      direction[row] = residual[row]! * inverse[row]! + turn * direction[row]!;
  }
  return solution;
}

function dotOf(a: Float32Array, b: Float32Array): number {
  let sum = 0;
  for (let at = 0; at < a.length; ++at) sum += a[at]! * b[at]!;
  return sum;
}
