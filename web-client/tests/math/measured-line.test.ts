import fc from "fast-check";
import { describe, expect, it } from "vitest";

import { flatPolygon, heightOf, legsOf, sum } from "../../src/math/measured-line";
import { add, cross, length, scale, subtract, type Vec3 } from "../../src/math/vector";

const number = fc.double({ min: -50, max: 50, noNaN: true });
const place = fc.tuple(number, number, number);

/** Returns two perpendicular directions of length 1. */
function frameOf(seed: Vec3): [Vec3, Vec3] {
  const across = cross(seed, Math.abs(seed[0]) < Math.abs(seed[1]) ? [1, 0, 0] : [0, 1, 0]);
  const first = scale(across, 1 / length(across));
  const second = cross(seed, first);
  return [first, scale(second, 1 / length(second))];
}

/** Computes the area with the shoelace formula in a plane, as an independent reference. */
const shoelace = (points: readonly (readonly [number, number])[]): number =>
  Math.abs(
    points.reduce(
      (total, [x, y], at) =>
        total + x * points[(at + 1) % points.length]![1] - points[(at + 1) % points.length]![0] * y,
      0,
    ),
  ) / 2;

describe("places that are measured between", () => {
  it("are as far from each other as Pythagoras says", () => {
    expect(
      legsOf([
        [0, 0, 0],
        [3, 4, 0],
        [3, 4, 12],
      ]),
    ).toEqual([5, 12]);
    expect(legsOf([[1, 2, 3]])).toEqual([]);
    expect(sum([5, 12])).toBe(17);
  });

  it("are as high as their coordinate along the model's up axis", () => {
    expect((["x", "y", "z"] as const).map((up) => heightOf([1, 2, 3], up))).toEqual([1, 2, 3]);
  });
});

describe("the flat polygon through places", () => {
  it("has the area and perimeter that are calculated by hand", () => {
    // the roof is 60 wide, and 40 in plan with a slope of 3 in 4, which is 50 along the slope
    const roof = flatPolygon([
      [0, 0, 0],
      [60, 0, 0],
      [60, 40, 30],
      [0, 40, 30],
    ])!;
    expect(roof.area).toBeCloseTo(3000, 9);
    expect(roof.perimeter).toBeCloseTo(220, 9);
    expect(roof.off_plane).toBeCloseTo(0, 9);
    const triangle = flatPolygon([
      [0, 0, 0],
      [3, 0, 0],
      [0, 4, 0],
    ])!;
    expect([triangle.area, triangle.perimeter]).toEqual([6, 12]);
    const withABay = flatPolygon([
      [0, 0, 5],
      [4, 0, 5],
      [4, 4, 5],
      [2, 1, 5],
      [0, 4, 5],
    ])!;
    expect(withABay.area).toBeCloseTo(16 - 6, 9);
  });

  it("is none of fewer than three places, and has no area on a line", () => {
    expect(
      flatPolygon([
        [0, 0, 0],
        [1, 0, 0],
      ]),
    ).toBeNull();
    expect(
      flatPolygon([
        [0, 0, 0],
        [1, 1, 1],
        [2, 2, 2],
      ]),
    ).toEqual({ area: 0, perimeter: 4 * Math.sqrt(3), off_plane: 0 });
  });

  it("says how far its corners lie off its plane", () => {
    const bent = flatPolygon([
      [0, 0, 1],
      [10, 0, -1],
      [10, 10, 1],
      [0, 10, -1],
    ])!;
    expect(bent.area).toBeCloseTo(100, 9);
    expect(bent.off_plane).toBeCloseTo(1, 9);
  });

  it("has in any plane the area that the shoelace formula gives in it, wherever it lies", () => {
    const corners = fc.array(fc.tuple(number, number), { minLength: 3, maxLength: 12 });
    fc.assert(
      fc.property(
        corners,
        place.filter((seed) => length(seed) > 1),
        place,
        (points, seed, origin) => {
          const [first, second] = frameOf(seed);
          // coordinates of the size of a national grid
          const far: Vec3 = add(scale(origin, 1000), [400_000, 4_600_000, 0]);
          const polygon = flatPolygon(
            points.map(([x, y]) => add(far, add(scale(first, x), scale(second, y)))),
          )!;
          expect(Math.abs(polygon.area - shoelace(points))).toBeLessThan(1e-4);
          if (polygon.area > 1) expect(polygon.off_plane).toBeLessThan(1e-6);
        },
      ),
    );
  });

  it("has never more area than its shape around the first corner has as triangles, and the same with its corners turned round", () => {
    fc.assert(
      fc.property(fc.array(place, { minLength: 3, maxLength: 8 }), (places) => {
        const { area, perimeter } = flatPolygon(places)!;
        const triangles = places
          .slice(2)
          .map(
            (each, at) =>
              length(cross(subtract(places[at + 1]!, places[0]!), subtract(each, places[0]!))) / 2,
          );
        expect(area).toBeLessThanOrEqual(sum(triangles) + 1e-6);
        const turned = flatPolygon([...places].reverse())!;
        expect(turned.area).toBeCloseTo(area, 6);
        expect(turned.perimeter).toBeCloseTo(perimeter, 6);
      }),
    );
  });
});
