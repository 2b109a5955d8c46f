import { beforeEach, describe, expect, it } from "vitest";
import type { Point } from "../../../src/net/stroke";
import { EdgeSnapper, kPartSize, kSnapReach } from "../../../src/features/painting/edge-snapper";
import type { SharpFrame } from "../../../src/features/painting/sharp-frame";
import { frameOf as grayFrame } from "../../pictures";

let frame: SharpFrame | null;
let view: { width: number; height: number };
let scale: number;
let now: number;
let reads: { x: number; y: number; width: number; height: number }[];
let snapper: EdgeSnapper;

/** Makes a gray frame that records its reads. `valueAt` gets the middle of each pixel. */
const frameOf = (
  width: number,
  height: number,
  valueAt: (x: number, y: number) => number,
): SharpFrame => grayFrame(width, height, valueAt, (part) => reads.push(part));
const kMiddle = 80;
const kRadius = 50;
const off = ([x, y]: Point): number => Math.abs(Math.hypot(x - kMiddle, y - kMiddle) - kRadius);
const disc = (): SharpFrame =>
  frameOf(160, 160, (x, y) => (Math.hypot(x - kMiddle, y - kMiddle) < kRadius ? 40 : 200));
const stripe = (at: number): SharpFrame => frameOf(80, 60, (x) => (x < at ? 40 : 200));

beforeEach(() => {
  reads = [];
  view = { width: 160, height: 160 };
  scale = 1;
  now = 0;
  frame = disc();
  snapper = new EdgeSnapper({
    frame: () => frame,
    window: () => view,
    scale: () => scale,
    nowMs: () => now,
  });
});

describe("A point", () => {
  it("moves to an edge that is near, and stays where none is near", () => {
    const near: Point = [kMiddle + kRadius - 3, kMiddle];
    expect(off(near)).toBe(3);
    expect(off(snapper.placeAt(near, null))).toBeLessThanOrEqual(1);
    const far: Point = [kMiddle + kRadius - 2 * kSnapReach, kMiddle];
    expect(snapper.placeAt(far, null)).toBe(far);
  });

  it("moves by CSS pixels, whatever the size of the frame", () => {
    // one pixel of the frame is two pixels of the window and one CSS pixel
    view = { width: 320, height: 320 };
    scale = 2;
    const [x, y] = snapper.placeAt([2 * (kMiddle + kRadius - 3), 2 * kMiddle], null);
    expect(off([x / 2, y / 2])).toBeLessThanOrEqual(1);
    const far: Point = [2 * (kMiddle + kRadius - 2 * kSnapReach), 2 * kMiddle];
    expect(snapper.placeAt(far, null)).toBe(far);
  });

  it("stays outside of the frame", () => {
    for (const at of [
      [-1, 5],
      [5, 161],
      [500, 5],
    ] as Point[]) {
      expect(snapper.placeAt(at, null)).toBe(at);
      expect(snapper.between([80, 30], at)).toEqual([]);
    }
    expect(reads).toEqual([]);
  });
});

describe("An edge between two points", () => {
  const from: Point = [kMiddle + kRadius, kMiddle];
  const to: Point = [kMiddle, kMiddle + kRadius];

  it("is followed with few points, and without its ends", () => {
    const points = snapper.between(from, to);
    expect(points.length).toBeGreaterThan(3);
    expect(points.length).toBeLessThan(40);
    expect(Math.max(...points.map(off))).toBeLessThanOrEqual(1);
    // the simplified segments stay near the edge as well
    const all = [from, ...points, to];
    const middles = all
      .slice(1)
      .map(([x, y], at): Point => [(x + all[at]![0]) / 2, (y + all[at]![1]) / 2]);
    expect(Math.max(...middles.map(off))).toBeLessThan(2);
    for (const end of [from, to])
      expect(
        Math.min(...points.map(([x, y]) => Math.hypot(x - end[0], y - end[1]))),
      ).toBeGreaterThan(0);
  });

  it("is read once for all positions of the pointer", () => {
    const first = snapper.between(from, to);
    for (let x = 20; x < 140; x += 10) snapper.between(from, snapper.placeAt([x, 60], from));
    expect(snapper.between(from, to)).toEqual(first);
    expect(reads).toEqual([{ x: 0, y: 0, width: 160, height: 160 }]);
  });

  it("is straight through noise and along a straight edge", () => {
    let state = 1;
    const random = (): number => (state = (Math.imul(state, 1103515245) + 12345) >>> 0) / 2 ** 32;
    frame = frameOf(160, 160, () => 100 + 40 * random());
    expect(snapper.between([20, 30], [140, 90])).toEqual([]);
    frame = { ...frameOf(160, 160, (_, y) => (y < 60 ? 40 : 200)), number: 2, camera: 2 };
    expect(snapper.between([20.5, 59.5], [140.5, 59.5])).toEqual([]);
  });

  it("is straight while no frame shows the current camera", () => {
    frame = null;
    expect(snapper.between(from, to)).toEqual([]);
    expect(snapper.placeAt(from, null)).toBe(from);
  });
});

describe("An outline drawn around a shape", () => {
  const around = (radius: number): Point[] =>
    Array.from({ length: 60 }, (_, at): Point => {
      const angle = (at / 60) * 2 * Math.PI;
      return [kMiddle + radius * Math.cos(angle), kMiddle + radius * Math.sin(angle)];
    });

  it("moves to its border, also if a pixel of the frame is several pixels of the window", () => {
    for (const size of [1, 2]) {
      scale = size;
      view = { width: 160 * size, height: 160 * size };
      const drawn = around(kRadius + 7).map(([x, y]): Point => [x * size, y * size]);
      for (const [x, y] of snapper.around(drawn))
        expect(off([x / size, y / size])).toBeLessThanOrEqual(1.5);
    }
  });

  it("stays where it is while no frame shows the current camera", () => {
    frame = null;
    expect(snapper.around(around(57))).toEqual(around(57));
  });
});

describe("The read part of the frame", () => {
  it("is never larger than its limit, moves with the pointer, and keeps the last point", () => {
    frame = {
      ...frameOf(2000, 1100, () => 0),
      read: (x, y, width, height) => {
        reads.push({ x, y, width, height });
        return new Uint8ClampedArray(4 * width * height);
      },
    };
    view = { width: 2000, height: 1100 };
    const from: Point = [1000, 600];
    expect(snapper.between(from, [1400, 700])).toEqual([]);
    expect(snapper.between(from, [1410, 690])).toEqual([]);
    expect(snapper.between(from, [600, 200])).toEqual([]);
    expect(reads.length).toBe(2);
    for (const { x, y, width, height } of reads) {
      expect([width, height]).toEqual([kPartSize, kPartSize]);
      expect(x <= 1000 && x + width > 1000 && y <= 600 && y + height > 600).toBe(true);
    }
    // too far for one part
    expect(snapper.between(from, [1500, 600])).toEqual([]);
    expect(snapper.placeAt([1000, 5], from)).toEqual([1000, 5]);
    expect(reads.length).toBe(2);
    // up to the border of the frame
    snapper.between([1990, 1090], [1999.5, 1099.5]);
    snapper.between([5, 5], [0, 0]);
    expect(reads.slice(2).map(({ x, y }) => [x, y])).toEqual([
      [2000 - kPartSize, 1100 - kPartSize],
      [0, 0],
    ]);
  });

  it("is read again at once for another camera, and now and then for newer frames of the same", () => {
    view = { width: 80, height: 60 };
    frame = stripe(30);
    const edge = (): number => Math.round(snapper.placeAt([32, 20], null)[0]);
    expect(Math.abs(edge() - 30)).toBeLessThanOrEqual(1);
    frame = { ...stripe(34), number: 2 };
    expect(edge()).toBeLessThanOrEqual(31);
    expect(reads.length).toBe(1);
    now = 1000;
    expect(Math.abs(edge() - 34)).toBeLessThanOrEqual(1);
    expect(edge()).toBeGreaterThan(32);
    expect(reads.length).toBe(2);
    frame = { ...stripe(30), number: 3, camera: 3 };
    expect(edge()).toBeLessThanOrEqual(31);
    expect(reads.length).toBe(3);
  });
});
