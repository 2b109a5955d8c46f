// The camera of a stop shows the object as large as the kiosk's window permits.
import { describe, expect, it } from "vitest";
import { OrbitCamera } from "../../src/math/camera";
import { placeLike } from "../../src/math/fit-to-window";
import { length, subtract, type Vec3 } from "../../src/math/vector";
import { placeOfObject } from "../../src/kiosk/fit";

const bounds = { min: [500_000, 4_100_000, 600] as Vec3, max: [500_020, 4_100_020, 630] as Vec3 };

function cameraOn(width: number, height: number, perspective = true): OrbitCamera {
  const camera = new OrbitCamera();
  camera.setModel(bounds, "z");
  camera.perspective = perspective;
  camera.resize(width, height);
  camera.fit();
  return camera;
}
const corners = Array.from({ length: 8 }, (_, corner): Vec3 => [
  (corner & 1 ? bounds.max : bounds.min)[0],
  (corner & 2 ? bounds.max : bounds.min)[1],
  (corner & 4 ? bounds.max : bounds.min)[2],
]);
/**
 * Returns the sides of the object in the window, as shares of the window's size. Values from 0 to 1
 * are inside.
 */
function sides(camera: OrbitCamera) {
  const seen = corners.map((corner) => camera.project(corner)!);
  const x = seen.map((at) => at.x / camera.width);
  const y = seen.map((at) => at.y / camera.height);
  return [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)] as const;
}

describe("the object of a stop", () => {
  const windows = { upright: [1080, 1400], wide: [1200, 1080], phone: [390, 420] } as const;
  for (const perspective of [true, false])
    for (const [name, [width, height]] of Object.entries(windows))
      it(`fills an ${name} window in ${perspective ? "perspective" : "parallel"}, whatever room the view has around it`, () => {
        const saved = cameraOn(1600, 1000, perspective);
        saved.orbit(0.3, 0.2);
        saved.zoomAt(1.6, 800, 500); // a large margin around the object
        const own = cameraOn(width, height);
        Object.assign(own, placeOfObject(saved.message(), own));
        const [left, right, top, bottom] = sides(own);
        expect(Math.min(left, 1 - right, top, 1 - bottom)).toBeGreaterThan(-0.01);
        expect(Math.max(right - left, bottom - top)).toBeGreaterThan(0.94);
        expect(length(subtract(own.axes().back, saved.axes().back))).toBeLessThan(1e-9);
      });

  it("is in the middle, also where the view has it at a side", () => {
    const saved = cameraOn(1600, 1000);
    saved.zoomAt(2, 800, 500);
    saved.panPixels(250, 60);
    const own = cameraOn(1080, 1400);
    Object.assign(own, placeOfObject(saved.message(), own));
    const [left, right, top, bottom] = sides(own);
    expect(left).toBeCloseTo(1 - right, 2);
    expect(top).toBeCloseTo(1 - bottom, 2);
  });

  it("is a detail where the view shows a detail: all of the saved window stays in sight", () => {
    const saved = cameraOn(1600, 1000);
    saved.zoomAt(0.15, 800, 500);
    const own = cameraOn(1080, 1400);
    const place = placeOfObject(saved.message(), own);
    const whole = placeLike(saved.message(), own);
    expect(place.halfField).toBeCloseTo(whole.halfField, 6);
    expect(length(subtract(place.target, whole.target))).toBeLessThan(1e-6);
  });
});
