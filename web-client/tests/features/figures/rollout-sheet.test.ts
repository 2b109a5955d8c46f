import { describe, expect, it } from "vitest";
import type { RolloutSheet } from "../../../src/core/protocol.gen";
import { isSameSheet, sheetOrigin, withinSheet } from "../../../src/features/figures/rollout-sheet";

const kSheet: RolloutSheet = {
  shape: "cylinder",
  side: "outside",
  axis: { point: [0, 0, 40], direction: [0, 0, 1] },
  zero: [0, -1, 0],
  radius: 0.04,
  half_angle: 0,
  from: -180,
  to: 180,
  left: -0.1257,
  top: 0.04,
  units_per_pixel: 0.0005,
  mm_per_pixel: 0.5,
  width: 503,
  height: 160,
  deviation: 0,
};

describe("a picture of a sheet", () => {
  it("has its place in millimeters, whatever the unit of the model", () => {
    const [left, top] = sheetOrigin(kSheet);
    expect(left).toBeCloseTo(-125.7, 6);
    expect(top).toBeCloseTo(40, 6);
  });
});

describe("two sheets", () => {
  it("are the same if all values are", () => {
    expect(isSameSheet(kSheet, structuredClone(kSheet))).toBe(true);
    expect(isSameSheet(kSheet, { ...kSheet, side: "inside" })).toBe(false);
    const moved = {
      ...kSheet,
      axis: { ...kSheet.axis, point: [0, 0, 41] as [number, number, number] },
    };
    expect(isSameSheet(kSheet, moved)).toBe(false);
  });
});

describe("an area on a sheet", () => {
  it("fixes the fitted sheet, with the cut in the middle of the gap", () => {
    const corners: [number, number][] = [[0, 0]];
    const part = { polygon: corners };
    const polygons = [corners];
    expect(withinSheet(kSheet, part).unrolled).toEqual({
      axis: kSheet.axis,
      radius: 0.04,
      side: "outside",
      cut: 180,
      polygons,
    });
    const open = { ...kSheet, from: -100, to: 140, shape: "cone" as const, half_angle: -6 };
    expect(withinSheet(open, part).unrolled).toMatchObject({ cut: 200, half_angle: -6 });
    const vault = { ...kSheet, shape: "general_cylinder" as const };
    expect(withinSheet(vault, part).unrolled).toEqual({
      axis: kSheet.axis,
      shape: "general_cylinder",
      side: "outside",
      cut: 180,
      polygons,
    });
    const turned = { ...kSheet, from: -10, to: 350 };
    expect(withinSheet(turned, part).unrolled).toMatchObject({ cut: 350 });
    const far = { ...kSheet, from: 190, to: 550 };
    expect(withinSheet(far, part).unrolled).toMatchObject({ cut: 190 });
    const stroke = { path: corners, radius: 2 };
    expect(withinSheet(far, { stroke }).unrolled).toMatchObject({
      strokes: [{ path: corners, radius_mm: 2 }],
    });
  });
});
