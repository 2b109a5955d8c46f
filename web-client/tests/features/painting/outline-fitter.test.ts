import fc from "fast-check";
import { describe, expect, it } from "vitest";
import {
  fittedOutline,
  kFitReach,
  kMostFitPixels,
} from "../../../src/features/painting/outline-fitter";
import type { Point } from "../../../src/net/stroke";
import { frameOf, noise } from "../../pictures";

/** A star with rounded arms, which no straight side fits. */
const radiusAt = (angle: number, radius: number, wave: number, arms: number): number =>
  radius * (1 + wave * Math.cos(arms * angle));

type Shape = (x: number, y: number) => boolean;

const star =
  (centerX: number, centerY: number, radius: number, wave = 0.2, arms = 5): Shape =>
  (x, y) =>
    Math.hypot(x - centerX, y - centerY) <
    radiusAt(Math.atan2(y - centerY, x - centerX), radius, wave, arms);

/** Draws around the star by hand: the pointer is up to `off` pixels away from its border. */
function drawn(
  centerX: number,
  centerY: number,
  radius: number,
  off: (share: number) => number,
  wave = 0.2,
  arms = 5,
): Point[] {
  return Array.from({ length: 240 }, (_, at): Point => {
    const angle = (at / 240) * 2 * Math.PI;
    const length = radiusAt(angle, radius, wave, arms) + off(at / 240);
    return [centerX + length * Math.cos(angle), centerY + length * Math.sin(angle)];
  });
}

function isIn(outline: readonly Point[], x: number, y: number): boolean {
  let inside = false;
  outline.forEach(([x0, y0], at) => {
    const [x1, y1] = outline[(at + 1) % outline.length]!;
    if (y0 <= y !== y1 <= y && x < x0 + ((y - y0) / (y1 - y0)) * (x1 - x0)) inside = !inside;
  });
  return inside;
}

/** The area of the intersection divided by that of the union. */
function overlap(outline: readonly Point[], shape: Shape, size: number): number {
  let [both, either] = [0, 0];
  for (let y = 0.5; y < size; ++y)
    for (let x = 0.5; x < size; ++x) {
      const [a, b] = [isIn(outline, x, y), shape(x, y)];
      both += Number(a && b);
      either += Number(a || b);
    }
  return both / either;
}

const shaky = (share: number): number =>
  6 * Math.sin(2 * Math.PI * 3 * share) + 4 * Math.cos(2 * Math.PI * 7 * share);

describe("An outline drawn by hand", () => {
  it.each([
    ["a sharp border", 0, 170, 60, 0.98],
    ["a border between similar values", 0, 130, 118, 0.98],
    ["a border in noise", 8, 150, 110, 0.96],
    ["a border in much noise", 16, 160, 100, 0.94],
  ])("moves to %s", (_, deviation, inside, outside, least) => {
    const random = noise(deviation);
    const shape = star(120, 120, 70);
    const frame = frameOf(240, 240, (x, y) => (shape(x, y) ? inside : outside) + random());
    const outline = drawn(120, 120, 70, shaky);
    const before = overlap(outline, shape, 240);
    expect(before).toBeLessThan(0.92);
    expect(overlap(fittedOutline(frame, outline, kFitReach), shape, 240)).toBeGreaterThan(least);
  });

  it("stays within a few pixels in a flat picture", () => {
    const frame = frameOf(240, 240, () => 128);
    const outline = drawn(120, 120, 70, () => 0);
    for (const [x, y] of fittedOutline(frame, outline, kFitReach)) {
      const nearest = Math.min(...outline.map(([px, py]) => Math.hypot(px - x, py - y)));
      expect(nearest).toBeLessThan(kFitReach / 2);
    }
  });

  it("never moves farther than its reach", () => {
    fc.assert(
      fc.property(
        fc.integer({ min: 0, max: 1e6 }),
        fc.integer({ min: 3, max: 20 }),
        (seed, reach) => {
          const random = noise(1 + (seed % 60));
          const frame = frameOf(
            200,
            200,
            (x, y) => 128 + 60 * Math.sin(x / (3 + (seed % 7)) + y) + random(),
          );
          const outline = drawn(100, 100, 55, () => 0);
          for (const [x, y] of fittedOutline(frame, outline, reach)) {
            const nearest = Math.min(...outline.map(([px, py]) => Math.hypot(px - x, py - y)));
            expect(nearest).toBeLessThan(reach + 2);
          }
        },
      ),
      { numRuns: 30 },
    );
  });

  it("keeps a thin strip, whose middle stays inside", () => {
    const strip: Shape = (x, y) => x > 30 && x < 210 && Math.abs(y - 60) < 4;
    const frame = frameOf(240, 120, (x, y) => (strip(x, y) ? 40 : 200));
    const outline: Point[] = [
      [28, 54],
      [212, 54],
      [212, 66],
      [28, 66],
    ];
    expect(overlap(fittedOutline(frame, outline, kFitReach), strip, 240)).toBeGreaterThan(0.95);
  });

  it("is cut at the border of the frame", () => {
    const shape = star(0, 60, 50, 0);
    const frame = frameOf(120, 120, (x, y) => (shape(x, y) ? 40 : 200));
    const outline = drawn(0, 60, 50, shaky, 0);
    const fitted = fittedOutline(frame, outline, kFitReach);
    expect(overlap(fitted, shape, 120)).toBeGreaterThan(0.97);
    expect(Math.min(...fitted.map(([x]) => x))).toBeGreaterThanOrEqual(0);
  });

  it.each<[string, Point[]]>([
    [
      "too small",
      [
        [10, 10],
        [13, 10],
        [12, 13],
      ],
    ],
    [
      "without an area",
      [
        [10, 10],
        [90, 10],
        [10, 10],
      ],
    ],
    [
      "outside of the frame",
      [
        [300, 300],
        [400, 300],
        [400, 400],
      ],
    ],
    [
      "with two parts of equal size",
      [
        [20, 20],
        [90, 90],
        [90, 20],
        [20, 90],
      ],
    ],
  ])("stays as drawn if it is %s", (_, outline) => {
    const frame = frameOf(200, 200, (x) => (x < 100 ? 40 : 200));
    expect(fittedOutline(frame, outline, kFitReach)).toEqual(outline);
  });

  it("stays as drawn if only a row of pixels is inside", () => {
    const frame = frameOf(300, 20, (_, y) => (Math.floor(y) === 3 ? 40 : 200));
    const outline: Point[] = [
      [0, 0.45],
      [300, 0.45],
      [300, 6.45],
      [0, 6.45],
    ];
    const fitted = fittedOutline(frame, outline, kFitReach);
    expect(fitted.length).toBeGreaterThanOrEqual(3);
  });

  it("stays as drawn if it has too many pixels near it", () => {
    const frame = { ...frameOf(1990, 1990, () => 0), read: () => expect.fail("read") };
    const comb: Point[] = [[0, 1989]];
    for (let x = 5; x < 1985; x += 60) comb.push([x, 1900], [x, 20], [x + 30, 20], [x + 30, 1900]);
    comb.push([1985, 1989]);
    expect(fittedOutline(frame, comb, 24)).toEqual(comb);
  });

  it("stays as drawn if it is too large, and nothing is read then", () => {
    const size = Math.ceil(Math.sqrt(kMostFitPixels)) + 10;
    const frame = { ...frameOf(size, size, () => 0), read: () => expect.fail("read") };
    const outline: Point[] = [
      [0, 0],
      [size, 0],
      [size, size],
      [0, size],
    ];
    expect(fittedOutline(frame, outline, kFitReach)).toEqual(outline);
  });

  it("moves to the border of its shape, not to an edge inside it", () => {
    const shape = star(120, 120, 70);
    const spot = star(120, 120, 30, 0);
    const frame = frameOf(240, 240, (x, y) => (spot(x, y) ? 20 : shape(x, y) ? 90 : 180));
    const fitted = fittedOutline(frame, drawn(120, 120, 70, shaky), kFitReach);
    expect(overlap(fitted, shape, 240)).toBeGreaterThan(0.98);
  });
});
