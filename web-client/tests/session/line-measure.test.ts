import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { LineMeasure } from "../../src/session/line-measure";
import { beside } from "../../src/ui/beside";
import type { Point } from "../../src/net/stroke";
import type { MarkPlace } from "../../src/core/protocol.gen";

const kLongMs = 10_000;

type PlacesSeen = readonly (MarkPlace | null)[];

let asked: (readonly Point[])[];
// responds to the last request; by default the surface is the image plane
let answer: (places?: PlacesSeen) => void;
let refuse: () => void;
let measure: LineMeasure<MarkPlace | null>;
let told: (number | null)[];

const settle = (): Promise<unknown> => vi.advanceTimersByTimeAsync(kLongMs);
const draw = (points: readonly Point[], pointer: Point | null = null): void =>
  measure.follow({ points, pointer });

beforeEach(() => {
  vi.useFakeTimers();
  [asked, told] = [[], []];
  measure = new LineMeasure({
    lookAlong: (path) => {
      asked.push(path);
      return new Promise((resolve, reject) => {
        answer = (places = path.map(([x, y]): MarkPlace => [x, y, 0])) => resolve(places);
        refuse = () => reject(new Error("refused"));
      });
    },
    metresAlong: (places) => {
      const hit = places.filter((place) => place !== null);
      return hit
        .slice(1)
        .reduce((sum, [x, y], at) => sum + Math.hypot(x - hit[at]![0], y - hit[at]![1]), 0);
    },
    changed: () => told.push(measure.metres),
  });
});
afterEach(() => {
  vi.useRealTimers();
});

describe("the length of a line that is being drawn", () => {
  it("goes to the pointer, and of what was asked before only the newest is asked next", async () => {
    draw([[0, 0]], [3, 4]);
    draw([[0, 0]], [30, 40]);
    draw([[0, 0]], [60, 80]);
    answer();
    await settle();
    expect(measure.metres).toBe(5);
    answer();
    await settle();
    expect(asked).toEqual([
      [
        [0, 0],
        [3, 4],
      ],
      [
        [0, 0],
        [60, 80],
      ],
    ]);
    expect(told).toEqual([5, 100]);
  });

  it("is asked of the new part alone, whatever is drawn before it", async () => {
    draw(
      [
        [0, 0],
        [10, 0],
      ],
      [10, 5],
    );
    answer();
    await settle();
    expect(measure.metres).toBeNull(); // the length of the segment to the pointer is unknown
    answer();
    await settle();
    expect(measure.metres).toBe(15);
    draw([
      [0, 0],
      [10, 0],
      [10, 7],
      [20, 7],
    ]);
    answer();
    await settle();
    expect(asked).toEqual([
      [
        [0, 0],
        [10, 0],
      ],
      [
        [10, 0],
        [10, 5],
      ],
      [
        [10, 0],
        [10, 7],
        [20, 7],
      ],
    ]);
    expect(measure.metres).toBe(27);
  });

  it("is that of what is left when places are taken back", async () => {
    draw([
      [0, 0],
      [10, 0],
    ]);
    answer();
    await settle();
    draw([
      [0, 0],
      [10, 0],
      [10, 50],
    ]);
    answer();
    await settle();
    expect(measure.metres).toBe(60);
    draw([
      [0, 0],
      [10, 0],
    ]);
    expect([measure.metres, asked.length]).toEqual([10, 2]);
    draw([[0, 0]]);
    expect(measure.metres).toBeNull();
    draw([
      [0, 0],
      [0, 20],
    ]);
    answer();
    await settle();
    expect(measure.metres).toBe(20);
  });

  it("is none where there is no surface, and none of a line that was given up meanwhile", async () => {
    draw([
      [0, 0],
      [10, 0],
    ]);
    answer([null, null]);
    await settle();
    expect(measure.metres).toBeNull();
    measure.follow(null);
    draw([
      [0, 0],
      [10, 0],
    ]);
    measure.follow(null);
    answer();
    await settle();
    expect([measure.metres, asked.length]).toEqual([null, 2]);
  });

  it("is asked again with the next move after a refusal", async () => {
    draw([
      [0, 0],
      [10, 0],
    ]);
    refuse();
    await settle();
    expect([measure.metres, asked.length]).toEqual([null, 1]);
    draw([
      [0, 0],
      [10, 0],
      [20, 0],
    ]);
    answer();
    await settle();
    expect(measure.metres).toBe(20);
  });
});

describe("what is shown beside a place", () => {
  const frame = { width: 400, height: 300 };
  const box = { width: 100, height: 50 };

  it("lies to the right of it and below, or on the other side of it near an edge", () => {
    expect(beside([100, 100], box, frame, 10)).toEqual({ left: 110, top: 110 });
    expect(beside([390, 290], box, frame, 10)).toEqual({ left: 280, top: 230 });
    expect(beside([0, 0], box, frame, 10)).toEqual({ left: 10, top: 10 });
  });

  it("neither covers it nor leaves the frame, or is not shown", () => {
    for (const size of [
      box,
      { width: 300, height: 250 },
      { width: 380, height: 100 },
      { width: 100, height: 290 },
      { width: 399, height: 299 },
      { width: 500, height: 10 },
    ]) {
      for (let x = 0; x <= 400; x += 20) {
        for (let y = 0; y <= 300; y += 20) {
          const at = beside([x, y], size, frame, 10);
          if (!at) continue;
          expect(
            at.left >= 0 &&
              at.top >= 0 &&
              at.left + size.width <= 400 &&
              at.top + size.height <= 300,
          ).toBe(true);
          expect(
            x > at.left && x < at.left + size.width && y > at.top && y < at.top + size.height,
          ).toBe(false);
        }
      }
    }
    expect(beside([200, 150], { width: 399, height: 299 }, frame, 10)).toBeNull();
    expect(beside([200, 10], { width: 380, height: 100 }, frame, 10)).toEqual({
      left: 20,
      top: 20,
    });
  });
});
