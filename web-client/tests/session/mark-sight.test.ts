import { beforeEach, describe, expect, it } from "vitest";
import type { ProfileRequest, ProfileSample } from "../../src/core/protocol.gen";
import { sightOnSheet, sightThrough, type SightHost } from "../../src/session/mark-sight";
import { fakeApi } from "../fake-api";

const camera = {
  view: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  projection: [0.02, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1],
  width: 100,
  height: 100,
};

let asked: ProfileRequest[];
let host: SightHost;

/** A surface that is at z = 7 where x is not negative, and nowhere else. */
const sampleAt = ([x, y]: readonly [number, number]): ProfileSample =>
  x < 0
    ? { along_mm: 0, point: { hit: false } }
    : {
        along_mm: 0,
        point: { hit: true, position: [x, y, 7], normal: [0, 0, 1] },
      };

beforeEach(() => {
  asked = [];
  host = {
    api: fakeApi({
      "POST /models/{model}/profile": ({ body }) => {
        asked.push(structuredClone(body) as ProfileRequest);
        const path = (body.unrolled?.path ?? body.path)!;
        return { length_mm: 0, samples: path.map(sampleAt) };
      },
      "POST /models/{model}/pick": ({ body }) => ({
        ...sampleAt([body.x, body.y]).point,
        values: {},
      }),
    }),
    model: { id: 4, unit: "cm" },
  };
});

describe("what is drawn through a camera", () => {
  it("is the surface under its pixels", async () => {
    const sight = sightThrough(host, camera, 2);
    expect(await sight.at([3, 4])).toEqual([3, 4, 7]);
    expect(await sight.at([-1, 4])).toBeNull();
    const steps = await sight.along([
      [0, 0],
      [1, 0],
    ]);
    expect(steps.map(({ place }) => place)).toEqual([
      [0, 0, 7],
      [1, 0, 7],
    ]);
    expect(asked[0]!.camera).toEqual(camera);
    expect([sight.measures.pixelAt([0, 0, 0]), sight.measures.scale]).toEqual([1, 2]);
  });
});

describe("what is drawn on an unrolled sheet", () => {
  const sheet = { radius: 5, side: "outside" } as const;

  it("is the surface that the sheet shows, in steps of a pixel", async () => {
    const sight = sightOnSheet(host, sheet, 0.5);
    const steps = await sight.along([
      [-0.5, 0],
      [1, 0],
      [1, 0.2],
    ]);
    expect(steps.map(({ at }) => at)).toEqual([
      [-1, 0],
      [0, 0],
      [1, 0],
      [2, 0],
      [2, 0.4],
    ]);
    expect(steps.map(({ place }) => place?.[0])).toEqual([undefined, 0, 0.5, 1, 1]);
    expect(asked[0]!.unrolled).toMatchObject(sheet);
    expect(sight.measures.pixelAt([0, 0, 0])).toBeCloseTo(0.05, 12); // of a model in centimeters
    expect(await sight.at([2, 3])).toEqual([2, 3, 7]);
    expect(await sight.at([-2, 3])).toBeNull();
  });

  it("has at most as many points as a request can have", async () => {
    const sight = sightOnSheet(host, sheet, 0.01);
    const zigzag = Array.from({ length: 600 }, (_, i): [number, number] => [i % 2, i / 100]);
    await sight.along(zigzag);
    expect(asked[0]!.unrolled!.path.length).toBeLessThanOrEqual(1000);
    await sight.along([
      [0, 0],
      [1e6, 0],
    ]);
    expect(asked[1]!.unrolled!.path.length).toBeLessThanOrEqual(1000);
    expect(asked[1]!.unrolled!.path.length).toBeGreaterThan(900);
  });
});
