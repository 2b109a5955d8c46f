import { describe, expect, it } from "vitest";

import { kUpAxes, OrbitCamera, type StandardView, type UpAxis } from "../../src/math/camera";
import {
  add,
  dot,
  length,
  scale,
  subtract,
  transform,
  type Vec3,
  type Vec4,
} from "../../src/math/vector";

// A building in UTM coordinates. Doubles must resolve millimeters there.
const site = { min: [500_000, 4_100_000, 600] as Vec3, max: [500_040, 4_100_020, 612] as Vec3 };
const middle: Vec3 = [500_020, 4_100_010, 606];

function cameraOn(up: UpAxis = "z", width = 1280, height = 720): OrbitCamera {
  const camera = new OrbitCamera();
  camera.setModel(site, up);
  camera.resize(width, height);
  camera.fit();
  return camera;
}

const clipOf = (camera: OrbitCamera, point: Vec3): Vec4 =>
  transform(camera.projectionMatrix(), transform(camera.viewMatrix(), [...point, 1]));

function expectClose(actual: readonly number[], wanted: readonly number[], tolerance = 1e-6): void {
  expect(actual.length).toBe(wanted.length);
  actual.forEach((value, index) =>
    expect(Math.abs(value - wanted[index]!)).toBeLessThan(tolerance),
  );
}

describe("standard views", () => {
  // For each up axis, the direction to the eye of the view "front", and the directions right and up
  // in its image.
  const fronts: Record<UpAxis, { eye: Vec3; right: Vec3; up: Vec3 }> = {
    z: { eye: [0, -1, 0], right: [1, 0, 0], up: [0, 0, 1] },
    y: { eye: [0, 0, 1], right: [1, 0, 0], up: [0, 1, 0] },
    x: { eye: [0, 0, -1], right: [0, 1, 0], up: [1, 0, 0] },
    "-z": { eye: [0, 1, 0], right: [1, 0, 0], up: [0, 0, -1] },
    "-y": { eye: [0, 0, -1], right: [1, 0, 0], up: [0, -1, 0] },
    "-x": { eye: [0, 0, 1], right: [0, 1, 0], up: [-1, 0, 0] },
  };

  for (const up of kUpAxes) {
    const front = fronts[up];
    const expected: Record<StandardView, Vec3> = {
      front: front.eye,
      back: scale(front.eye, -1),
      right: front.right,
      left: scale(front.right, -1),
      top: front.up,
      bottom: scale(front.up, -1),
    };
    for (const view of Object.keys(expected) as StandardView[]) {
      it(`${view} looks from the ${view} when ${up} is up`, () => {
        const camera = cameraOn(up);
        camera.standardView(view);
        expectClose(camera.axes().back, expected[view]);
        const { right, up: screenUp, back } = camera.axes();
        expect(dot(right, screenUp)).toBeCloseTo(0, 12);
        expect(dot(right, back)).toBeCloseTo(0, 12);
        expect(length(screenUp)).toBeCloseTo(1, 12);
        if (view !== "top" && view !== "bottom") expectClose(screenUp, front.up);
        else expectClose(right, front.right);
      });
    }
  }
});

describe("matrices", () => {
  for (const perspective of [true, false]) {
    const kind = perspective ? "perspective" : "orthographic";

    it(`the whole model lies within the ${kind} frustum after a fit, from any side and in any window`, () => {
      for (const [width, height] of [
        [1280, 720],
        [390, 844],
        [100, 100],
      ] as const) {
        for (let azimuth = -3; azimuth <= 3; azimuth += 0.7) {
          for (const elevation of [-1.5, -0.4, 0, 0.8, 1.57]) {
            const camera = cameraOn("z", width, height);
            camera.perspective = perspective;
            camera.azimuth = azimuth;
            camera.elevation = elevation;
            camera.fit();
            for (let corner = 0; corner < 8; ++corner) {
              const point: Vec3 = [0, 1, 2].map(
                (axis) => (corner & (1 << axis) ? site.max : site.min)[axis]!,
              ) as unknown as Vec3;
              const [x, y, z, w] = clipOf(camera, point);
              expect(w).toBeGreaterThan(0);
              for (const value of [x, y, z]) expect(Math.abs(value / w)).toBeLessThan(1.000001);
            }
          }
        }
      }
    });

    it(`the point under a ${kind} pixel is projected onto it`, () => {
      const camera = cameraOn();
      camera.perspective = perspective;
      camera.orbit(0.7, 0.3);
      const seen = camera.project(camera.pointOnFocusPlane(200.5, 611.25))!;
      expect(seen.x).toBeCloseTo(200.5, 5);
      expect(seen.y).toBeCloseTo(611.25, 5);
      expect(seen.depth).toBeCloseTo(camera.distance, 5);
    });

    it(`one ${kind} window pixel is unit_per_pixel wide at its depth`, () => {
      const camera = cameraOn();
      camera.perspective = perspective;
      const point = add(middle, scale(camera.axes().back, 7));
      const depth = camera.depthOf(point);
      const beside = add(point, scale(camera.axes().right, camera.unitPerPixel(depth)));
      expect(camera.project(beside)!.x - camera.project(point)!.x).toBeCloseTo(1, 5);
      expect(camera.pixelSize()(point)).toBeCloseTo(camera.unitPerPixel(depth), 8);
    });
  }

  it("the view matrix is a rotation and keeps the eye at zero", () => {
    const camera = cameraOn();
    camera.orbit(1, 0.5);
    expectClose(transform(camera.viewMatrix(), [...camera.eye(), 1]), [0, 0, 0, 1], 1e-6);
  });

  it("what is behind the eye has no place in the window", () => {
    const camera = cameraOn();
    expect(camera.project(add(camera.eye(), camera.axes().back))).toBeNull();
  });
});

describe("movement", () => {
  it("zooming keeps the point of the focus plane under the pointer", () => {
    const camera = cameraOn();
    camera.orbit(0.4, 0.2);
    const anchor = camera.pointOnFocusPlane(900, 150);
    camera.zoomAt(0.31, 900, 150);
    const seen = camera.project(anchor)!;
    expect(seen.x).toBeCloseTo(900, 4);
    expect(seen.y).toBeCloseTo(150, 4);
  });

  it("zoom stops before it passes through or loses the model", () => {
    const camera = cameraOn();
    for (let i = 0; i < 500; ++i) camera.zoomAt(0.5, 640, 360);
    expect(camera.distance).toBeGreaterThan(0);
    expect(camera.projectionMatrix().every(Number.isFinite)).toBe(true);
    for (let i = 0; i < 500; ++i) camera.zoomAt(2, 640, 360);
    expect(camera.distance).toBeLessThan(2000);
  });

  it("panning moves the picture with the pointer", () => {
    const camera = cameraOn();
    const before = camera.project(camera.target)!;
    const point = camera.target;
    camera.panPixels(33, -21);
    const after = camera.project(point)!;
    expect(after.x - before.x).toBeCloseTo(33, 5);
    expect(after.y - before.y).toBeCloseTo(-21, 5);
  });

  it("orbiting keeps target and distance, and stops at the poles", () => {
    const camera = cameraOn();
    const { target, distance } = camera;
    camera.orbitPixels(200, 5000);
    expect(camera.target).toEqual(target);
    expect(length(subtract(camera.eye(), target))).toBeCloseTo(distance, 6);
    expect(camera.elevation).toBeCloseTo(Math.PI / 2, 12);
    expect(camera.viewMatrix().every(Number.isFinite)).toBe(true);
  });

  it("perspective and orthographic show the target equally large", () => {
    const camera = cameraOn();
    const perspective = camera.unitPerPixel();
    camera.perspective = false;
    expect(camera.unitPerPixel()).toBeCloseTo(perspective, 12);
  });
});

describe("hidden parts", () => {
  const camera = new OrbitCamera();
  camera.setModel({ min: [0, 0, 0], max: [10, 10, 10] }, "z");
  camera.partBoxes = [
    { min: [0, 0, 0], max: [4, 10, 10] },
    { min: [3, 0, 0], max: [10, 10, 10] },
  ];

  it("are in the message for the server only if there are any", () => {
    camera.hiddenParts = [];
    expect(camera.message()).not.toHaveProperty("hidden_parts");
    camera.hiddenParts = [1];
    expect(camera.message().hidden_parts).toEqual([1]);
  });
  it("hide the points that can only be on them", () => {
    camera.hiddenParts = [1];
    expect(camera.cutsAway([8, 5, 5])).toBe(true);
    expect(camera.cutsAway([3.5, 5, 5])).toBe(false); // in both boxes
    expect(camera.cutsAway([1, 5, 5])).toBe(false);
    expect(camera.cutsAway([20, 5, 5])).toBe(false); // in no box
    camera.hiddenParts = [];
    expect(camera.cutsAway([8, 5, 5])).toBe(false);
  });
});
