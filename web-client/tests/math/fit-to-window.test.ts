import { describe, expect, it } from "vitest";

import { between, OrbitCamera, placeOf, type UpAxis } from "../../src/math/camera";
import { hasArrived, placeLike } from "../../src/math/fit-to-window";
import { add, length, scale, subtract, type Vec3 } from "../../src/math/vector";

// A building in UTM coordinates. Doubles must resolve millimeters there.
const site = { min: [500_000, 4_100_000, 600] as Vec3, max: [500_040, 4_100_020, 612] as Vec3 };

function cameraOn(up: UpAxis, width: number, height: number): OrbitCamera {
  const camera = new OrbitCamera();
  camera.setModel(site, up);
  camera.resize(width, height);
  camera.fit();
  return camera;
}

/** Returns points at the corners of a camera's window, at some depth in front of the eye. */
const corners = (camera: OrbitCamera): Vec3[] =>
  [
    [0, 0],
    [camera.width, 0],
    [0, camera.height],
    [camera.width, camera.height],
  ].map(([x, y]) => camera.pointOnFocusPlane(x!, y!));

const windows: Record<string, [number, number]> = {
  wide: [1600, 700],
  tall: [390, 760],
  square: [500, 500],
};

describe("looking with somebody", () => {
  for (const up of ["x", "y", "z"] as const)
    for (const perspective of [true, false])
      for (const [from, theirs] of Object.entries(windows))
        for (const [to, own] of Object.entries(windows))
          it(`${perspective ? "in perspective" : "in parallel"}, ${up} up, ${from} window to ${to}: all that they see is seen, and no more than needed`, () => {
            const them = cameraOn(up, ...theirs);
            them.perspective = perspective;
            them.orbit(2.1, 0.4);
            them.zoomAt(0.3, 100, 90);
            const me = cameraOn(up, ...own);
            const place = placeLike(them.message(), me);
            Object.assign(me, place);
            const seen = corners(them).map((corner) => me.project(corner)!);
            const beyond = ({ x, y }: { x: number; y: number }): number =>
              Math.max(-x, -y, x - me.width, y - me.height);
            expect(Math.max(...seen.map(beyond))).toBeLessThan(1e-3);
            expect(Math.max(...seen.map(beyond))).toBeGreaterThan(-1e-3);
            expect(length(subtract(me.axes().back, them.axes().back))).toBeLessThan(1e-9);
            if (perspective) expect(length(subtract(me.eye(), them.eye()))).toBeLessThan(1e-6);
            expect(hasArrived(me, place)).toBe(true);
          });

  it("from straight above keeps which way is up", () => {
    const [them, me] = [cameraOn("z", 800, 600), cameraOn("z", 800, 600)];
    them.standardView("top");
    them.orbit(1, 0);
    Object.assign(me, placeLike(them.message(), me));
    expect(length(subtract(me.axes().right, them.axes().right))).toBeLessThan(1e-9);
  });

  it("close to the surface, with the middle of the model behind the eye, stays a camera", () => {
    const [them, me] = [cameraOn("z", 800, 600), cameraOn("z", 400, 600)];
    them.target = add(them.target, scale(them.axes().back, -15));
    them.distance = 0.5;
    Object.assign(me, placeLike(them.message(), me));
    expect(me.distance).toBeGreaterThan(0);
    expect(length(subtract(me.eye(), them.eye()))).toBeLessThan(1e-6);
  });

  it("a camera whose matrix is scaled has the same eye", () => {
    const [them, me] = [cameraOn("z", 800, 600), cameraOn("z", 800, 600)];
    them.orbit(1, 0.2);
    const { view, projection } = them.message();
    const enlarged = view.map((value, index) => (index === 15 ? value : value * 3));
    Object.assign(me, placeLike({ view: enlarged, projection }, me));
    expect(length(subtract(me.eye(), them.eye()))).toBeLessThan(1e-6);
  });

  it("on the way there the eye goes straight, once both turn around the same depth", () => {
    const [them, me] = [cameraOn("z", 800, 600), cameraOn("z", 800, 600)];
    Object.assign(me, placeOf(them));
    me.turnAround(3); // the image stays the same, although the center is nearer
    expect(length(subtract(me.eye(), them.eye()))).toBeLessThan(1e-6);
    const to = placeLike(them.message(), me);
    me.turnAround(to.distance);
    Object.assign(me, between(placeOf(me), to, 0.4));
    expect(length(subtract(me.eye(), them.eye()))).toBeLessThan(1e-6);
  });

  it("has not arrived while anything that can be seen is missing", () => {
    const camera = cameraOn("z", 800, 600);
    const here = placeOf(camera);
    expect(hasArrived(camera, here)).toBe(true);
    const others = [
      { target: add(here.target, [0, 0, here.distance * 0.01]) },
      { distance: here.distance * 1.01 },
      { azimuth: here.azimuth + Math.PI },
      { azimuth: here.azimuth + 0.01 },
      { elevation: here.elevation + 0.01 },
      { perspective: false },
      { halfField: here.halfField * 1.01 },
    ];
    for (const other of others) expect(hasArrived(camera, { ...here, ...other })).toBe(false);
  });
});

describe("on from there alone", () => {
  it("the usual field comes back, and what is as far as the target stays as large", () => {
    const [them, me] = [cameraOn("z", 1600, 700), cameraOn("z", 390, 760)];
    const usual = me.halfField;
    Object.assign(me, placeLike(them.message(), me));
    expect(me.halfField).toBeGreaterThan(usual);
    const [before, right] = [me.project(me.target)!, add(me.target, me.axes().right)];
    const wide = me.project(right)!.x - before.x;
    me.resetField();
    expect(me.halfField).toBe(usual);
    expect(me.project(right)!.x - me.project(me.target)!.x).toBeCloseTo(wide, 6);
  });

  for (const perspective of [true, false])
    it(`turns around what is in the middle${perspective ? "" : ", without perspective, too"}`, () => {
      const camera = cameraOn("z", 800, 600);
      camera.perspective = perspective;
      const seen = add(camera.target, scale(camera.axes().back, 4));
      const before = camera.project(add(seen, [1, 0, 0]))!;
      camera.turnAround(camera.depthOf(seen));
      expect(camera.project(add(seen, [1, 0, 0]))!.x).toBeCloseTo(before.x, 5);
      camera.orbit(1, 0.3);
      expect(camera.project(seen)!.x).toBeCloseTo(400, 4);
      expect(camera.project(seen)!.y).toBeCloseTo(300, 4);
    });
});
