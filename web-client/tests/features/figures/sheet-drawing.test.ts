import { describe, expect, it } from "vitest";
import type { RolloutSheet } from "../../../src/core/protocol.gen";
import {
  isSameSheet,
  sheetBox,
  SheetDrawing,
  withinSheet,
  type SheetPart,
  type SheetTool,
} from "../../../src/features/figures/sheet-drawing";

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

/** Returns a drawing with the tool, and its finished parts. The snap distance is 4 mm. */
function drawingOf(tool: SheetTool): { drawing: SheetDrawing; parts: SheetPart[] } {
  const parts: SheetPart[] = [];
  const drawing = new SheetDrawing({
    tool: () => tool,
    radiusMm: () => 2.5,
    snapMm: () => 4,
    finished: (part) => void parts.push(part),
    changed: () => {},
  });
  return { drawing, parts };
}

function click(drawing: SheetDrawing, x: number, y: number): void {
  drawing.down([x, y]);
  drawing.up();
}

describe("a picture of a sheet", () => {
  it("has its place in millimeters, whatever the unit of the model", () => {
    const box = sheetBox(kSheet, 1, [252, 80]);
    expect(box.left).toBeCloseTo(-125.7, 6);
    expect(box.top).toBeCloseTo(40, 6);
    expect([box.width, box.height]).toEqual([252, 80]);
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
    const part = { polygons: [[[0, 0] as [number, number]]] };
    expect(withinSheet(kSheet, part).unrolled).toEqual({
      axis: kSheet.axis,
      radius: 0.04,
      side: "outside",
      cut: 180,
      ...part,
    });
    const open = { ...kSheet, from: -100, to: 140, shape: "cone" as const, half_angle: -6 };
    expect(withinSheet(open, part).unrolled).toMatchObject({ cut: 200, half_angle: -6 });
    const vault = { ...kSheet, shape: "general_cylinder" as const };
    expect(withinSheet(vault, part).unrolled).toEqual({
      axis: kSheet.axis,
      shape: "general_cylinder",
      side: "outside",
      cut: 180,
      ...part,
    });
    const turned = { ...kSheet, from: -10, to: 350 };
    expect(withinSheet(turned, part).unrolled).toMatchObject({ cut: 350 });
    const far = { ...kSheet, from: 190, to: 550 };
    expect(withinSheet(far, part).unrolled).toMatchObject({ cut: 190 });
  });
});

describe("the brush on a sheet", () => {
  it("makes a stroke of each drag, and a dab of a click", () => {
    const { drawing, parts } = drawingOf("brush");
    drawing.down([0, 0]);
    drawing.move([
      [0.1, 0],
      [5, 1.00004],
    ]);
    drawing.up();
    click(drawing, -3, 4);
    expect(parts).toEqual([
      {
        strokes: [
          {
            path: [
              [0, 0],
              [5, 1],
            ],
            radius_mm: 2.5,
          },
        ],
      },
      { strokes: [{ path: [[-3, 4]], radius_mm: 2.5 }] },
    ]);
    expect(drawing.path).toEqual([]);
  });

  it("continues a stroke with too many points as another one", () => {
    const { drawing, parts } = drawingOf("brush");
    drawing.down([0, 0]);
    drawing.move(Array.from({ length: 5000 }, (_, i): [number, number] => [i + 1, 0]));
    drawing.up();
    const strokes = parts.map((part) => ("strokes" in part ? part.strokes![0]!.path : []));
    expect(strokes.map((path) => path.length)).toEqual([4096, 906]);
    expect(strokes[1]![0]).toEqual(strokes[0]![4095]);
    expect(strokes[1]![905]).toEqual([5000, 0]);
  });

  it("does not draw with a canceled pointer or without a tool", () => {
    const { drawing, parts } = drawingOf("brush");
    drawing.down([0, 0]);
    drawing.cancelPress();
    expect(drawing.path).toEqual([]);
    drawing.move([[9, 9]]);
    drawing.up();
    const idle = drawingOf("move");
    click(idle.drawing, 0, 0);
    expect([...parts, ...idle.parts]).toEqual([]);
  });
});

describe("areas on a sheet", () => {
  const corners: [number, number][] = [
    [0, 0],
    [20, 0],
    [20, 20],
  ];

  it("have clicked corners, and close at the first one", () => {
    const { drawing, parts } = drawingOf("area");
    for (const [x, y] of corners) click(drawing, x, y);
    expect(drawing.hasCorners).toBe(true);
    expect(parts).toEqual([]);
    click(drawing, 1, -2);
    expect(parts).toEqual([{ polygons: [corners] }]);
    expect(drawing.hasCorners).toBe(false);
  });

  it("close with a key, but not with two corners", () => {
    const { drawing, parts } = drawingOf("area");
    for (const [x, y] of corners) click(drawing, x, y);
    drawing.removeCorner();
    drawing.finish();
    expect(parts).toEqual([]);
    click(drawing, 30, 30);
    drawing.finish();
    expect(parts).toEqual([{ polygons: [[...corners.slice(0, 2), [30, 30]]] }]);
  });

  it("keep their corners while the pointer is down", () => {
    const { drawing } = drawingOf("area");
    click(drawing, 0, 0);
    drawing.down([20, 0]);
    for (let i = 0; i < 3; ++i) drawing.removeCorner();
    drawing.move([[20, 1]]);
    drawing.up();
    expect(drawing.path).toEqual(corners.slice(0, 2));
    drawing.removeCorner();
    expect(drawing.path).toEqual(corners.slice(0, 1));
  });

  it("keep their earlier corners if the pointer is canceled", () => {
    const { drawing, parts } = drawingOf("area");
    for (const [x, y] of corners.slice(0, 2)) click(drawing, x, y);
    drawing.down([20, 20]);
    drawing.move([[30, 40]]);
    drawing.cancelPress();
    drawing.move([[50, 50]]);
    drawing.up();
    drawing.cancelPress();
    expect(drawing.path).toEqual(corners.slice(0, 2));
    expect(parts).toEqual([]);
  });

  it("can be discarded once", () => {
    const { drawing } = drawingOf("area");
    expect(drawing.discard()).toBe(false);
    click(drawing, 0, 0);
    expect(drawing.discard()).toBe(true);
    expect(drawing.discard()).toBe(false);
  });

  it("can be drawn as an outline, which closes itself", () => {
    const { drawing, parts } = drawingOf("area");
    drawing.down([0, 0]);
    drawing.move([
      [10, 0],
      [10, 10],
    ]);
    drawing.up();
    expect(parts).toEqual([
      {
        polygons: [
          [
            [0, 0],
            [10, 0],
            [10, 10],
          ],
        ],
      },
    ]);
  });

  it("ignore a hand that trembles during a click", () => {
    const { drawing, parts } = drawingOf("area");
    drawing.down([0, 0]);
    drawing.move([
      [1, 1],
      [2, 1],
      [1, 2],
    ]);
    drawing.up();
    expect(drawing.path).toEqual([[0, 0]]);
    expect(parts).toEqual([]);
  });
});
