import { describe, expect, it } from "vitest";

import type { Point } from "../../src/net/stroke";
import { markLength } from "../../src/domain/marks";
import type { MarkPlace } from "../../src/core/protocol.gen";
import {
  lengthSeen,
  lineOnSurface,
  type Measures,
  type NearestAlong,
  type Step,
} from "../../src/domain/surface-line";

// An upright cylinder around the y axis, and a wall behind it. The view direction is -z, and a
// pixel of the image has length 1.
const kRadius = 100;
const kWall = -140;
const measures: Measures = { pixelAt: () => 1, scale: 1 };

type Seen = (x: number, y: number) => Pick<Step, "place" | "normal">;
const cylinder: Seen = (x, y) => {
  const z = Math.sqrt(kRadius * kRadius - x * x);
  return Math.abs(x) < kRadius
    ? { place: [x, y, z], normal: [x / kRadius, 0, z / kRadius] }
    : { place: null, normal: null };
};
const beforeAWall: Seen = (x, y) =>
  Math.abs(x) < kRadius ? cylinder(x, y) : { place: [x, y, kWall], normal: [0, 0, 1] };
/** Like the server, returns points on the cylinder or on the wall, whichever is nearer. */
const nearestAlong =
  (wall: boolean): NearestAlong =>
  (from, to, step) => {
    const count = Math.max(
      1,
      Math.ceil(Math.hypot(...from.map((value, axis) => to[axis]! - value)) / step),
    );
    const places = Array.from({ length: count + 1 }, (_, at): MarkPlace => {
      const [x, y, z] = from.map(
        (value, axis) => value + ((to[axis]! - value) * at) / count,
      ) as MarkPlace;
      const out = Math.hypot(x, z);
      if (wall && Math.abs(z - kWall) < Math.abs(out - kRadius)) return [x, y, kWall];
      return [(x * kRadius) / out, y, (z * kRadius) / out];
    });
    return Promise.resolve(places);
  };

/** Returns the steps along a drawing, pixel by pixel. */
function drawn(path: (t: number) => Point, seen: Seen): Step[] {
  const steps: Step[] = [];
  let last: Point | null = null;
  for (let t = 0; t <= 1; t += 1e-4) {
    const at = path(t);
    if (last && Math.hypot(at[0] - last[0], at[1] - last[1]) < 0.99) continue;
    steps.push({ at, ...seen(...at) });
    last = at;
  }
  return steps;
}
const lengthOf = (pieces: MarkPlace[][]): number =>
  pieces.reduce((sum, coordinates) => sum + markLength({ coordinates }), 0);
const offTheCylinder = (piece: MarkPlace[]): number =>
  Math.max(...piece.map(([x, , z]) => Math.abs(Math.hypot(x, z) - kRadius)));

describe("a line that is drawn over a surface", () => {
  it("has the length of its way around a cylinder", async () => {
    const steps = drawn((t) => [-95 + 190 * t, 50 * t], cylinder);
    const pieces = await lineOnSurface(steps, measures, nearestAlong(false));
    expect(pieces).toHaveLength(1);
    // A helix around the cylinder is not straight in the image, so its length is summed in fine
    // steps.
    let analytic = 0;
    for (let i = 0; i < 1e5; ++i) {
      const [a, b] = [-95 + (190 * i) / 1e5, -95 + (190 * (i + 1)) / 1e5];
      analytic += Math.hypot(kRadius * (Math.asin(b / kRadius) - Math.asin(a / kRadius)), 50 / 1e5);
    }
    expect(lengthOf(pieces) / analytic).toBeCloseTo(1, 2);
    expect(lengthSeen(steps, measures) / analytic).toBeCloseTo(1, 2);
  });

  for (const [what, seen, wall] of [
    ["nothing", cylinder, false],
    ["a wall", beforeAWall, true],
  ] as const) {
    it(`stays one line along the edge that it crosses again and again, before ${what}`, async () => {
      // The line follows the silhouette and crosses the silhouette several times. It is up to 7
      // pixels outside and up to 15 pixels inside.
      const steps = drawn((t) => [98 + 11 * Math.sin(t * Math.PI * 10) - 2, 300 * t], seen);
      const pieces = await lineOnSurface(steps, measures, nearestAlong(wall));
      expect(pieces).toHaveLength(1);
      expect(offTheCylinder(pieces[0]!)).toBeLessThan(0.5);
      // the line contains no part of the wall
      expect(Math.min(...pieces[0]!.map(([, , z]) => z))).toBeGreaterThan(-30);
      // on the cylinder the line follows the drawing, elsewhere it follows the edge
      let analytic = 0;
      let last: MarkPlace | null = null;
      for (let t = 0; t <= 1; t += 1e-5) {
        const x = Math.min(kRadius, 98 + 11 * Math.sin(t * Math.PI * 10) - 2);
        const place: MarkPlace = [x, 300 * t, Math.sqrt(kRadius * kRadius - x * x)];
        if (last)
          analytic += Math.hypot(
            kRadius * (Math.asin(place[0] / kRadius) - Math.asin(last[0] / kRadius)),
            place[1] - last[1],
          );
        last = place;
      }
      expect(Math.abs(lengthOf(pieces) / analytic - 1)).toBeLessThan(0.12);
      expect(Math.abs(lengthSeen(steps, measures) / lengthOf(pieces) - 1)).toBeLessThan(0.05);
    });
  }

  it("does not take the wall on which it slips off at the end", async () => {
    const steps = drawn((t) => [60 + 55 * t, 10 * t], beforeAWall);
    const pieces = await lineOnSurface(steps, measures, nearestAlong(true));
    expect(pieces).toHaveLength(1);
    expect(offTheCylinder(pieces[0]!)).toBeLessThan(0.5);
  });

  it("is cut where it goes on far behind the edge", async () => {
    const pieces = await lineOnSurface(
      drawn((t) => [50 + 150 * t, 0], beforeAWall),
      measures,
      nearestAlong(true),
    );
    expect(pieces).toHaveLength(2);
    expect(offTheCylinder(pieces[0]!)).toBeLessThan(0.5);
    expect(pieces[1]!.every(([, , z]) => z === kWall)).toBe(true);
    expect(lengthOf([pieces[1]!])).toBeCloseTo(100, -1);
    expect(lengthOf([pieces[0]!]) / (kRadius * (Math.PI / 2 - Math.asin(0.5)))).toBeGreaterThan(
      0.85,
    );
  });

  it("goes on below a handle that lies over it, and over a narrow gap, but not over a wide one", async () => {
    const flat =
      (place: (x: number) => MarkPlace | null): Seen =>
      (x) => ({ place: place(x), normal: [0, 0, 1] });
    const plane: NearestAlong = (from, to, step) => {
      const count = Math.ceil(Math.abs(to[0] - from[0]) / step);
      return Promise.resolve(
        Array.from({ length: count + 1 }, (_, at): MarkPlace => [
          from[0] + ((to[0] - from[0]) * at) / count,
          0,
          0,
        ]),
      );
    };
    const nothing: NearestAlong = () => Promise.resolve([]);
    const across = (seen: Seen): Step[] => drawn((t) => [200 * t, 0], seen);
    const below = await lineOnSurface(
      across(flat((x) => (x > 80 && x < 120 ? [x, 0, 60] : [x, 0, 0]))),
      measures,
      plane,
    );
    expect(below).toHaveLength(1);
    expect(lengthOf(below)).toBeCloseTo(200, -0.5);
    const narrow = await lineOnSurface(
      across(flat((x) => (x > 95 && x < 105 ? null : [x, 0, 0]))),
      measures,
      nothing,
    );
    expect(narrow).toHaveLength(1);
    const wide = await lineOnSurface(
      across(flat((x) => (x > 70 && x < 130 ? null : [x, 0, 0]))),
      measures,
      nothing,
    );
    expect(wide).toHaveLength(2);
  });

  it("follows the steps of a relief, and the floor of a wide groove", async () => {
    const seen: Seen = (x) => ({ place: [x, 0, x > 60 && x < 140 ? -15 : 0], normal: [0, 0, 1] });
    const walls: NearestAlong = (from, to, step) => {
      const count = Math.ceil(Math.abs(to[2] - from[2]) / step);
      return Promise.resolve(
        Array.from({ length: count + 1 }, (_, at): MarkPlace => [
          to[0],
          0,
          from[2] + ((to[2] - from[2]) * at) / count,
        ]),
      );
    };
    const pieces = await lineOnSurface(
      drawn((t) => [200 * t, 0], seen),
      measures,
      walls,
    );
    expect(pieces).toHaveLength(1);
    expect(lengthOf(pieces)).toBeCloseTo(230, -0.5);
  });

  it("is none where there is no surface, or of a single place", async () => {
    const none = (places: (MarkPlace | null)[]): Promise<MarkPlace[][]> =>
      lineOnSurface(
        places.map((place, at) => ({ at: [at, 0], place, normal: null })),
        measures,
        nearestAlong(false),
      );
    expect(await none([null, null])).toEqual([]);
    expect(
      await none([
        [1, 1, 1],
        [1, 1, 1],
      ]),
    ).toEqual([]);
    expect(await none([])).toEqual([]);
  });
});
