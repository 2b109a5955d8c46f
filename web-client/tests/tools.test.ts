import { beforeEach, describe, expect, it, vi } from "vitest";

import { StrokeHandle } from "../src/core/connection";
import type { ChangeMessage } from "../src/core/outbox";
import { BrushTool, type BrushHost } from "../src/tools/brush";
import { OrbitTool, PanTool } from "../src/tools/navigate";
import { PickTool } from "../src/tools/pick";
import type { Tool } from "../src/tools/tool";
import { ToolManager } from "../src/tools/tool-manager";

let messages: ChangeMessage[];
let frames: (() => void)[];
let host: BrushHost & { begun: boolean[]; ended: number; refuse: boolean };
const draw = (): void => frames.splice(0).forEach((frame) => frame());
const paths = (): number[][] =>
  messages.flatMap((message) => (message.op === "stroke.extend" ? [message.path.map(([x]) => x)] : []));

beforeEach(() => {
  messages = [];
  frames = [];
  host = {
    begun: [],
    ended: 0,
    refuse: false,
    begin_stroke(erase) {
      if (this.refuse) return null;
      this.begun.push(erase);
      return new StrokeHandle("s", 4096, (message) => void messages.push(message));
    },
    stroke_ended() {
      this.ended += 1;
    },
    radius_px: () => 20,
    next_frame: (callback) => void frames.push(callback),
  };
});

describe("brush", () => {
  it("a click paints one dab at once", () => {
    const brush = new BrushTool("brush", host);
    brush.down({ x: 5, y: 6 });
    brush.up();
    expect(messages.map((message) => message.op)).toEqual(["stroke.extend", "stroke.end"]);
    expect(host.begun).toEqual([false]);
    expect(host.ended).toBe(1);
  });

  it("points of one drawn picture go in one batch", () => {
    const brush = new BrushTool("brush", host);
    brush.down({ x: 0, y: 0 });
    brush.move([{ x: 10, y: 0 }]);
    brush.move([{ x: 20, y: 0 }, { x: 30, y: 0 }]); // prettier-ignore
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

  it("the eraser erases", () => {
    new BrushTool("eraser", host).down({ x: 0, y: 0 });
    expect(host.begun).toEqual([true]);
  });

  it("choosing another tool ends the stroke", () => {
    const brush = new BrushTool("brush", host);
    const orbit = new OrbitTool({ orbit: vi.fn(), pan: vi.fn() });
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
    const navigator = { orbit: vi.fn(), pan: vi.fn() };
    for (const tool of [new OrbitTool(navigator), new PanTool(navigator)]) {
      tool.move([{ x: 9, y: 9 }]);
      tool.down({ x: 10, y: 10 });
      tool.move([{ x: 11, y: 12 }, { x: 15, y: 13 }]); // prettier-ignore
      tool.up();
      tool.move([{ x: 99, y: 99 }]);
    }
    expect(navigator.orbit.mock.calls).toEqual([[5, 3]]);
    expect(navigator.pan.mock.calls).toEqual([[5, 3]]);
  });

  it("pick asks where it is pressed and dragged", () => {
    const picked = vi.fn();
    const tool = new PickTool(picked);
    tool.down({ x: 1, y: 2 });
    tool.move([{ x: 3, y: 4 }, { x: 5, y: 6 }]); // prettier-ignore
    expect(picked.mock.calls).toEqual([[{ x: 1, y: 2 }], [{ x: 5, y: 6 }]]);
  });
});
