import { beforeEach, describe, expect, it } from "vitest";
import type { SelectResponse } from "../../../src/core/protocol.gen";
import type { CameraMessage } from "../../../src/math/camera";
import { ApiError } from "../../../src/net/api-error";
import type { Point } from "../../../src/net/stroke";
import type { LitRequest } from "../../../src/session/lit-area";
import {
  AreaSelection,
  kMostOutlines,
  middleAfter,
} from "../../../src/features/painting/area-selection";

const square: Point[] = [
  [0, 0],
  [100, 0],
  [100, 100],
  [0, 100],
];
const camera = (turn: number): CameraMessage =>
  ({ view: [turn], width: 800, height: 600 }) as unknown as CameraMessage;

let area: AreaSelection;
let seen: CameraMessage;
let lit: (LitRequest | null)[];
let filled: number;
let failures: unknown[];
let answer: () => Promise<SelectResponse>;

const flush = (): Promise<void> => new Promise((done) => setTimeout(done));

beforeEach(() => {
  seen = camera(1);
  lit = [];
  filled = 0;
  failures = [];
  answer = () => Promise.resolve({ area_m2: 2, share: 0.5, texels: 9 } as SelectResponse);
  area = new AreaSelection({
    lit: {
      showLasting: (request) => {
        lit.push(request);
        return request ? answer() : Promise.resolve(null);
      },
    },
    camera: () => seen,
    scale: () => 1,
    layers: () => ["wet"],
    fill: () => void (filled += 1),
    failed: (error) => void failures.push(error),
    changed: () => {},
  });
});

const draw = (keys = {}, corners = true): void => {
  area.begin({ x: 0, y: 0, ...keys });
  area.add(square, false, corners);
};

describe("the selected area", () => {
  it("is one outline, which a further one replaces unless a key is held", () => {
    draw();
    draw();
    expect(area.outlines).toHaveLength(1);
    draw({ shift: true });
    draw({ alt: true });
    draw({ shift: true, alt: true });
    expect(area.outlines.map(({ combine }) => combine)).toEqual([
      "add",
      "add",
      "subtract",
      "intersect",
    ]);
    draw();
    expect(area.outlines).toHaveLength(1);
  });

  it("combines outlines as the chosen mode says; the first one is always added", () => {
    area.setMode("subtract");
    draw();
    draw();
    expect(area.outlines.map(({ combine }) => combine)).toEqual(["add", "subtract"]);
  });

  it("keeps the camera that each outline was drawn in", () => {
    draw();
    seen = camera(2);
    draw({ alt: true });
    expect(area.within).toEqual({
      camera: camera(1),
      path: square,
      steps: [{ combine: "subtract", camera: camera(2), path: square }],
    });
    expect(area.outlines.map((each) => area.isInView(each))).toEqual([false, true]);
  });

  it("is measured after each change, and only the newest answer counts", async () => {
    const waiting: ((answer: SelectResponse) => void)[] = [];
    answer = () => new Promise((done) => waiting.push(done));
    draw();
    draw({ shift: true });
    expect(area.measured).toBe(null);
    waiting[1]!({ area_m2: 2 } as SelectResponse);
    waiting[0]!({ area_m2: 1 } as SelectResponse);
    await flush();
    expect(area.measured).toEqual({ area_m2: 2 });
    expect(lit[0]).toEqual({ within: { camera: camera(1), path: square }, layers: ["wet"] });
    area.clear();
    await flush();
    expect([area.measured, lit.at(-1)]).toEqual([null, null]);
  });

  it("reports a failure, but not that a newer request took its place", async () => {
    answer = () => Promise.reject(new ApiError({ status: 499, title: "Cancelled" }));
    draw();
    await flush();
    expect(failures).toEqual([]);
    answer = () => Promise.reject(new ApiError({ status: 503, title: "Busy" }));
    draw();
    await flush();
    expect(failures).toHaveLength(1);
  });

  it("has a limited number of outlines", () => {
    for (let i = 0; i < kMostOutlines; ++i) draw({ shift: true });
    expect(area.refusesMore({ x: 0, y: 0, shift: true })).toBe(true);
    expect(area.refusesMore({ x: 0, y: 0 })).toBe(false); // starts another selection
  });

  it("Enter fills it, Escape discards it, Backspace removes the last outline", () => {
    expect(["Enter", "Escape", "Backspace"].map((key) => area.key(key))).toEqual([
      false,
      false,
      false,
    ]);
    draw();
    draw({ shift: true });
    expect(area.key("a")).toBe(false);
    area.key("Enter");
    expect(filled).toBe(1);
    area.key("Backspace");
    expect(area.outlines).toHaveLength(1);
    area.key("Escape");
    expect(area.isEmpty).toBe(true);
  });
});

describe("the corners of a selection", () => {
  const path = (): Point[] => area.outlines[0]!.path;

  it("are moved by a drag, which is measured once at its end", () => {
    draw();
    const asked = lit.length;
    expect(area.grab({ x: 97, y: 4 })).toBe(true);
    area.drag({ x: 120, y: -10 });
    area.drag({ x: 130, y: -20 });
    expect(path()[1]).toEqual([130, -20]);
    expect(lit.length).toBe(asked);
    area.release(true);
    expect(lit.length).toBe(asked + 1);
  });

  it("are inserted by a drag of the middle between two", () => {
    draw();
    expect(middleAfter(square, 3)).toEqual([0, 50]);
    area.grab({ x: 2, y: 50 });
    area.drag({ x: -30, y: 50 });
    area.release(true);
    expect(path()).toEqual([...square, [-30, 50]]);
  });

  it("return to their place if the drag is canceled", () => {
    draw();
    area.grab({ x: 0, y: 0 });
    area.drag({ x: 50, y: 50 });
    area.release(false);
    expect(path()).toEqual(square);
  });

  it("are deleted by Delete after a press, down to a triangle", () => {
    draw();
    for (const [x, y] of [square[3]!, square[0]!]) {
      area.grab({ x, y });
      area.release(true);
      area.key("Delete");
    }
    expect(path()).toEqual(square.slice(0, 3));
    expect(area.canDelete).toBe(false);
  });

  it("are out of reach with a held key, in another view, or of a lasso", () => {
    draw();
    expect(area.grab({ x: 0, y: 0, shift: true })).toBe(false);
    expect(area.grab({ x: 30, y: 30 })).toBe(false);
    seen = camera(2);
    expect(area.grab({ x: 0, y: 0 })).toBe(false);
    draw({}, false);
    expect(area.grab({ x: 0, y: 0 })).toBe(false);
  });
});
