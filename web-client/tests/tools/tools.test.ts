import { beforeEach, describe, expect, it, vi } from "vitest";

import { StrokeHandle } from "../../src/net/stroke";
import type { ChangeMessage } from "../../src/net/outbox";
import { BrushTool, type BrushHost } from "../../src/features/painting/brush-tool";
import { BucketTool } from "../../src/features/painting/bucket-tool";
import { LineTool } from "../../src/features/records/line-tool";
import { OrbitTool, PanTool } from "../../src/tools/navigate";
import {
  kMostPoints,
  LassoTool,
  PolygonTool,
  type EdgeSnapping,
  type OutlineHost,
} from "../../src/tools/outline";
import { PickTool } from "../../src/features/painting/pick-tool";
import type { Tool } from "../../src/tools/tool";
import { ToolManager } from "../../src/tools/tool-manager";

let messages: ChangeMessage[];
let frames: (() => void)[];
let host: BrushHost & { begun: number[]; ended: number; refuse: boolean };
const draw = (): void => frames.splice(0).forEach((frame) => frame());
const paths = (): number[][] =>
  messages.flatMap((message) =>
    message.op === "stroke.extend" ? [message.path.map(([x]) => x)] : [],
  );

beforeEach(() => {
  messages = [];
  frames = [];
  host = {
    begun: [],
    ended: 0,
    refuse: false,
    beginStroke({ x }) {
      if (this.refuse) return null;
      this.begun.push(x);
      return new StrokeHandle(
        "s",
        4096,
        { isBehind: false },
        (message) => void messages.push(message),
      );
    },
    strokeEnded() {
      this.ended += 1;
    },
    radiusPx: () => 20,
    widthOf: (pressure) => pressure / 2,
    nextFrame: (callback) => void frames.push(callback),
  };
});

describe("brush", () => {
  it("a click paints one dab at once", () => {
    const brush = new BrushTool("brush", host);
    brush.down({ x: 5, y: 6 });
    brush.up();
    expect(messages.map((message) => message.op)).toEqual(["stroke.extend", "stroke.end"]);
    expect(host.begun).toEqual([5]);
    expect(host.ended).toBe(1);
  });

  it("points of one drawn picture go in one batch", () => {
    const brush = new BrushTool("brush", host);
    brush.down({ x: 0, y: 0 });
    brush.move([{ x: 10, y: 0 }]);
    brush.move([
      { x: 20, y: 0 },
      { x: 30, y: 0 },
    ]);
    expect(paths()).toEqual([[0]]);
    draw();
    expect(paths()).toEqual([[0], [10, 20, 30]]);
  });

  it("points closer than a tenth of the radius are left out, but the last one is kept", () => {
    const brush = new BrushTool("brush", host);
    brush.down({ x: 0, y: 0 });
    brush.move([1, 1.5, 2.5, 3, 6, 7].map((x) => ({ x, y: 0 })));
    brush.up();
    expect(paths()).toEqual([[0], [2.5, 6, 7]]);
  });

  it("a pen's pressure goes with its points, and is nobody else's", () => {
    const widths = (): (readonly number[] | undefined)[] =>
      messages.flatMap((message) => (message.op === "stroke.extend" ? [message.widths] : []));
    const brush = new BrushTool("brush", host);
    brush.down({ x: 0, y: 0, pressure: 0.5 });
    brush.move([
      { x: 10, y: 0, pressure: 1 },
      { x: 10, y: 0, pressure: 0.9 },
      { x: 10, y: 0, pressure: 0.2 },
    ]);
    brush.up();
    // a change of pressure adds a point without a movement
    expect(widths()).toEqual([[0.25], [0.5, 0.1]]);
    messages = [];
    brush.down({ x: 0, y: 0 });
    brush.up();
    expect(widths()).toEqual([undefined]);
  });

  it("nothing is sent while there is nothing to paint on", () => {
    host.refuse = true;
    const brush = new BrushTool("brush", host);
    brush.down({ x: 0, y: 0 });
    brush.move([{ x: 50, y: 0 }]);
    draw();
    brush.up();
    expect(messages).toEqual([]);
    expect(host.ended).toBe(0);
  });

  it("choosing another tool ends the stroke", () => {
    const brush = new BrushTool("brush", host);
    const orbit = new OrbitTool({ orbit: vi.fn(), pan: vi.fn(), tap: vi.fn() });
    const manager = new ToolManager([brush, orbit], "brush");
    manager.down({ x: 0, y: 0 });
    manager.choose("orbit");
    expect(messages[messages.length - 1]?.op).toBe("stroke.end");
    manager.move([{ x: 90, y: 0 }]);
    expect(paths()).toEqual([[0]]);
  });
});

describe("tool manager", () => {
  const fake = (name: Tool["name"]): Tool & { calls: string[] } => {
    const calls: string[] = [];
    const note = (call: string) => () => void calls.push(call);
    return {
      name,
      calls,
      activate: note("activate"),
      deactivate: note("deactivate"),
      down: note("down"),
      move: note("move"),
      up: note("up"),
      cancel: note("cancel"),
    };
  };

  it("only the active tool gets the drag, between down and up", () => {
    const [orbit, pick] = [fake("orbit"), fake("pick")];
    const manager = new ToolManager([orbit, pick], "orbit");
    manager.move([{ x: 0, y: 0 }]);
    manager.down({ x: 0, y: 0 });
    manager.move([{ x: 1, y: 0 }]);
    manager.up();
    manager.up();
    expect(orbit.calls).toEqual(["activate", "down", "move", "up"]);
    expect(pick.calls).toEqual([]);
  });

  it("a change of tool cancels the drag, tells both tools and the page", () => {
    const [orbit, pick] = [fake("orbit"), fake("pick")];
    const changed = vi.fn();
    const manager = new ToolManager([orbit, pick], "orbit", changed);
    manager.down({ x: 0, y: 0 });
    manager.choose("pick");
    manager.choose("pick");
    expect(orbit.calls).toEqual(["activate", "down", "cancel", "deactivate"]);
    expect(pick.calls).toEqual(["activate"]);
    expect(changed.mock.calls).toEqual([["pick"]]);
    expect(() => manager.choose("brush")).toThrow("no tool named brush");
  });
});

describe("navigation and pick", () => {
  it("drags turn or move by the way from the last point", () => {
    const navigator = { orbit: vi.fn(), pan: vi.fn(), tap: vi.fn() };
    for (const tool of [new OrbitTool(navigator), new PanTool(navigator)]) {
      tool.move([{ x: 9, y: 9 }]);
      tool.down({ x: 10, y: 10 });
      tool.move([
        { x: 11, y: 12 },
        { x: 15, y: 13 },
      ]);
      tool.up();
      tool.move([{ x: 99, y: 99 }]);
    }
    expect(navigator.orbit.mock.calls).toEqual([[5, 3]]);
    expect(navigator.pan.mock.calls).toEqual([[5, 3]]);
  });

  it("a press that stays in place is a tap; one that was dragged away and back is none", () => {
    const navigator = { orbit: vi.fn(), pan: vi.fn(), tap: vi.fn() };
    const tool = new OrbitTool(navigator);
    tool.down({ x: 10, y: 10 });
    tool.move([{ x: 12, y: 13 }]);
    tool.up();
    tool.down({ x: 50, y: 50 });
    tool.move([
      { x: 90, y: 50 },
      { x: 50, y: 50 },
    ]);
    tool.move([{ x: 70, y: 50 }]);
    tool.move([{ x: 50, y: 50 }]);
    tool.up();
    tool.down({ x: 30, y: 30 });
    tool.cancel();
    tool.up();
    expect(navigator.tap.mock.calls).toEqual([[{ x: 10, y: 10 }]]);
  });

  it("pick asks where it is pressed and dragged", () => {
    const picked = vi.fn();
    const tool = new PickTool(picked);
    tool.down({ x: 1, y: 2 });
    tool.move([
      { x: 3, y: 4 },
      { x: 5, y: 6 },
    ]);
    expect(picked.mock.calls).toEqual([[{ x: 1, y: 2 }], [{ x: 5, y: 6 }]]);
  });
});

describe("outlines", () => {
  let outlines: [number, number][][];
  let outlineHost: OutlineHost & { open: number; refuse: boolean };
  beforeEach(() => {
    outlines = [];
    outlineHost = {
      open: 0,
      refuse: false,
      beginOutline() {
        if (!this.refuse) this.open += 1;
        return !this.refuse;
      },
      finishOutline: (path) => void outlines.push(path),
      outlineEnded() {
        this.open -= 1;
      },
      scale: () => 2,
      outlineChanged: () => {},
    };
  });
  const press = (tool: Tool, ...points: [number, number][]): void => {
    for (const [x, y] of points) {
      tool.down({ x, y });
      tool.up();
    }
  };

  it.each<[string, (tool: PolygonTool) => unknown]>([
    ["the first corner", (tool) => press(tool, [12, 10])],
    ["the last corner again", (tool) => press(tool, [101, 99])],
    ["Enter", (tool) => tool.key("Enter")],
  ])("a polygon is closed by %s", (_, close) => {
    const polygon = new PolygonTool(outlineHost);
    press(polygon, [10, 10], [100, 10], [100, 100]);
    expect(outlines).toEqual([]);
    expect(outlineHost.open).toBe(1);
    close(polygon);
    expect(outlines).toEqual([
      [
        [10, 10],
        [100, 10],
        [100, 100],
      ],
    ]);
    expect([outlineHost.open, polygon.outline]).toEqual([0, null]);
  });

  it("a polygon of two corners is not closed", () => {
    const polygon = new PolygonTool(outlineHost);
    press(polygon, [10, 10], [100, 10], [10, 10]);
    polygon.key("Enter");
    expect(outlines).toEqual([]);
    expect(polygon.outline?.points.length).toBe(2);
  });

  it("Backspace takes corners back, Escape all of them; without any, keys mean nothing to it", () => {
    const polygon = new PolygonTool(outlineHost);
    for (const key of ["Escape", "Backspace", "Enter"]) expect(polygon.key(key)).toBe(false);
    press(polygon, [10, 10], [100, 10], [100, 100]);
    expect(polygon.key("b")).toBe(false);
    expect(polygon.key("Backspace")).toBe(true);
    expect(polygon.outline?.points).toEqual([
      [10, 10],
      [100, 10],
    ]);
    expect(polygon.key("Escape")).toBe(true);
    expect([outlineHost.open, polygon.outline, outlines.length]).toEqual([0, null, 0]);
    press(polygon, [10, 10]);
    polygon.key("Backspace");
    expect(outlineHost.open).toBe(0);
  });

  it("a line leads to the pointer, and the first corner says when it closes", () => {
    const polygon = new PolygonTool(outlineHost);
    press(polygon, [10, 10], [100, 10]);
    polygon.hover({ x: 50, y: 60 });
    expect(polygon.outline).toMatchObject({ pointer: [50, 60], closable: false });
    press(polygon, [100, 100]);
    polygon.hover(null);
    expect(polygon.outline).toMatchObject({ pointer: null, closable: true });
  });

  it("a second finger takes back the corner of the first", () => {
    const polygon = new PolygonTool(outlineHost);
    press(polygon, [10, 10], [100, 10]);
    polygon.down({ x: 300, y: 300 });
    polygon.cancel();
    expect(polygon.outline?.points.length).toBe(2);
  });

  it("a lasso is what the drag went round; a click is none", () => {
    const lasso = new LassoTool(outlineHost);
    lasso.down({ x: 0, y: 0 });
    lasso.move([
      { x: 1, y: 0 },
      { x: 50, y: 0 },
      { x: 50, y: 50 },
    ]);
    lasso.move([{ x: 0, y: 50 }]);
    lasso.up();
    expect(outlines).toEqual([
      [
        [0, 0],
        [50, 0],
        [50, 50],
        [0, 50],
      ],
    ]);
    press(lasso, [5, 5]);
    expect([outlines.length, outlineHost.open]).toEqual([1, 0]);
  });

  it("a lasso that is given up paints nothing", () => {
    const lasso = new LassoTool(outlineHost);
    for (const end of [() => lasso.cancel(), () => lasso.key("Escape"), () => lasso.deactivate()]) {
      lasso.down({ x: 0, y: 0 });
      lasso.move([
        { x: 50, y: 0 },
        { x: 50, y: 50 },
      ]);
      end();
    }
    expect([outlines.length, outlineHost.open]).toEqual([0, 0]);
  });

  it("a very long lasso keeps its shape in as many points as an edit may have", () => {
    const lasso = new LassoTool(outlineHost);
    lasso.down({ x: 1000, y: 0 });
    for (let i = 1; i <= 20_000; ++i)
      lasso.move([{ x: 1000 * Math.cos(i / 50), y: 1000 * Math.sin(i / 50) }]);
    lasso.up();
    expect(outlines[0]!.length).toBeGreaterThan(1000);
    expect(outlines[0]!.length).toBeLessThanOrEqual(kMostPoints);
  });

  it("where nothing can be painted no outline begins", () => {
    outlineHost.refuse = true;
    const [lasso, polygon] = [new LassoTool(outlineHost), new PolygonTool(outlineHost)];
    press(lasso, [1, 1]);
    press(polygon, [1, 1]);
    polygon.key("Enter");
    expect([lasso.outline, polygon.outline, outlineHost.open]).toEqual([null, null, 0]);
  });

  it("choosing another tool gives the outline up", () => {
    const polygon = new PolygonTool(outlineHost);
    const manager = new ToolManager([polygon, new PickTool(() => {})], "polygon");
    press(polygon, [10, 10], [100, 10], [100, 100]);
    expect(manager.outline?.points.length).toBe(3);
    manager.choose("pick");
    expect([manager.outline, outlineHost.open, outlines.length]).toEqual([null, 0, 0]);
    expect(manager.key("Enter")).toBe(false);
  });

  it("a drag is a line, finished when it is let go", () => {
    const tool = new LineTool(outlineHost);
    tool.down({ x: 0, y: 0 });
    tool.move([{ x: 4, y: 0 }]); // the movement of an unsteady hand
    tool.move([
      { x: 30, y: 0 },
      { x: 31, y: 0 },
      { x: 60, y: 9 },
    ]);
    expect(tool.outline).toMatchObject({ area: false, pointer: null, corners: [[0, 0]] });
    tool.up();
    expect(outlines).toEqual([
      [
        [0, 0],
        [30, 0],
        [60, 9],
      ],
    ]);
    expect([outlineHost.open, tool.outline]).toEqual([0, null]);
  });

  it.each<[string, (tool: LineTool) => unknown]>([
    ["one more press on the last place", (tool) => press(tool, [101, 50])],
    ["Enter", (tool) => tool.key("Enter")],
  ])("presses are places of a line, and %s ends it", (_, end) => {
    const tool = new LineTool(outlineHost);
    press(tool, [10, 10], [100, 10]);
    tool.hover({ x: 50, y: 60 });
    expect(tool.outline).toMatchObject({
      corners: [
        [10, 10],
        [100, 10],
      ],
      pointer: [50, 60],
    });
    press(tool, [100, 50]);
    expect([outlines, outlineHost.open]).toEqual([[], 1]);
    end(tool);
    expect(outlines).toEqual([
      [
        [10, 10],
        [100, 10],
        [100, 50],
      ],
    ]);
    expect(outlineHost.open).toBe(0);
  });

  it("a double click alone is no line, and a drag after presses goes on with it", () => {
    const tool = new LineTool(outlineHost);
    press(tool, [10, 10], [10, 11]);
    expect([outlines.length, outlineHost.open]).toEqual([0, 1]);
    tool.down({ x: 100, y: 10 });
    tool.move([{ x: 150, y: 10 }]);
    tool.up();
    expect(outlines).toEqual([]);
    tool.key("Enter");
    expect(outlines).toEqual([
      [
        [10, 10],
        [100, 10],
        [150, 10],
      ],
    ]);
  });

  it("places of a line are taken back, by a key or where a second finger came", () => {
    const tool = new LineTool(outlineHost);
    press(tool, [10, 10], [100, 10]);
    tool.down({ x: 200, y: 10 });
    tool.move([{ x: 260, y: 10 }]);
    tool.cancel();
    expect(tool.outline).toMatchObject({
      points: [
        [10, 10],
        [100, 10],
      ],
      corners: [
        [10, 10],
        [100, 10],
      ],
    });
    tool.key("Backspace");
    expect(tool.outline?.points).toEqual([[10, 10]]);
    tool.key("Enter");
    expect([outlines.length, outlineHost.open, tool.outline]).toEqual([0, 0, null]);
    press(tool, [10, 10], [100, 10]);
    tool.key("Escape");
    tool.down({ x: 5, y: 5 });
    tool.cancel();
    expect([outlines.length, outlineHost.open, tool.outline]).toEqual([0, 0, null]);
  });

  it("a line has no more places than the server looks at, however long it is drawn", () => {
    const tool = new LineTool(outlineHost);
    tool.down({ x: 0, y: 0 });
    for (let at = 1; at < 5000; ++at) tool.move([{ x: 10 * at, y: 0 }]);
    tool.up();
    expect(outlines[0]!.length).toBeGreaterThan(400);
    expect(outlines[0]!.length).toBeLessThanOrEqual(1000);
  });

  it("where there is no record to draw for no line begins", () => {
    outlineHost.refuse = true;
    const tool = new LineTool(outlineHost);
    press(tool, [10, 10], [100, 10]);
    expect([tool.outline, outlineHost.open, tool.key("Escape")]).toEqual([null, 0, false]);
  });
});

describe("outlines that follow edges", () => {
  type Place = [number, number];
  let finished: { path: Place[]; corners: boolean }[];
  let edges: EdgeSnapping | null;
  let following: OutlineHost;
  beforeEach(() => {
    finished = [];
    // Corners are set at multiples of ten, and an edge leads first across, then down.
    edges = {
      placeAt: ([x, y]) => [10 * Math.round(x / 10), 10 * Math.round(y / 10)],
      between: ([, y], [x]) => [[x, y]],
      around: (outline) => outline.map(([x, y]) => [x + 1, y + 1]),
    };
    following = {
      beginOutline: () => true,
      finishOutline: (path, corners) => void finished.push({ path, corners }),
      outlineEnded: () => {},
      scale: () => 0.1, // so a press is on a point only within about a pixel
      outlineChanged: () => {},
      edges: () => edges,
    };
  });
  const press = (tool: Tool, ...places: Place[]): void => {
    for (const [x, y] of places) {
      tool.down({ x, y });
      tool.up();
    }
  };

  it("a polygon has the points of the edges, also of the edge that closes it", () => {
    const polygon = new PolygonTool(following);
    press(polygon, [11, 9], [52, 33], [21, 78]);
    expect(polygon.outline?.corners).toEqual([
      [10, 10],
      [50, 30],
      [20, 80],
    ]);
    polygon.key("Enter");
    expect(finished).toEqual([
      {
        path: [
          [10, 10],
          [50, 10],
          [50, 30],
          [20, 30],
          [20, 80],
          [10, 80],
        ],
        corners: false,
      },
    ]);
  });

  it("the segment to the pointer is the one that a click then adds", () => {
    const polygon = new PolygonTool(following);
    press(polygon, [10, 10]);
    polygon.hover({ x: 48, y: 31 });
    const { edge, pointer } = polygon.outline!;
    expect({ edge, pointer }).toEqual({ edge: [[50, 10]], pointer: [50, 30] });
    press(polygon, [48, 31]);
    expect(polygon.outline?.points).toEqual([[10, 10], ...edge!, pointer]);
    // a touch has no pointer after the tap
    polygon.hover(null);
    expect(polygon.outline).toMatchObject({ edge: [], pointer: null });
  });

  it("the first corner closes it, even if the pointer would move elsewhere", () => {
    const polygon = new PolygonTool(following);
    press(polygon, [10, 10], [50, 30], [20, 80]);
    polygon.hover({ x: 10.5, y: 10.5 });
    expect(polygon.outline).toMatchObject({ edge: [[10, 80]], pointer: [10, 10] });
    press(polygon, [10.5, 10.5]);
    expect(finished.length).toBe(1);
  });

  it("Backspace and a second finger remove a corner with its edge", () => {
    const polygon = new PolygonTool(following);
    press(polygon, [10, 10], [50, 30], [20, 80]);
    polygon.key("Backspace");
    expect(polygon.outline?.points).toEqual([
      [10, 10],
      [50, 10],
      [50, 30],
    ]);
    polygon.down({ x: 90, y: 90 });
    expect(polygon.outline?.points.length).toBe(5);
    polygon.cancel();
    expect(polygon.outline?.points.length).toBe(3);
    polygon.key("Backspace");
    expect(polygon.outline).toMatchObject({ points: [[10, 10]], corners: [[10, 10]] });
    polygon.key("Backspace");
    expect(polygon.outline).toBeNull();
  });

  it("two corners are no area, however long the edge between them is", () => {
    const polygon = new PolygonTool(following);
    press(polygon, [10, 10], [50, 30], [10, 10]);
    polygon.key("Enter");
    expect(finished).toEqual([]);
    expect(polygon.outline).toMatchObject({ closable: false });
  });

  it("each segment is straight if nothing is followed when it is set", () => {
    const polygon = new PolygonTool(following);
    press(polygon, [10, 10], [50, 30]);
    const snapping = edges;
    edges = null;
    press(polygon, [23, 78]);
    expect(polygon.outline?.points).toEqual([
      [10, 10],
      [50, 10],
      [50, 30],
      [23, 78],
    ]);
    polygon.key("Escape");
    press(polygon, [1, 1], [5, 1], [5, 5]);
    polygon.key("Enter");
    expect(finished[0]?.corners).toBe(true);
    edges = snapping;
    press(polygon, [1, 1]);
    expect(polygon.outline?.points).toEqual([[0, 0]]);
  });

  it("an edge with too many points becomes a straight segment", () => {
    const long = Array.from({ length: kMostPoints - 1 }, (_, at): Place => [at, 7]);
    edges = { placeAt: (at) => at, between: () => long, around: (outline) => [...outline] };
    const polygon = new PolygonTool(following);
    press(polygon, [10, 10], [50, 30], [20, 80]);
    expect(polygon.outline?.points.length).toBe(3);
    polygon.key("Enter");
    expect(finished[0]?.path.length).toBe(3);
    edges.between = () => long.slice(2);
    press(polygon, [10, 10], [50, 30], [20, 80]);
    expect(polygon.outline?.points.length).toBe(kMostPoints);
    press(polygon, [99, 99]);
    polygon.key("Enter");
    expect(finished[1]?.path.length).toBe(kMostPoints);
  });

  it("a lasso is moved to edges when it ends, unless it then has too many points", () => {
    const drawn: Place[] = [
      [0, 0],
      [50, 0],
      [50, 50],
    ];
    const lasso = new LassoTool(following);
    const draw = (): void => {
      lasso.down({ x: 0, y: 0 });
      lasso.move(drawn.slice(1).map(([x, y]) => ({ x, y })));
      lasso.up();
    };
    draw();
    edges!.around = () => Array.from({ length: kMostPoints + 1 }, (): Place => [1, 1]);
    draw();
    edges = null;
    draw();
    expect(finished).toEqual([
      { path: drawn.map(([x, y]) => [x + 1, y + 1]), corners: false },
      { path: drawn, corners: false },
      { path: drawn, corners: false },
    ]);
  });

  it("a line follows edges between its places, and Backspace removes drawn points one by one", () => {
    const tool = new LineTool(following);
    press(tool, [10, 10], [52, 33]);
    tool.down({ x: 90, y: 30 });
    tool.move([{ x: 95, y: 30 }]);
    tool.up();
    expect(tool.outline?.points).toEqual([
      [10, 10],
      [50, 10],
      [50, 30],
      [90, 30],
      [90, 30],
      [95, 30],
    ]);
    tool.hover({ x: 121, y: 61 });
    expect(tool.outline).toMatchObject({ edge: [[120, 30]], pointer: [120, 60] });
    tool.key("Backspace");
    expect(tool.outline?.points.length).toBe(5);
    tool.key("Backspace");
    tool.key("Backspace");
    expect(tool.outline?.points).toEqual([[10, 10]]);
    press(tool, [52, 33]);
    tool.key("Enter");
    expect(finished[0]?.path).toEqual([
      [10, 10],
      [50, 10],
      [50, 30],
    ]);
  });
});

describe("bucket", () => {
  it("fills where it is pressed, once", () => {
    const places: number[] = [];
    const bucket = new BucketTool(({ x }) => places.push(x));
    bucket.down({ x: 7, y: 8 });
    bucket.move();
    bucket.up();
    expect(places).toEqual([7]);
  });
});
