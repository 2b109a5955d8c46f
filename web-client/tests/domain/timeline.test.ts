import { describe, expect, it } from "vitest";

import {
  authorsOf,
  intervalAtPlace,
  intervalOf,
  joinSteps,
  nextInterval,
  placeOfTime,
  stepOf,
  timeAtPlace,
  zoomed,
} from "../../src/domain/timeline";
import type { Timeline, TimelineInterval, TimelineStep } from "../../src/core/protocol.gen";

const iso = (minute: number): string => new Date(Date.UTC(2026, 4, 4, 12, minute)).toISOString();
const interval = (number: number, first: number, last: number): TimelineInterval => ({
  number,
  edits: last - first + 1,
  first,
  last,
  begun: iso(number * 10),
  ended: iso(number * 10 + 5),
  people: [{ user: "ada", edits: last - first + 1 }],
  others: 0,
  layers: [1],
});
const timeline: Timeline = {
  newest: 20,
  edits: 17,
  from: iso(0),
  to: iso(100),
  intervals: [interval(0, 1, 4), interval(3, 5, 9), interval(9, 13, 20)],
};
const step = (last: number, user = "ada", layer = 1): TimelineStep => ({
  first: last,
  last,
  stroke: `${last}`,
  layer,
  user,
  op: "stroke",
  time: iso(last),
  texels_changed: 1,
  area_m2: 1,
});

describe("a timeline", () => {
  it("has a place for each time, also without length", () => {
    expect(placeOfTime(timeline, iso(25))).toBeCloseTo(0.25);
    expect(placeOfTime(timeline, iso(-5))).toBe(0);
    expect(placeOfTime(timeline, iso(500))).toBe(1);
    expect(timeAtPlace(timeline, 0.25)).toBe(iso(25));
    expect(
      placeOfTime({ newest: 1, edits: 1, from: iso(1), to: iso(1), intervals: [] }, iso(1)),
    ).toBe(1);
    expect(timeAtPlace({ newest: 0, edits: 0, intervals: [] }, 0.5)).toBeNull();
  });

  it("shows at a place the last interval that had ended", () => {
    expect(intervalAtPlace(timeline, 0.01)).toBeNull();
    expect(intervalAtPlace(timeline, 0.05)?.last).toBe(4);
    expect(intervalAtPlace(timeline, 0.349)?.last).toBe(4);
    expect(intervalAtPlace(timeline, 0.35)?.last).toBe(9);
    expect(intervalAtPlace(timeline, 1)?.last).toBe(20);
  });

  it("knows the interval of an edit and its neighbors", () => {
    expect(intervalOf(timeline, 0)).toBeNull();
    expect(intervalOf(timeline, 7)?.number).toBe(3);
    expect(intervalOf(timeline, 11)?.number).toBe(3); // an edit to an invisible layer
    expect(nextInterval(timeline, 9, true)?.number).toBe(9);
    expect(nextInterval(timeline, 7, true)?.number).toBe(3);
    expect(nextInterval(timeline, 7, false)?.number).toBe(0);
    expect(nextInterval(timeline, 4, false)).toBeNull();
    expect(nextInterval(timeline, 20, true)).toBeNull();
  });

  it("is zoomed around a time, within its bounds", () => {
    expect(zoomed(timeline, timeline, iso(50), 1 / 4)).toEqual({
      from: new Date(Date.parse(iso(50)) - 12.5 * 60_000).toISOString(),
      to: new Date(Date.parse(iso(50)) + 12.5 * 60_000).toISOString(),
    });
    expect(zoomed(timeline, timeline, iso(0), 1 / 4)).toEqual({ from: iso(0), to: iso(25) });
    expect(zoomed(timeline, timeline, iso(50), 1)).toBeNull();
  });
});

describe("steps", () => {
  it("are joined without repeats, and found by state", () => {
    const steps = joinSteps([step(3), step(5)], [step(5), step(4), step(9)]);
    expect(steps.map(({ last }) => last)).toEqual([3, 4, 5, 9]);
    expect(stepOf(steps, 8)?.last).toBe(5);
    expect(stepOf(steps, 2)).toBeNull();
    const checkpoints = joinSteps([step(3)], [{ ...step(3), stroke: "other", layer: 2 }]);
    expect(checkpoints.map(({ layer }) => layer)).toEqual([1, 2]);
  });

  it("tell who changed what, with the most first", () => {
    const authors = authorsOf([step(1, "ada", 1), step(2, "ben", 2), step(3, "ben", 2)]);
    expect(authors.people.map(({ user }) => user)).toEqual(["ben", "ada"]);
    expect(authors.layers).toEqual([2, 1]);
    expect(authors.edits).toBe(3);
    expect(authorsOf([step(1, "ada"), step(2, "")]).people.map(({ user }) => user)).toEqual([
      "ada",
    ]);
  });
});
