import fc from "fast-check";
import { describe, expect, it } from "vitest";
import type { Picture } from "../../src/math/edge-costs";
import { kInside, kOutside, kUnknown, randomWalker } from "../../src/math/random-walker";

const gray = (width: number, height: number, values: readonly number[]): Picture => ({
  width,
  height,
  channels: 1,
  pixels: Uint8Array.from(values),
});

/** Walks many times from a pixel. Steps are as likely as their weights. */
function walked(picture: Picture, given: Uint8Array, from: number, walks: number): number {
  const { width, height, pixels } = picture;
  const around = (pixel: number): number[] => [
    ...(pixel % width > 0 ? [pixel - 1] : []),
    ...((pixel + 1) % width > 0 ? [pixel + 1] : []),
    ...(pixel >= width ? [pixel - width] : []),
    ...(pixel + width < width * height ? [pixel + width] : []),
  ];
  let [sum, pairs] = [0, 0];
  given.forEach((kind, pixel) => {
    if (kind !== kUnknown) return;
    for (const next of around(pixel)) {
      sum += (pixels[pixel]! - pixels[next]!) ** 2;
      pairs += 1;
    }
  });
  const weight = (a: number, b: number): number =>
    Math.exp(-((pixels[a]! - pixels[b]!) ** 2) / Math.max(sum / pairs, 1e-6)) + 1e-4;
  let state = 1;
  const random = (): number => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  let inside = 0;
  for (let walk = 0; walk < walks; ++walk) {
    let at = from;
    while (given[at] === kUnknown) {
      const next = around(at);
      const weights = next.map((pixel) => weight(at, pixel));
      let left = random() * weights.reduce((a, b) => a + b);
      let choice = 0;
      while (choice + 1 < next.length && left >= weights[choice]!) left -= weights[choice++]!;
      at = next[choice]!;
    }
    if (given[at] === kInside) inside += 1;
  }
  return inside / walks;
}

describe("The probability to reach the inside", () => {
  it("is linear between the inside and the outside of a flat picture", () => {
    const given = Uint8Array.from([kInside, 0, 0, 0, kOutside]);
    const found = randomWalker(gray(5, 1, [7, 7, 7, 7, 7]), given);
    [1, 0.75, 0.5, 0.25, 0].forEach((value, at) => expect(found[at]).toBeCloseTo(value, 3));
  });

  it("is that of the side of an edge", () => {
    const given = Uint8Array.from([kInside, 0, 0, 0, 0, kOutside]);
    const found = randomWalker(gray(6, 1, [9, 9, 9, 9, 200, 200]), given);
    expect(Math.min(...found.slice(0, 4))).toBeGreaterThan(0.9);
    expect(found[4]).toBeLessThan(0.1);
  });

  it("is that of walks that really happen", () => {
    const random = fc.sample(fc.integer({ min: 0, max: 30 }), { numRuns: 36, seed: 5 });
    const picture = gray(6, 6, random);
    const given = new Uint8Array(36);
    given[0] = given[1] = kInside;
    given[35] = given[29] = kOutside;
    const found = randomWalker(picture, given);
    for (const from of [7, 14, 20, 33])
      expect(Math.abs(found[from]! - walked(picture, given, from, 20_000))).toBeLessThan(0.02);
  });

  it("is between 0 and 1, and exact where it is given", () => {
    fc.assert(
      fc.property(
        fc.integer({ min: 1, max: 12 }),
        fc.integer({ min: 1, max: 12 }),
        fc.infiniteStream(fc.nat(255)),
        fc.infiniteStream(fc.constantFrom(kUnknown, kUnknown, kInside, kOutside)),
        (width, height, colors, kinds) => {
          const take = <T>(stream: IterableIterator<T>, count: number): T[] =>
            Array.from({ length: count }, () => stream.next().value as T);
          const given = Uint8Array.from(take(kinds, width * height));
          const pixels = Uint8Array.from(take(colors, 4 * width * height));
          const found = randomWalker({ width, height, channels: 4, pixels }, given);
          found.forEach((value, at) => {
            if (given[at] === kInside) expect(value).toBe(1);
            else if (given[at] === kOutside) expect(value).toBe(0);
            else expect(Math.abs(value - 0.5)).toBeLessThan(0.51);
          });
        },
      ),
    );
  });

  it("leans to a side with the weight of the leaning", () => {
    const lean = (...numbers: number[]): number =>
      randomWalker(
        gray(3, 1, [7, 7, 7]),
        Uint8Array.from([kInside, 0, kOutside]),
        Float32Array.from(numbers),
      )[1]!;
    expect(lean(0, 0, 0)).toBeCloseTo(0.5, 3);
    expect(lean(9, 2, 9)).toBeCloseTo(3 / 4, 3);
    expect(lean(9, -2, 9)).toBeCloseTo(1 / 4, 3);
    const alone = randomWalker(gray(1, 1, [3]), new Uint8Array(1), Float32Array.from([0.1]));
    expect(alone[0]).toBeCloseTo(1, 3);
  });

  it("falls evenly across a large flat picture", () => {
    const [width, height] = [300, 200];
    const given = new Uint8Array(width * height);
    for (let y = 0; y < height; ++y) {
      given[y * width] = kInside;
      given[(y + 1) * width - 1] = kOutside;
    }
    const picture = gray(width, height, Array<number>(width * height).fill(90));
    randomWalker(picture, given).forEach((value, at) =>
      expect(Math.abs(value - (1 - (at % width) / (width - 1)))).toBeLessThan(0.01),
    );
  });

  it("does not pass a closed edge in a large picture", () => {
    const size = 200;
    const isIn = (at: number): boolean =>
      Math.hypot((at % size) - 100, Math.floor(at / size) - 100) < 60;
    const values = Array.from({ length: size * size }, (_, at) => (isIn(at) ? 160 : 90));
    const given = new Uint8Array(size * size);
    given[100 * size + 90] = kInside;
    given[5 * size + 190] = kOutside;
    randomWalker(gray(size, size, values), given).forEach((value, at) =>
      expect(value > 0.5).toBe(isIn(at)),
    );
  });

  it("is a half where nothing is given", () => {
    expect([...randomWalker(gray(2, 2, [1, 9, 9, 1]), new Uint8Array(4))]).toEqual([
      0.5, 0.5, 0.5, 0.5,
    ]);
    expect([...randomWalker(gray(1, 1, [3]), new Uint8Array(1))]).toEqual([0.5]);
  });

  it("needs as many pixels as the size says", () => {
    expect(() => randomWalker(gray(2, 2, [1, 2, 3]), new Uint8Array(4))).toThrow(RangeError);
    expect(() => randomWalker(gray(2, 2, [1, 2, 3, 4]), new Uint8Array(3))).toThrow(RangeError);
    const few = new Float32Array(3);
    expect(() => randomWalker(gray(2, 2, [1, 2, 3, 4]), new Uint8Array(4), few)).toThrow(
      RangeError,
    );
  });
});
