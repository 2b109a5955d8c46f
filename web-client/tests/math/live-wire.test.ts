import fc from "fast-check";
import { describe, expect, it } from "vitest";
import { edgeCosts, kMaxCost, kMinCost, type Picture } from "../../src/math/edge-costs";
import {
  costOfStraight,
  kDiagonal,
  kMaxPixels,
  kStraight,
  LeastCostPaths,
} from "../../src/math/least-cost-paths";
import { noise } from "../pictures";

type Pixel = [number, number];

/** Makes a gray picture. `valueAt` gets the middle of each pixel. */
function gray(size: number, valueAt: (x: number, y: number) => number): Picture {
  const pixels = new Uint8ClampedArray(size * size);
  for (let at = 0; at < pixels.length; ++at)
    pixels[at] = Math.round(valueAt((at % size) + 0.5, Math.floor(at / size) + 0.5));
  return { width: size, height: size, channels: 1, pixels };
}

/** The share of a pixel at this signed distance from a straight border that is inside of it. */
const covered = (distance: number): number => Math.min(1, Math.max(0, 0.5 - distance));

/** Returns the middles of the pixels of the path along edges. */
function follow(picture: Picture, from: Pixel, to: Pixel): Pixel[] {
  const costs = edgeCosts(picture);
  return new LeastCostPaths(costs, picture.width, picture.height, from)
    .pathTo(to)
    .map(([x, y]) => [x + 0.5, y + 0.5]);
}

describe("A path along edges", () => {
  const kRadius = 60;
  const out = (x: number, y: number): number => Math.hypot(x - 100, y - 100) - kRadius;
  const onCircle = (degrees: number): Pixel => {
    const turn = (degrees * Math.PI) / 180;
    return [Math.floor(100 + kRadius * Math.cos(turn)), Math.floor(100 + kRadius * Math.sin(turn))];
  };

  it.each([
    ["a sharp border", 0, 170, 80],
    ["a border between similar values", 0, 130, 120],
    ["a border in noise", 10, 170, 110],
  ])("stays within a pixel of %s of a disc", (_, deviation, inside, outside) => {
    const random = noise(deviation);
    const disc = gray(200, (x, y) => outside + (inside - outside) * covered(out(x, y)) + random());
    const path = follow(disc, onCircle(10), onCircle(160));
    expect(path.length).toBeGreaterThan(90); // the chord has about 115 pixels, the arc more
    expect(Math.max(...path.map(([x, y]) => Math.abs(out(x, y))))).toBeLessThanOrEqual(1);
    const turns = path.map(([x, y]) => Math.atan2(y - 100, x - 100));
    expect(Math.max(...turns)).toBeLessThan((165 * Math.PI) / 180);
    expect(Math.min(...turns)).toBeGreaterThan((5 * Math.PI) / 180);
  });

  it.each([1, 2, 3])("stays within a pixel of the middle of a crack %d pixels wide", (wide) => {
    const random = noise(6);
    const middle = (x: number): number => 100 + 30 * Math.sin(x / 28);
    const slope = (x: number): number => (30 / 28) * Math.cos(x / 28);
    // the distance from the curve, which is nearly straight within a few pixels
    const off = (x: number, y: number): number => Math.abs(y - middle(x)) / Math.hypot(1, slope(x));
    const crack = gray(200, (x, y) => 150 - 70 * covered(off(x, y) - wide / 2) + random());
    const at = (x: number): Pixel => [x, Math.floor(middle(x + 0.5))];
    const path = follow(crack, at(12), at(187));
    expect(Math.max(...path.map(([x, y]) => off(x, y)))).toBeLessThanOrEqual(1);
  });

  it("follows a border between colors of the same brightness", () => {
    const size = 60;
    const pixels = new Uint8ClampedArray(4 * size * size);
    for (let at = 0; at < size * size; ++at)
      pixels.set(at % size < 30 ? [150, 90, 90, 255] : [90, 150, 90, 255], 4 * at);
    const path = follow({ width: size, height: size, channels: 4, pixels }, [29, 2], [30, 57]);
    expect(Math.max(...path.map(([x]) => Math.abs(x - 30)))).toBeLessThan(1);
  });
});

describe("The costs of a picture", () => {
  it("are highest where it is flat, up to its border", () => {
    const costs = edgeCosts(gray(40, () => 77));
    expect(new Set(costs)).toEqual(new Set([kMaxCost]));
  });

  it("are low on a strong edge, and within their limits everywhere", () => {
    const random = noise(40);
    const costs = edgeCosts(gray(64, (x) => (x < 32 ? 20 : 230) + random()));
    expect(Math.min(...costs)).toBeGreaterThanOrEqual(kMinCost);
    const column = (x: number): number => {
      let sum = 0;
      for (let y = 0; y < 64; ++y) sum += costs[64 * y + x]!;
      return sum / 64;
    };
    expect(Math.min(column(31), column(32))).toBeLessThan(column(10) / 3);
  });

  it("exist for a single pixel, and for single rows and columns", () => {
    for (const [width, height] of [
      [1, 1],
      [9, 1],
      [1, 9],
    ] as const)
      expect(
        edgeCosts({ width, height, channels: 1, pixels: new Uint8Array(width * height) }),
      ).toEqual(new Uint8Array(width * height).fill(kMaxCost));
  });

  it("are refused for a wrong number of pixels", () => {
    for (const [width, height, count] of [
      [4, 4, 15],
      [0, 0, 0],
      [Number.NaN, 4, 16],
    ] as const)
      expect(() =>
        edgeCosts({ width, height, channels: 1, pixels: new Uint8Array(count) }),
      ).toThrow(RangeError);
  });
});

describe("The paths of least cost", () => {
  /** Relaxes all steps until nothing changes (Bellman and Ford). */
  function bruteForce(costs: Uint8Array, width: number, height: number, seed: Pixel): number[] {
    const best = new Array<number>(costs.length).fill(Infinity);
    best[seed[1] * width + seed[0]] = 0;
    for (let changed = true; changed;) {
      changed = false;
      for (let at = 0; at < costs.length; ++at)
        for (let dy = -1; dy <= 1; ++dy)
          for (let dx = -1; dx <= 1; ++dx) {
            const [x, y] = [(at % width) + dx, Math.floor(at / width) + dy];
            if (x < 0 || x >= width || y < 0 || y >= height) continue;
            const to = y * width + x;
            const reached = best[at]! + (dx && dy ? kDiagonal : kStraight) * costs[to]!;
            if (reached >= best[to]!) continue;
            best[to] = reached;
            changed = true;
          }
    }
    return best;
  }

  /** Returns the sum of the costs of the steps. It is infinite if a step leads farther than one pixel. */
  function costOf(path: readonly Pixel[], costs: Uint8Array, width: number): number {
    let sum = 0;
    path.slice(1).forEach(([x, y], index) => {
      const [dx, dy] = [x - path[index]![0], y - path[index]![1]];
      if (Math.max(Math.abs(dx), Math.abs(dy)) !== 1) sum = Infinity;
      sum += (dx && dy ? kDiagonal : kStraight) * costs[y * width + x]!;
    });
    return sum;
  }

  const map = fc
    .record({ width: fc.integer({ min: 1, max: 9 }), height: fc.integer({ min: 1, max: 9 }) })
    .chain(({ width, height }) =>
      fc.record({
        width: fc.constant(width),
        height: fc.constant(height),
        seed: fc.tuple(fc.nat(width - 1), fc.nat(height - 1)),
        costs: fc.uint8Array({ minLength: width * height, maxLength: width * height }),
      }),
    );

  it("cost as little as those that a brute-force search finds", () => {
    fc.assert(
      fc.property(map, ({ width, height, seed, costs }) => {
        const paths = new LeastCostPaths(costs, width, height, seed);
        const best = bruteForce(costs, width, height, seed);
        const pixels = best.map((_, at): Pixel => [at % width, Math.floor(at / width)]);
        expect(pixels.map((pixel) => paths.costTo(pixel))).toEqual(best);
        const dearer = pixels.filter(
          (pixel, at) => costOfStraight(costs, width, seed, pixel) < best[at]!,
        );
        expect(dearer).toEqual([]);
        expect(
          pixels.map((pixel) => {
            const path = paths.pathTo(pixel);
            const ends = [path[0]!, path[path.length - 1]!];
            return `${ends.join(" to ")} for ${costOf(path, costs, width)}`;
          }),
        ).toEqual(pixels.map((pixel, at) => `${seed} to ${pixel} for ${best[at]}`));
      }),
      { numRuns: 40 },
    );
  });

  it("lead straight through a flat picture", () => {
    const paths = new LeastCostPaths(new Uint8Array(50 * 50).fill(kMaxCost), 50, 50, [3, 7]);
    expect(paths.pathTo([40, 7]).length).toBe(38);
    expect(paths.costTo([40, 7])).toBe(37 * kStraight * kMaxCost);
    expect(paths.pathTo([3, 7])).toEqual([[3, 7]]);
    const flat = new Uint8Array(50 * 50).fill(kMaxCost);
    for (const to of [
      [40, 7],
      [31, 49],
      [0, 2],
      [3, 7],
    ] as Pixel[])
      expect(costOfStraight(flat, 50, [3, 7], to)).toBe(paths.costTo(to));
  });

  it("are refused for a wrong size or place", () => {
    const costs = new Uint8Array(12).fill(1);
    expect(() => new LeastCostPaths(costs, 5, 3, [0, 0])).toThrow(RangeError);
    for (const seed of [
      [4, 0],
      [0, 3],
      [-1, 0],
      [0.5, 0],
    ] as const)
      expect(() => new LeastCostPaths(costs, 4, 3, seed)).toThrow(RangeError);
    expect(() => new LeastCostPaths(costs, 4, 3, [0, 0]).pathTo([4, 2])).toThrow(RangeError);
    const many = new Uint8Array(kMaxPixels + 1);
    expect(() => new LeastCostPaths(many, kMaxPixels + 1, 1, [0, 0])).toThrow(RangeError);
  });
});
