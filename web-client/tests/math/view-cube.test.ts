import { describe, expect, it } from "vitest";
import { OrbitCamera } from "../../src/math/camera";
import {
  kStandardViews,
  neighborView,
  standardViewOf,
  viewTowards,
} from "../../src/math/view-cube";

describe("The view cube", () => {
  it("names the standard view that the camera has, and no other direction", () => {
    const camera = new OrbitCamera();
    for (const view of kStandardViews) {
      camera.standardView(view);
      expect([standardViewOf(camera), viewTowards(camera)]).toEqual([view, view]);
    }
    camera.firstView();
    expect([standardViewOf(camera), viewTowards(camera)]).toEqual([null, "front"]);
    camera.standardView("right");
    camera.orbit(0.7, 0);
    expect([standardViewOf(camera), viewTowards(camera)]).toEqual([null, "right"]);
    camera.orbit(0.2, 0);
    expect(viewTowards(camera)).toBe("back");
    camera.orbit(0, 0.9);
    expect(viewTowards(camera)).toBe("top");
    camera.orbit(0, -1.8);
    expect(viewTowards(camera)).toBe("bottom");
  });

  it("goes once around with an arrow key, and up and down from everywhere", () => {
    let view = kStandardViews[0]!;
    const seen = [view];
    for (let i = 0; i < 4; ++i) seen.push((view = neighborView(view, "ArrowRight")!));
    expect(seen).toEqual(["front", "right", "back", "left", "front"]);
    expect(neighborView("front", "ArrowLeft")).toBe("left");
    expect(kStandardViews.map((each) => neighborView(each, "ArrowUp"))).toEqual([
      ...Array<string>(4).fill("top"),
      "top",
      "front",
    ]);
    expect([neighborView("top", "ArrowDown"), neighborView("back", "ArrowDown")]).toEqual([
      "front",
      "bottom",
    ]);
    expect(neighborView("front", "Enter")).toBeNull();
  });
});
