import { describe, expect, it } from "vitest";
import {
  PictureDrawing,
  type PicturePart,
  type PictureTool,
} from "../../../src/session/picture/picture-drawing";

/** Returns a drawing with the tool, and its finished parts. The snap distance is 4. */
function drawingOf(tool: PictureTool): { drawing: PictureDrawing; parts: PicturePart[] } {
  const parts: PicturePart[] = [];
  const drawing = new PictureDrawing({
    tool: () => tool,
    radius: () => 2.5,
    snap: () => 4,
    finished: (part) => void parts.push(part),
    changed: () => {},
  });
  return { drawing, parts };
}

function click(drawing: PictureDrawing, x: number, y: number): void {
  drawing.down([x, y]);
  drawing.up();
}

describe("the brush on a picture", () => {
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
        stroke: {
          path: [
            [0, 0],
            [5, 1],
          ],
          radius: 2.5,
        },
      },
      { stroke: { path: [[-3, 4]], radius: 2.5 } },
    ]);
    expect(drawing.path).toEqual([]);
  });

  it("continues a stroke with too many points as another one", () => {
    const { drawing, parts } = drawingOf("brush");
    drawing.down([0, 0]);
    drawing.move(Array.from({ length: 5000 }, (_, i): [number, number] => [i + 1, 0]));
    drawing.up();
    const strokes = parts.map((part) => ("stroke" in part ? part.stroke.path : []));
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

describe("areas on a picture", () => {
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
    expect(parts).toEqual([{ polygon: corners }]);
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
    expect(parts).toEqual([{ polygon: [...corners.slice(0, 2), [30, 30]] }]);
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
        polygon: [
          [0, 0],
          [10, 0],
          [10, 10],
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

describe("lines on a picture", () => {
  it("have clicked points, and end at the last one or with a key", () => {
    const { drawing, parts } = drawingOf("line");
    click(drawing, 0, 0);
    click(drawing, 1, 1); // one point is no line
    expect([drawing.path, parts]).toEqual([[[0, 0]], []]);
    click(drawing, 20, 0);
    expect(drawing.hasCorners).toBe(true);
    click(drawing, 21, 1);
    click(drawing, 0, 0);
    drawing.finish();
    click(drawing, 0, 20);
    drawing.finish();
    const line = (...points: [number, number][]): PicturePart => ({ line: points });
    expect(parts).toEqual([line([0, 0], [20, 0]), line([0, 0], [0, 20])]);
  });

  it("are drawn in one go, without closing at the first point", () => {
    const { drawing, parts } = drawingOf("line");
    drawing.down([0, 0]);
    drawing.move([
      [10, 0],
      [1, 1],
    ]);
    drawing.up();
    expect(parts).toEqual([
      {
        line: [
          [0, 0],
          [10, 0],
          [1, 1],
        ],
      },
    ]);
  });

  it("have at most as many points as a stored line", () => {
    const { drawing, parts } = drawingOf("line");
    drawing.down([0, 0]);
    drawing.move(Array.from({ length: 2000 }, (_, i): [number, number] => [i + 1, 0]));
    drawing.up();
    expect(parts.map((part) => "line" in part && part.line.length)).toEqual([1000]);
  });
});

describe("points on a picture", () => {
  it("are where the pointer was released", () => {
    const { drawing, parts } = drawingOf("point");
    drawing.down([3, 4]);
    drawing.move([[5, 6]]);
    expect(drawing.path).toEqual([[5, 6]]);
    drawing.up();
    expect(parts).toEqual([{ point: [5, 6] }]);
  });
});
