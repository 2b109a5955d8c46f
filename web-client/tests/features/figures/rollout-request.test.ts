import { describe, expect, it } from "vitest";

import {
  kNewRollout,
  previewOf,
  rolloutOf,
  rolloutRequest,
  withAxisFields,
  wrongField,
  wrongSurface,
  type RolloutInput,
} from "../../../src/features/figures/rollout-request";

const model = {
  bounds: { min: [0, -2, 10] as const, max: [4, 2, 30] as const },
  up: "-y" as const,
} as unknown as Parameters<typeof rolloutOf>[1];

describe("the request for a rollout", () => {
  it("leaves out what the server chooses", () => {
    expect(rolloutRequest(kNewRollout, model, {})).toEqual({ relief: true });
  });

  it("has the typed values and the content of the view", () => {
    const input: RolloutInput = {
      ...kNewRollout,
      side: "inside",
      shape: "general_cylinder",
      cut: "-90",
      pixel: "0.25",
      relief: false,
    };
    const shown = { layers: [{ layer: 7, visible: false }], looks: [{ look: 3, opacity: 1 }] };
    expect(rolloutRequest(input, model, shown)).toEqual({
      side: "inside",
      shape: "general_cylinder",
      cut: -90,
      mm_per_pixel: 0.25,
      relief: false,
      ...shown,
    });
  });

  it("needs valid numbers", () => {
    expect(wrongField(kNewRollout)).toBeNull();
    expect(wrongField({ ...kNewRollout, cut: "400" })).toBe("cut");
    expect(wrongField({ ...kNewRollout, cut: "left" })).toBe("cut");
    expect(wrongField({ ...kNewRollout, pixel: "0" })).toBe("pixel");
    expect(wrongField({ ...kNewRollout, pixel: "fine" })).toBe("pixel");
    expect(wrongSurface({ ...kNewRollout, pixel: "fine" })).toBeNull();
    expect(wrongSurface({ ...kNewRollout, pixel: "fine", cut: "400" })).toBe("cut");
  });

  it("has the vertical axis through the middle of the model", () => {
    expect(rolloutOf({ ...kNewRollout, axis: "vertical" }, model)).toEqual({
      axis: { point: [2, 0, 20], direction: [0, -1, 0] },
      relief: true,
    });
  });

  it("has the typed axis, which is the vertical axis at first", () => {
    const first = withAxisFields({ ...kNewRollout, axis: "own" }, model);
    expect(first.point).toEqual(["2", "0", "20"]);
    expect(first.direction).toEqual(["0", "-1", "0"]);
    const typed: RolloutInput = { ...first, point: ["1.5", "0", "-7"], direction: ["0", "0", "2"] };
    expect(withAxisFields(typed, model)).toEqual(typed);
    expect(rolloutOf(typed, model).axis).toEqual({ point: [1.5, 0, -7], direction: [0, 0, 2] });
    // another choice ignores the typed axis
    expect(rolloutOf({ ...typed, axis: "auto" }, model).axis).toBeUndefined();
  });

  it("needs three numbers for a typed point and direction", () => {
    const own = withAxisFields({ ...kNewRollout, axis: "own" }, model);
    expect(wrongField(own)).toBeNull();
    expect(wrongField({ ...own, point: ["1", "", "2"] })).toBe("point");
    expect(wrongField({ ...own, direction: ["1", "up", "2"] })).toBe("direction");
    expect(wrongField({ ...own, direction: ["0", "0", "0"] })).toBe("direction");
    expect(wrongField({ ...own, axis: "auto", point: ["", "", ""] })).toBeNull();
  });

  it("is coarser for the preview of a large sheet", () => {
    const request = { relief: true, cut: 5 };
    expect(previewOf(request, { width: 4000, height: 1000, mm_per_pixel: 0.1 })).toEqual({
      relief: true,
      cut: 5,
      mm_per_pixel: 0.5,
    });
    expect(previewOf(request, { width: 300, height: 90, mm_per_pixel: 2 }).mm_per_pixel).toBe(2);
    // a picture for painting details has more pixels
    expect(
      previewOf(request, { width: 4000, height: 1000, mm_per_pixel: 0.1 }, 4).mm_per_pixel,
    ).toBe(0.125);
  });
});
