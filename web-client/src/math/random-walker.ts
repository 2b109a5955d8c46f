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
const kAccuracy = 1e-3; // the size of the residual relative to that without a solution
const kMostSteps = 400; // A solution that is not accurate then still divides the picture.
// A picture with larger sides is first divided at half its size, because errors in large areas
// vanish faster there.
const kLeastHalved = 64;
// The share of the omitted elements that the preconditioner adds to its diagonal. With all of them
// it could be singular. Its diagonal is at least the last share of the matrix's diagonal.
const kModified = 0.97;
const kLeastPivot = 0.25;

/**
 * Returns the probability that a walker from each pixel reaches a given inside pixel before a given
 * outside pixel. It is 1 and 0 for the given pixels, and 0.5 where no given pixel can be reached.
 * `given` has one entry for each pixel.
 *
 * `leaning` has one number for each pixel. At each step, a walker also ends inside with the weight
 * of a positive number, or outside with the weight of a negative number. For comparison, the weight
 * of a step between two equal pixels is 1. See "Multilabel random walker image segmentation using
 * prior models" (Grady, 2005).
 *
 * Time is proportional to the number of unknown pixels times the number of steps, which grows with
 * the square root of the width of the unknown area. Throws a RangeError if a number of pixels does
 * not match the size.
 */
export function randomWalker(
  picture: Picture,
  given: Uint8Array,
  leaning: Float32Array = new Float32Array(given.length),
): Float32Array {
  const { width, height, channels, pixels } = picture;
  const count = width * height;
  if (pixels.length !== count * channels || given.length !== count || leaning.length !== count)
    throw new RangeError(
      `${pixels.length}, ${given.length} and ${leaning.length} values for ${width} × ${height}`,
    );
  const result = guess(picture, given, leaning);
  const system = systemOf(picture, given, leaning);
  const solution = new Float64Array(system.diagonal.length);
  let row = 0;
  for (let pixel = 0; pixel < count; ++pixel)
    if (given[pixel] === kUnknown) solution[++row] = result[pixel]!;
  solve(system, solution);
  row = 0;
  for (let pixel = 0; pixel < count; ++pixel) {
    const kind = given[pixel];
    result[pixel] = kind === kUnknown ? solution[++row]! : kind === kInside ? 1 : 0;
  }
  return result;
}

/** Returns values to start with: the result for the picture at half its size, or 0.5. */
function guess(picture: Picture, given: Uint8Array, leaning: Float32Array): Float32Array {
  const { width, height } = picture;
  const values = new Float32Array(given.length).fill(0.5);
  if (Math.min(width, height) < kLeastHalved) return values;
  const { half, halfGiven, halfLeaning } = halved(picture, given, leaning);
  const coarse = randomWalker(half, halfGiven, halfLeaning);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      values[y * width + x] = coarse[(y >> 1) * half.width + (x >> 1)]!;
  return values;
}

/**
 * Returns the picture, the given pixels and the leaning at half the size. Four pixels of which some
 * are inside and some are outside become unknown.
 */
function halved(
  { width, height, channels, pixels }: Picture,
  given: Uint8Array,
  leaning: Float32Array,
): { half: Picture; halfGiven: Uint8Array; halfLeaning: Float32Array } {
  const [across, down] = [(width + 1) >> 1, (height + 1) >> 1];
  const half = new Uint8Array(across * down * channels);
  const halfGiven = new Uint8Array(across * down);
  const halfLeaning = new Float32Array(across * down);
  for (let y = 0; y < down; ++y)
    for (let x = 0; x < across; ++x) {
      const at = y * across + x;
      // The pixels of the last column and row count twice if their number is odd.
      const right = 2 * x + 1 < width ? 1 : 0;
      const below = 2 * y + 1 < height ? width : 0;
      const first = 2 * y * width + 2 * x;
      const four = [first, first + right, first + below, first + below + right] as const;
      const [a, b, c, d] = four;
      for (let channel = 0; channel < channels; ++channel)
        half[at * channels + channel] =
          (pixels[a * channels + channel]! +
            pixels[b * channels + channel]! +
            pixels[c * channels + channel]! +
            pixels[d * channels + channel]! +
            2) >>
          2;
      const sides = given[a]! | given[b]! | given[c]! | given[d]!;
      halfGiven[at] = sides === (kInside | kOutside) ? kUnknown : sides;
      // Four pixels have four times the weight of one, and a step between fours has twice that of
      // one between pixels, at twice the distance.
      halfLeaning[at] = leaning[a]! + leaning[b]! + leaning[c]! + leaning[d]!;
    }
  const size = { width: across, height: down };
  return { half: { ...size, channels, pixels: half }, halfGiven, halfLeaning };
}

/**
 * The linear system. Its rows are the unknown pixels, from left to right and top to bottom, from row
 * 1 on. Row 0 and the last row are empty, and stand for neighbors that are given or absent. The
 * right neighbor of a row is the next row.
 */
interface System {
  above: Int32Array; // the row of the upper neighbor
  below: Int32Array;
  toRight: Float32Array; // the weight of the step to the right neighbor
  toBelow: Float32Array;
  diagonal: Float32Array;
  right: Float32Array; // the right side of the equation
}

function systemOf(picture: Picture, given: Uint8Array, leaning: Float32Array): System {
  const { width } = picture;
  const count = given.length;
  const squareBetween = squaresOf(picture);
  const rowOf = new Int32Array(count);
  let [rows, sum, pairs] = [0, 0, 0];
  const measure = (a: number, b: number): void => {
    sum += squareBetween(a, b);
    pairs += 1;
  };
  for (let pixel = 0; pixel < count; ++pixel) {
    if (given[pixel] !== kUnknown) continue;
    rowOf[pixel] = ++rows;
    const x = pixel % width;
    if (x > 0) measure(pixel, pixel - 1);
    if (x + 1 < width) measure(pixel, pixel + 1);
    if (pixel >= width) measure(pixel, pixel - width);
    if (pixel + width < count) measure(pixel, pixel + width);
  }
  const scale = -1 / (kContrast * Math.max(sum / Math.max(pairs, 1), 1e-6));

  const system: System = {
    above: new Int32Array(rows + 2),
    below: new Int32Array(rows + 2),
    toRight: new Float32Array(rows + 2),
    toBelow: new Float32Array(rows + 2),
    diagonal: new Float32Array(rows + 2),
    right: new Float32Array(rows + 2),
  };
  const { above, below, toRight, toBelow, diagonal, right } = system;
  // Returns the weight between two unknown pixels, and enters that to a given one.
  const step = (row: number, pixel: number, neighbor: number): number => {
    const weight = Math.exp(scale * squareBetween(pixel, neighbor)) + kLeastWeight;
    diagonal[row]! += weight;
    if (given[neighbor] === kInside) right[row]! += weight;
    return weight;
  };
  for (let pixel = 0; pixel < count; ++pixel) {
    const row = rowOf[pixel]!;
    if (row === 0) continue;
    const x = pixel % width;
    const leans = leaning[pixel]!;
    diagonal[row]! += Math.abs(leans);
    right[row]! += Math.max(0, leans);
    if (x > 0 && rowOf[pixel - 1] === 0) step(row, pixel, pixel - 1);
    if (pixel >= width && rowOf[pixel - width] === 0) step(row, pixel, pixel - width);
    if (x + 1 < width) {
      const weight = step(row, pixel, pixel + 1);
      if (rowOf[pixel + 1]! > 0) {
        toRight[row] = weight;
        diagonal[row + 1]! += weight;
      }
    }
    if (pixel + width < count) {
      const weight = step(row, pixel, pixel + width);
      const next = rowOf[pixel + width]!;
      if (next > 0) {
        toBelow[row] = weight;
        diagonal[next]! += weight;
        below[row] = next;
        above[next] = row;
      }
    }
  }
  return system;
}

/** Returns the function for the square of the difference of two pixels. */
function squaresOf({ channels, pixels }: Picture): (a: number, b: number) => number {
  if (channels === 1) return (a, b) => (pixels[a]! - pixels[b]!) ** 2;
  return (a, b) => {
    const red = pixels[4 * a]! - pixels[4 * b]!;
    const green = pixels[4 * a + 1]! - pixels[4 * b + 1]!;
    const blue = pixels[4 * a + 2]! - pixels[4 * b + 2]!;
    return red * red + green * green + blue * blue;
  };
}

/**
 * Returns the pivots of a modified incomplete Cholesky factorization without fill ("A class of
 * first order factorization methods", Gustafsson, 1978). Each is 0 or positive.
 */
function pivotsOf({ above, toRight, toBelow, diagonal }: System): Float64Array {
  const pivots = new Float64Array(diagonal.length);
  for (let row = 1; row + 1 < pivots.length; ++row) {
    const up = above[row]!;
    const left = toRight[row - 1]!;
    const upper = up > 0 ? toBelow[up]! : 0;
    let pivot = diagonal[row]!;
    if (left > 0) pivot -= (left * (left + kModified * toBelow[row - 1]!)) / pivots[row - 1]!;
    if (upper > 0) pivot -= (upper * (upper + kModified * toRight[up]!)) / pivots[up]!;
    pivots[row] = pivot > kLeastPivot * diagonal[row]! ? pivot : diagonal[row]!;
  }
  return pivots;
}

/**
 * Solves the system with the conjugate gradient method, from the values in `solution` on. The
 * preconditioner needs no multiplication with the matrix ("Efficient implementation of a class of
 * preconditioned conjugate gradient methods", Eisenstat, 1981).
 */
function solve(system: System, solution: Float64Array): void {
  const { above, below, toRight, toBelow, diagonal, right } = system;
  const last = diagonal.length - 2;
  const pivots = pivotsOf(system);
  const inverse = pivots.map((pivot) => (pivot > 0 ? 1 / pivot : 0));
  const rest = pivots.map((pivot, row) => diagonal[row]! - 2 * pivot);
  // An area that only weak steps lead to needs more digits than the weights have.
  const vector = (): Float64Array => new Float64Array(diagonal.length);
  const [residual, direction, change, applied] = [vector(), vector(), vector(), vector()];

  // Sets the residual of the values, divided by the lower factor. Returns its square.
  const begin = (values: Float64Array): number => {
    let square = 0;
    for (let row = 1; row <= last; ++row) {
      const up = above[row]!;
      const down = below[row]!;
      const own =
        right[row]! -
        diagonal[row]! * values[row]! +
        toRight[row - 1]! * values[row - 1]! +
        toRight[row]! * values[row + 1]! +
        toBelow[up]! * values[up]! +
        toBelow[row]! * values[down]!;
      residual[row] =
        inverse[row]! *
        (own + toRight[row - 1]! * residual[row - 1]! + toBelow[up]! * residual[up]!);
      square += residual[row]! * residual[row]! * pivots[row]!;
    }
    return square;
  };
  // The sides that walkers can reach: only those inside have a residual at 0, only others at 1.
  const reached = begin(vector()) + begin(vector().fill(1, 1, last + 1));
  const enough = reached * kAccuracy * kAccuracy;
  let square = begin(solution);
  let turn = 0;
  for (let step = 0; step < kMostSteps && square > enough; ++step) {
    for (let row = last; row > 0; --row) {
      direction[row] = pivots[row]! * residual[row]! + turn * direction[row]!;
      change[row] =
        inverse[row]! *
        (direction[row]! + toRight[row]! * change[row + 1]! + toBelow[row]! * change[below[row]!]!);
    }
    let product = 0;
    for (let row = 1; row <= last; ++row) {
      const up = above[row]!;
      applied[row] =
        inverse[row]! *
        (direction[row]! +
          rest[row]! * change[row]! +
          toRight[row - 1]! * applied[row - 1]! +
          toBelow[up]! * applied[up]!);
      product += direction[row]! * (applied[row]! + change[row]!);
    }
    const length = square / product;
    let next = 0;
    for (let row = 1; row <= last; ++row) {
      solution[row]! += length * change[row]!;
      const value = residual[row]! - length * (applied[row]! + change[row]!);
      residual[row] = value;
      next += value * value * pivots[row]!;
    }
    turn = next / square;
    square = next;
  }
}
