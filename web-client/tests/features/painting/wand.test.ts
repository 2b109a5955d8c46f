import { beforeEach, describe, expect, it } from "vitest";
import type { Layer } from "../../../src/core/types";
import type { CameraMessage } from "../../../src/math/camera";
import { mostTolerance, Wand } from "../../../src/features/painting/wand";
import { WandTool } from "../../../src/features/painting/wand-tool";

const camera = { view: [1], width: 800, height: 600 } as unknown as CameraMessage;
const at = { camera, x: 4, y: 5 };
const layerOf = (id: number, slug: string, mode = "linear", kind = "numeric"): Layer =>
  ({ id, slug, kind, palette: { mode, min: 0, max: 10 } }) as unknown as Layer;
const damage = layerOf(1, "damage", "categorical");
const relief = layerOf(2, "relief");

let wand: Wand;
let selected: Layer;
let changes: number;

beforeEach(() => {
  selected = damage;
  changes = 0;
  wand = new Wand({
    selected: () => selected,
    layer: (id) => [damage, relief].find((each) => each.id === id) ?? null,
    changed: () => (changes += 1),
  });
});

describe("the wand", () => {
  it("compares colors at first, without a limit", () => {
    expect(wand.likeAt(at)).toEqual({ at, by: "color", tolerance: 12, contiguous: true });
  });

  it("compares what the user chooses", () => {
    wand.set({ look: 7, reachMm: 30, contiguous: false });
    expect(wand.likeAt(at)).toMatchObject({ look: 7, radius_mm: 30, contiguous: false });
    wand.set({ by: "normal" });
    wand.setTolerance(45);
    expect(wand.likeAt(at)).toMatchObject({ by: "normal", tolerance: 45 });
    expect(wand.likeAt(at)).not.toHaveProperty("look");
    wand.set({ by: "value" });
    expect(wand.likeAt(at)).toMatchObject({ layer: "damage", tolerance: 0 });
    wand.setLayer(relief);
    wand.setTolerance(2);
    expect(wand.likeAt(at)).toMatchObject({ layer: "relief", tolerance: 2 });
    wand.set({ by: "normal" });
    expect([wand.tolerance, changes]).toEqual([45, 7]);
  });

  it("keeps comparing the same layer when another one is selected to paint", () => {
    wand.set({ by: "value" });
    expect(wand.likeAt(at).layer).toBe("damage");
    selected = relief;
    expect(wand.likeAt(at).layer).toBe("damage");
  });

  it("keeps tolerances within the range of what is compared", () => {
    expect(mostTolerance("value", damage)).toBe(0);
    expect(mostTolerance("value", layerOf(3, "finds", "linear", "database"))).toBe(0);
    expect(mostTolerance("value", relief)).toBe(5);
    expect(mostTolerance("value", null)).toBe(0);
    wand.setTolerance(500);
    expect(wand.tolerance).toBe(60);
    wand.setTolerance(-1);
    expect(wand.tolerance).toBe(0);
  });
});

describe("the tool", () => {
  let done: string[];
  let brushes: boolean;
  let used: boolean; // whether the selection uses keys
  let tool: WandTool;
  const press = (keys = {}): void => {
    tool.down({ x: 3, y: 4, ...keys });
    tool.up();
  };

  beforeEach(() => {
    done = [];
    used = brushes = false;
    tool = new WandTool({
      active: (isActive) => void done.push(isActive ? "on" : "off"),
      brushes: () => brushes,
      brush: {
        beginStroke: ({ x, alt = false }) => {
          done.push(`brush ${x} ${alt}`);
          return {
            extend: (points) => void done.push(points.map(([x]) => x).join(" ")),
            end: () => void done.push("end"),
          };
        },
        strokeEnded: () => void done.push("ended"),
        radiusPx: () => 10,
        widthOf: () => 1,
        nextFrame: (callback) => callback(),
      },
      orbit: (dx, dy) => void done.push(`orbit ${dx} ${dy}`),
      pan: () => {},
      selectAt: ({ x, y, shift = false }) => void done.push(`select ${x} ${y} ${shift}`),
      middle: () => ({ x: 400, y: 300 }),
      selectionKey: (key) => {
        if (used) done.push(key);
        return used;
      },
    });
  });

  it("selects with a tap, and rotates with a drag", () => {
    press();
    press({ shift: true });
    tool.down({ x: 0, y: 0 });
    tool.move([{ x: 50, y: 10 }]);
    tool.up();
    expect(done).toEqual(["select 3 4 false", "select 3 4 true", "orbit 50 10"]);
  });

  it("selects what the brush passes with a drag, and ends a drag when it is left", () => {
    brushes = true;
    tool.down({ x: 0, y: 0, alt: true });
    tool.move([{ x: 50, y: 10 }]);
    tool.up();
    expect(done).toEqual(["brush 0 true", "0", "50", "end", "ended"]);
    tool.down({ x: 1, y: 0 });
    tool.deactivate();
    tool.down({ x: 2, y: 0 });
    tool.cancel();
    tool.move([{ x: 90, y: 10 }]);
    expect(done.slice(5)).toEqual([
      ...["brush 1 false", "1", "end", "ended", "off"],
      ...["brush 2 false", "2", "end", "ended"],
    ]);
  });

  it("selects in the middle with Enter, fills with it, and adds with Shift and Enter", () => {
    expect([tool.key("Escape"), tool.key("Enter")]).toEqual([false, true]);
    used = true;
    expect([tool.key("Escape"), tool.key("Enter"), tool.key("Enter", true)]).toEqual([
      true,
      true,
      true,
    ]);
    expect(done).toEqual(["select 400 300 false", "Escape", "Enter", "select 400 300 true"]);
  });
});
