import { describe, expect, it } from "vitest";
import type { Camera } from "../../../src/core/protocol.gen";
import { editThrough, frameThrough, windowOf } from "../../../src/features/photographs/through";

const camera = { view: [1], projection: [2], width: 4000, height: 3000 } as unknown as Camera;

describe("the window of a photograph", () => {
  it("has the width of the picture, and at most that of the camera", () => {
    expect(windowOf(camera, 1200)).toEqual({ ...camera, width: 1200, height: 900 });
    expect([1, 2, 4].map((zoom) => windowOf(camera, null, zoom).width)).toEqual([1200, 2400, 4000]);
    expect(windowOf({ ...camera, width: 640, height: 480 }, null)).toMatchObject({ width: 640 });
  });

  it("has fewer pixels for the model", () => {
    expect(frameThrough(camera)).toMatchObject({ width: 1600, height: 1200 });
    expect(frameThrough({ ...camera, width: 3000, height: 4000 })).toMatchObject({
      width: 1200,
      height: 1600,
    });
    expect(frameThrough({ ...camera, width: 640, height: 480 })).toMatchObject({ width: 640 });
  });
});

describe("a part that is drawn on a photograph", () => {
  it("is an edit through its camera, with pixels from the upper left corner", () => {
    const window = windowOf(camera, 1200);
    const stroke = { path: [[10, -20] as [number, number]], radius: 6 };
    expect(editThrough(window, { stroke }, { value: 3 })).toEqual({
      op: "stroke",
      value: 3,
      camera: window,
      path: [[10, 20]],
      radius_px: 6,
    });
    const polygon: [number, number][] = [
      [0, 0],
      [10, 0],
      [10, -5],
    ];
    expect(editThrough(window, { polygon }, { erase: true })).toEqual({
      op: "polygon",
      erase: true,
      camera: window,
      path: [
        [0, -0],
        [10, -0],
        [10, 5],
      ],
    });
  });
});
