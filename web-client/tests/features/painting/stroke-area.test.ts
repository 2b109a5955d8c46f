import { describe, expect, it } from "vitest";
import {
  areaOfStrokes,
  kMostRingPoints,
  kMostRings,
  type AreaRing,
  type AreaStroke,
} from "../../../src/features/painting/stroke-area";
import type { SharpFrame } from "../../../src/features/painting/sharp-frame";
import type { Point } from "../../../src/net/stroke";
import { frameOf, noise } from "../../pictures";

const kRadius = 3;

/** The distance of a point from the border of a shape. It is positive inside. */
type Shape = (x: number, y: number) => number;

const disc =
  (centerX: number, centerY: number, radius: number): Shape =>
  (x, y) =>
    radius - Math.hypot(x - centerX, y - centerY);
const star =
  (centerX: number, centerY: number, radius: number): Shape =>
  (x, y) => {
    const angle = Math.atan2(y - centerY, x - centerX);
    return radius * (1 + 0.25 * Math.cos(5 * angle)) - Math.hypot(x - centerX, y - centerY);
  };
const strip =
  (left: number, right: number, middle: number, half: number): Shape =>
  (x, y) =>
    Math.min(half - Math.abs(y - middle), x - left, right - x);
const without =
  (shape: Shape, hole: Shape): Shape =>
  (x, y) =>
    Math.min(shape(x, y), -hole(x, y));

const inside = (...path: Point[]): AreaStroke => ({ inside: true, path });
const outside = (...path: Point[]): AreaStroke => ({ inside: false, path });

interface Look {
  inside: number;
  outside: number;
  /** The standard deviation of the noise. */
  noise?: number;
  /** The width of the border, in pixels. */
  soft?: number;
}

/** Makes a frame with the shape, which is the same each time it is read. */
function planted(width: number, height: number, shape: Shape, look: Look): SharpFrame {
  const random = noise(look.noise ?? 0);
  const values = new Uint8ClampedArray(width * height);
  values.forEach((_, at) => {
    const distance = shape((at % width) + 0.5, Math.floor(at / width) + 0.5);
    const share = look.soft ? distance / look.soft + 0.5 : distance > 0 ? 1 : 0;
    const part = Math.min(1, Math.max(0, share));
    values[at] = look.outside + (look.inside - look.outside) * part + random();
  });
  return frameOf(width, height, (x, y) => values[Math.floor(y) * width + Math.floor(x)]!);
}

function isIn(outline: readonly Point[], x: number, y: number): boolean {
  let found = false;
  outline.forEach(([x0, y0], at) => {
    const [x1, y1] = outline[(at + 1) % outline.length]!;
    if (y0 <= y !== y1 <= y && x < x0 + ((y - y0) / (y1 - y0)) * (x1 - x0)) found = !found;
  });
  return found;
}

/** The area of the intersection of rings and shape, divided by that of their union. */
function overlap(rings: readonly AreaRing[], shape: Shape, frame: SharpFrame): number {
  let [both, either] = [0, 0];
  for (let y = 1.5; y < frame.height; y += 3)
    for (let x = 1.5; x < frame.width; x += 3) {
      let a = false;
      for (const { hole, path } of rings) if (isIn(path, x, y)) a = !hole;
      const b = shape(x, y) > 0;
      both += Number(a && b);
      either += Number(a || b);
    }
  return both / either;
}

describe("An area from three strokes", () => {
  const shape = star(300, 240, 130);
  const strokes = [
    inside([270, 235], [330, 245]),
    outside([60, 60], [260, 50]),
    outside([420, 430], [540, 300]),
  ];

  it.each<[string, Look, number]>([
    ["a sharp border", { inside: 170, outside: 60 }, 0.98],
    ["similar values", { inside: 128, outside: 118 }, 0.97],
    ["noise", { inside: 150, outside: 110, noise: 10 }, 0.97],
    ["much noise", { inside: 150, outside: 110, noise: 30 }, 0.93],
    ["a soft border", { inside: 150, outside: 110, soft: 20 }, 0.95],
    ["a soft border and noise", { inside: 150, outside: 110, soft: 20, noise: 10 }, 0.93],
  ])("has the border of a shape with %s", (_, look, least) => {
    const frame = planted(600, 480, shape, look);
    expect(overlap(areaOfStrokes(frame, strokes, kRadius), shape, frame)).toBeGreaterThan(least);
  });

  it("follows the border in the resolution of a large frame", () => {
    const large = star(1000, 600, 300);
    const frame = planted(2000, 1200, large, { inside: 150, outside: 100, noise: 8 });
    const drawn = [
      inside([950, 600], [1050, 610]),
      outside([300, 200], [700, 150]),
      outside([1500, 1000], [1700, 500]),
    ];
    const rings = areaOfStrokes(frame, drawn, 6);
    expect(rings).toHaveLength(1);
    expect(overlap(rings, large, frame)).toBeGreaterThan(0.985);
    const off = rings[0]!.path.map(([x, y]) => Math.abs(large(x, y)));
    expect(off.filter((distance) => distance > 3).length).toBeLessThan(0.05 * off.length);
  });

  it("ends at an edge between two sides with the same color", () => {
    const line: Shape = (x, y) => 2.5 - Math.abs(shape(x, y));
    const frame = planted(400, 400, (x, y) => line(x + 100, y + 40), { inside: 90, outside: 150 });
    const local: Shape = (x, y) => shape(x + 100, y + 40);
    const drawn = [
      inside([170, 195], [230, 205]),
      outside([20, 20], [380, 20]),
      outside([20, 380], [380, 380]),
    ];
    expect(overlap(areaOfStrokes(frame, drawn, kRadius), local, frame)).toBeGreaterThan(0.9);
  });

  it("contains thin shapes and leaves out their holes", () => {
    const thin = without(strip(50, 350, 200, 9), disc(120, 200, 5));
    const holed = without(thin, strip(180, 320, 200, 4));
    const frame = planted(400, 400, holed, { inside: 60, outside: 180, noise: 6 });
    const drawn = [
      inside([56, 200], [100, 200]),
      outside([30, 100], [370, 110]),
      outside([200, 200], [300, 200]),
    ];
    const rings = areaOfStrokes(frame, drawn, 1.5);
    expect(rings.map(({ hole }) => hole)).toEqual([false, true, true]);
    let [both, either] = [0, 0];
    for (let y = 180.5; y < 220; ++y)
      for (let x = 40.5; x < 360; ++x) {
        const isFound = rings.reduce(
          (was, ring) => (isIn(ring.path, x, y) ? !ring.hole : was),
          false,
        );
        const isThere = holed(x, y) > 0;
        both += Number(isFound && isThere);
        either += Number(isFound || isThere);
      }
    expect(both / either).toBeGreaterThan(0.9);
  });

  it("has only the parts that a stroke reaches, although others have the same color", () => {
    const both: Shape = (x, y) => Math.max(disc(120, 200, 60)(x, y), disc(290, 200, 60)(x, y));
    const frame = planted(400, 400, both, { inside: 170, outside: 60, noise: 5 });
    const drawn = [
      inside([100, 200], [140, 200]),
      outside([20, 40], [380, 40]),
      outside([20, 370], [380, 370]),
    ];
    const rings = areaOfStrokes(frame, drawn, kRadius);
    expect(rings).toHaveLength(1);
    expect(overlap(rings, disc(120, 200, 60), frame)).toBeGreaterThan(0.95);
  });
});

describe("The strokes of an area", () => {
  const shape = disc(100, 100, 50);
  const frame = planted(200, 200, shape, { inside: 170, outside: 60 });

  it("have no area while all are inside, or all are outside", () => {
    expect(areaOfStrokes(frame, [inside([90, 100], [110, 100])], kRadius)).toEqual([]);
    expect(areaOfStrokes(frame, [outside([10, 10], [190, 10])], kRadius)).toEqual([]);
    expect(areaOfStrokes(frame, [], kRadius)).toEqual([]);
  });

  it("can be dots, and dots outside of the frame have no effect", () => {
    const drawn = [inside([100, 100]), outside([20, 20]), outside([-50, 100])];
    expect(overlap(areaOfStrokes(frame, drawn, kRadius), shape, frame)).toBeGreaterThan(0.95);
  });

  it("cover earlier ones", () => {
    const drawn = [inside([100, 100]), outside([20, 20]), outside([100, 100])];
    expect(areaOfStrokes(frame, drawn, kRadius)).toEqual([]);
  });

  it("find a limited number of parts with a limited number of points", () => {
    const random = noise(60);
    const rough: Shape = (x, y) => Math.sin(x / 9) * Math.sin(y / 9);
    const rings = areaOfStrokes(
      planted(1600, 1000, (x, y) => rough(x, y) + random() / 90, { inside: 200, outside: 40 }),
      Array.from({ length: 60 }, (_, at) => {
        const [x, y] = [15 + 57 * (at % 20), 15 + 57 * Math.floor(at / 20)];
        return at % 2 === 0 ? inside([x, y]) : outside([x + 28, y]);
      }),
      2,
    );
    expect(rings.length).toBeLessThanOrEqual(kMostRings);
    expect(rings.reduce((sum, { path }) => sum + path.length, 0)).toBeLessThanOrEqual(
      kMostRingPoints,
    );
  });
});
