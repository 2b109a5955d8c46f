import fc from "fast-check";
import { describe, expect, it } from "vitest";

import { makePlot, nearestIndex, tickLabels, type PlotOf } from "../../src/domain/plot";
import { lengthOf, passesThrough, profileParts, simplifyProfile } from "../../src/domain/profile";
import type { ProfileSample } from "../../src/core/protocol.gen";

const one = (): number => 1;
const hit = (x: number, y: number, z: number, moisture?: number): ProfileSample => ({
  along_mm: 0,
  point: {
    hit: true,
    position: [x, y, z],
    normal: [0, 0, 1],
    values: {
      moisture: moisture === undefined ? { valid: false } : { valid: true, value: moisture },
    },
  },
});
const miss: ProfileSample = { along_mm: 0, point: { hit: false } };
const alongs = (samples: ProfileSample[]): number[][] =>
  profileParts(samples, one, null).map((part) => part.map(({ along }) => along));

describe("a profile", () => {
  it("counts how far places are along the surface, and nothing where the line leaves it", () => {
    expect(alongs([hit(0, 0, 0), hit(3, 0, 4), hit(6, 0, 4)])).toEqual([[0, 5, 8]]);
    expect(alongs([miss, hit(0, 0, 0), hit(1, 0, 0), miss, hit(5, 0, 0), hit(7, 0, 0)])).toEqual([
      [0, 1],
      [1, 3],
    ]);
    expect(alongs([miss, miss])).toEqual([]);
    expect(lengthOf(profileParts([], one, null))).toBe(0);
    expect(lengthOf(profileParts([hit(0, 0, 0), hit(3, 0, 4), miss], one, null))).toBe(5);
  });

  it("does not leap from an edge to what lies far behind it", () => {
    expect(alongs([hit(0, 0, 0), hit(1, 0, 0), hit(2, 0, -500), hit(3, 0, -500)])).toEqual([
      [0, 1],
      [1, 2],
    ]);
  });

  it("has the values of the layer that was asked for, and none where it has none", () => {
    const [part] = profileParts([hit(0, 0, 0, 7), hit(1, 0, 0), hit(2, 0, 0, 0)], one, "moisture");
    expect(part!.map(({ value }) => value)).toEqual([7, null, 0]);
    expect(profileParts([hit(0, 0, 0, 7)], one, null)[0]![0]!.value).toBeNull();
  });

  it("passes through places that it comes near to", () => {
    const parts = profileParts([hit(0, 0, 0), hit(1, 0, 0), hit(2, 0, 0)], one, null);
    expect(
      passesThrough(
        parts,
        [
          [0, 0, 0.5],
          [2, 0.5, 0],
        ],
        one,
      ),
    ).toBe(true);
    expect(
      passesThrough(
        parts,
        [
          [0, 0, 0],
          [2, 0, -3],
        ],
        one,
      ),
    ).toBe(false);
  });

  it("is drawn with the places that its course needs", () => {
    const roof = profileParts(
      Array.from({ length: 21 }, (_, at) => hit(at, 0, 10 - Math.abs(at - 10))),
      one,
      null,
    );
    expect(
      simplifyProfile(roof, () => 0.1).map((part) => part.map(({ place }) => place[0])),
    ).toEqual([[0, 10, 20]]);
  });
});

const plotOf = (more: Partial<PlotOf> = {}): ReturnType<typeof makePlot> =>
  makePlot({
    parts: [
      [
        { x: 0, y: 0.01 },
        { x: 0.05, y: 0.03 },
        { x: 0.1, y: 0.01 },
      ],
    ],
    yUnit: null,
    equal: false,
    width: 400,
    height: 200,
    ...more,
  });

describe("a plot", () => {
  it("writes ticks with the decimals that they need, and no more", () => {
    expect(tickLabels([0, 2.5, 5])).toEqual(["0.0", "2.5", "5.0"]);
    expect(tickLabels([0, 20, 40])).toEqual(["0", "20", "40"]);
    expect(tickLabels([412.335, 412.34, 412.345])).toEqual(["412.335", "412.340", "412.345"]);
    expect(tickLabels([-0.02, -0.01, 0, 0.01])).toEqual(["-0.02", "-0.01", "0.00", "0.01"]);
    expect(tickLabels([])).toEqual([]);
  });

  it("has lengths in the unit that suits them, at their place on the axis", () => {
    const { x, y, left, right, top, bottom, xAt, yAt } = plotOf();
    expect([x.unit, y.unit]).toEqual(["cm", "cm"]);
    expect(x.ticks.map(({ label }) => label)).toEqual(["0", "2", "4", "6", "8", "10"]);
    for (const { at, label } of x.ticks) expect(at).toBeCloseTo(xAt(Number(label) / 100), 6);
    for (const { at, label } of y.ticks) expect(at).toBeCloseTo(yAt(Number(label) / 100), 6);
    expect([xAt(0), xAt(0.1)]).toEqual([left, right]);
    for (const { at } of y.ticks) expect(at >= top - 1e-6 && at <= bottom + 1e-6).toBe(true);
  });

  it("is as high as wide for lengths where that is asked for", () => {
    fc.assert(
      fc.property(
        fc.double({ min: 0.001, max: 100, noNaN: true }),
        fc.double({ min: 1e-4, max: 100, noNaN: true }),
        (long, high) => {
          const plot = plotOf({
            equal: true,
            parts: [
              [
                { x: 0, y: 0 },
                { x: long, y: high },
              ],
            ],
          });
          const widePx = (plot.xAt(long) - plot.xAt(0)) / long;
          const highPx = (plot.yAt(0) - plot.yAt(high)) / high;
          expect(highPx / widePx).toBeCloseTo(1, 6);
          expect(plot.xAt(long)).toBeLessThanOrEqual(plot.right + 1e-6);
          expect(plot.yAt(high)).toBeGreaterThanOrEqual(plot.top - 1e-6);
          expect(plot.yAt(0)).toBeLessThanOrEqual(plot.bottom + 1e-6);
        },
      ),
    );
  });

  it("has all of its curve within, and its places where they are pointed at", () => {
    const y = fc.option(fc.double({ min: -1e6, max: 1e6, noNaN: true }), { nil: null });
    fc.assert(
      fc.property(fc.array(y, { minLength: 1, maxLength: 40 }), (ys) => {
        const plot = plotOf({ yUnit: "%", parts: [ys.map((each, at) => ({ x: at, y: each }))] });
        const numbers = plot.curves.flatMap((curve) =>
          curve.replaceAll("h0.01", "").split(/[ML ]/).filter(Boolean).map(Number),
        );
        numbers.forEach((each, at) => {
          const [low, high] = at % 2 === 0 ? [plot.left, plot.right] : [plot.top, plot.bottom];
          expect(each >= low - 0.01 && each <= high + 0.01).toBe(true);
        });
        expect(numbers.length / 2).toBe(ys.filter((each) => each !== null).length);
        ys.forEach((_, at) => expect(plot.xOf(plot.xAt(at))).toBeCloseTo(at, 6));
      }),
    );
  });

  it("has gaps where nothing is known, and breaks where the line left the surface", () => {
    const parts = [
      [
        { x: 0, y: 1 },
        { x: 1, y: 2 },
        { x: 2, y: null },
        { x: 3, y: 2 },
      ],
      [
        { x: 3, y: 5 },
        { x: 4, y: 6 },
      ],
    ];
    const plot = plotOf({ yUnit: "", parts });
    expect(plot.curves).toHaveLength(3);
    // a curve with a single point is visible
    expect(plot.curves[1]).toMatch(/^M[\d.]+ [\d.]+h0\.01$/);
    expect(plot.breaks).toEqual([plot.xAt(3)]);
  });

  it("does not blow up noise: what is flat looks flat, and empty ones are plots, too", () => {
    const flat = plotOf({
      parts: [
        [
          { x: 0, y: 1 },
          { x: 1, y: 1 + 1e-9 },
        ],
      ],
    });
    expect(flat.yAt(1) - flat.yAt(1 + 1e-9)).toBeLessThan(1);
    expect(plotOf({ parts: [] }).curves).toEqual([]);
    expect(plotOf({ parts: [[{ x: 0, y: 3 }]], yUnit: "%" }).y.ticks.length).toBeGreaterThan(0);
  });

  it("finds the place that is nearest to a pixel", () => {
    fc.assert(
      fc.property(
        fc.array(fc.double({ min: 0, max: 100, noNaN: true }), { minLength: 1 }),
        fc.double({ min: -10, max: 110, noNaN: true }),
        (xs, x) => {
          xs.sort((a, b) => a - b);
          const distances = xs.map((each) => Math.abs(each - x));
          expect(distances[nearestIndex(xs, x)]).toBe(Math.min(...distances));
        },
      ),
    );
  });
});
