import { beforeEach, describe, expect, it } from "vitest";
import type { Within } from "../../../src/core/protocol.gen";
import { Selection } from "../../../src/features/painting/selection";
import type { SharpFrame } from "../../../src/features/painting/sharp-frame";
import { Strokes } from "../../../src/features/painting/strokes";
import type { CameraMessage } from "../../../src/math/camera";
import type { Point } from "../../../src/net/stroke";
import type { PointerSample } from "../../../src/ui/input";
import { frameOf } from "../../pictures";

const camera = (turn: number): CameraMessage =>
  ({ view: [turn], width: 400, height: 400 }) as unknown as CameraMessage;

// A ring around (100, 100) in a frame of half the size of the window.
const ring = (x: number, y: number): number => {
  const distance = Math.hypot(x - 100, y - 100);
  return distance > 20 && distance < 60 ? 200 : 40;
};

let seen: CameraMessage;
let frame: SharpFrame | null;
let later: (() => void)[];
let through: boolean;
let allowed: boolean;
let drawing: number;
let painted: Within[];
let selection: Selection;
let strokes: Strokes;

beforeEach(() => {
  seen = camera(1);
  frame = frameOf(200, 200, ring);
  later = [];
  through = false;
  allowed = true;
  drawing = 0;
  painted = [];
  selection = new Selection({
    lit: { showLasting: () => Promise.resolve(null) },
    camera: () => seen,
    scale: () => 1,
    selected: () => null,
    layer: () => null,
    mayPaint: () => true,
    erases: () => false,
    paint: (within) => {
      painted.push(within);
      return Promise.resolve(true);
    },
    full: () => {},
    failed: (error) => expect.fail(String(error)),
    changed: () => {},
  });
  strokes = new Strokes({
    selection,
    frame: () => frame,
    camera: () => seen,
    scale: () => 1,
    through: () => through,
    begin: () => {
      drawing += Number(allowed);
      return allowed;
    },
    ended: () => (drawing -= 1),
    later: (callback) => void later.push(callback),
    changed: () => {},
  });
});

const wait = (): void => {
  for (const callback of later.splice(0)) callback();
};
/** Draws a stroke. Its area is not searched yet. */
const drawOnly = (path: Point[], keys: Partial<PointerSample> = {}): void => {
  const [[x, y], ...rest] = path as [Point, ...Point[]];
  strokes.down({ x, y, ...keys });
  for (const [nextX, nextY] of rest) strokes.move([{ x: nextX, y: nextY }]);
  strokes.up();
};
const draw = (path: Point[], keys: Partial<PointerSample> = {}): void => {
  drawOnly(path, keys);
  wait();
};
const onRing: Point[] = [
  [200, 110],
  [230, 115],
];
const around: Point[] = [
  [20, 20],
  [380, 20],
];
const inHole: Point[] = [[200, 200]];
const drawRing = (keys: Partial<PointerSample> = {}): void => {
  draw(onRing, keys);
  draw(around, { alt: true });
};
/** Returns the steps of an area that a third stroke has changed. Then there are no strokes. */
const areaWithPartOfHole = (): Selection["steps"] => {
  drawRing();
  draw(inHole);
  const { steps } = selection;
  strokes.giveUp();
  return steps;
};
const square: Point[] = [
  [0, 0],
  [9, 0],
  [9, 9],
];
const addSquare = (): void =>
  selection.addOutline({ camera: seen, path: square, through: false, corners: true });

describe("strokes inside and outside", () => {
  it("say what is missing while there is only one kind, and select nothing", () => {
    expect(strokes.state).toBe("none");
    draw(onRing);
    expect(strokes.state).toBe("no_outside");
    strokes.undo();
    strokes.draw(false);
    draw(around);
    expect(strokes.state).toBe("no_inside");
    expect(selection.isEmpty).toBe(true);
  });

  it("select the area in window pixels, and leave out its hole", () => {
    drawRing();
    draw(inHole, { alt: true });
    expect(strokes.state).toBe("found");
    expect(selection.steps).toHaveLength(1);
    const { camera: by, path, steps, through: hidden } = selection.within!;
    expect([by, hidden]).toEqual([seen, undefined]);
    for (const [x, y] of path!) expect(Math.hypot(x - 200, y - 200)).toBeCloseTo(120, -1);
    expect(steps!.map(({ combine }) => combine)).toEqual(["subtract"]);
    for (const [x, y] of steps![0]!.path) expect(Math.hypot(x - 200, y - 200)).toBeCloseTo(40, -1);
  });

  it("also select hidden surfaces if the option is on", () => {
    through = true;
    drawRing();
    draw(inHole, { alt: true });
    expect([selection.within!.through, selection.within!.steps![0]!.through]).toEqual([true, true]);
  });

  it("with Alt are on the other side than the chosen one", () => {
    strokes.draw(false);
    draw(around);
    draw(onRing, { alt: true });
    expect(strokes.shown.map(({ inside }) => inside)).toEqual([false, true]);
    expect(strokes.state).toBe("found");
  });

  it("replace only their own area, which is combined as at the first stroke", () => {
    addSquare();
    drawRing({ shift: true });
    expect(selection.steps).toHaveLength(2);
    selection.setMode("subtract");
    draw(inHole, { alt: true });
    expect(selection.steps).toHaveLength(2);
    expect(selection.steps.map((step) => ("combine" in step ? step.combine : ""))).toEqual([
      "add",
      "add",
    ]);
    strokes.accept();
    drawRing();
    expect(selection.steps).toHaveLength(3);
    expect(selection.steps[2]).toMatchObject({ combine: "subtract" });
  });

  it("are undone one by one, and the selection is then as it was before", () => {
    addSquare();
    const { steps } = selection;
    drawRing();
    const ofTwo = selection.steps;
    draw(inHole);
    expect(selection.steps).not.toEqual(ofTwo);
    strokes.undo();
    wait();
    expect(selection.steps).toEqual(ofTwo);
    strokes.undo();
    wait();
    expect([strokes.state, selection.steps]).toEqual(["no_outside", steps]);
    strokes.redo();
    wait();
    expect(strokes.state).toBe("found");
    strokes.undo();
    strokes.undo();
    expect([strokes.isOpen, strokes.canRedo, selection.canUndo]).toEqual([false, true, false]);
    draw(onRing);
    expect(strokes.canRedo).toBe(false);
  });

  it("are accepted with Enter, and the next Enter paints", () => {
    drawRing();
    const { steps } = selection;
    expect(strokes.key("Enter")).toBe(true);
    expect([strokes.shown, selection.steps, painted]).toEqual([[], steps, []]);
    strokes.key("Enter");
    expect(painted).toHaveLength(1);
  });

  it("are accepted with the area of the last stroke, which is not found yet", () => {
    const ofThree = areaWithPartOfHole();
    for (const end of [() => strokes.key("Enter"), () => strokes.leave()]) {
      drawRing();
      expect(selection.steps).not.toEqual(ofThree);
      drawOnly(inHole);
      end();
      wait();
      expect(strokes.isOpen).toBe(false);
      expect(selection.steps).toEqual(ofThree);
    }
  });

  it("are not accepted before the area of the last stroke can be found", () => {
    const ofThree = areaWithPartOfHole();
    drawRing();
    const sharp = frame;
    frame = null;
    drawOnly(inHole);
    strokes.accept();
    expect([strokes.state, strokes.isOpen]).toEqual(["searching", true]);
    frame = sharp;
    wait();
    strokes.accept();
    expect(strokes.isOpen).toBe(false);
    expect(selection.steps).toEqual(ofThree);
  });

  it("are not accepted without an area", () => {
    drawRing();
    drawOnly(around);
    strokes.accept();
    expect([strokes.state, strokes.isOpen]).toEqual(["nothing", true]);
  });

  it("are given up with their area even if it is searched again", () => {
    drawRing();
    drawOnly(inHole);
    strokes.giveUp();
    wait();
    expect([strokes.isOpen, selection.isEmpty]).toEqual([false, true]);
  });

  it("are given up with Escape, with their area; the next Escape clears the selection", () => {
    addSquare();
    const { steps } = selection;
    drawRing();
    strokes.key("Escape");
    expect([strokes.isOpen, selection.steps]).toEqual([false, steps]);
    strokes.key("Escape");
    expect(selection.isEmpty).toBe(true);
    expect(strokes.key("Escape")).toBe(false);
  });

  it("do not paint the older selection with Enter before they have an area", () => {
    addSquare();
    draw(onRing);
    expect(strokes.key("Enter")).toBe(true);
    expect([painted, strokes.isOpen]).toEqual([[], true]);
    expect(strokes.key("Backspace")).toBe(true);
    expect(strokes.isOpen).toBe(false);
    expect(strokes.key("x")).toBe(false);
  });

  it("end when the camera moves, and their area stays selected", () => {
    drawRing();
    const { steps } = selection;
    seen = camera(2);
    expect([strokes.isOpen, strokes.shown]).toEqual([false, []]);
    selection.setMode("add");
    drawRing();
    expect(selection.steps[0]).toBe(steps[0]);
    expect(selection.steps).toHaveLength(2);
  });

  it("end when the selection changes otherwise", () => {
    drawRing();
    selection.grow(2);
    expect(strokes.isOpen).toBe(false);
    selection.clear();
    expect([strokes.isOpen, strokes.canRedo]).toEqual([false, false]);
    drawRing();
    selection.addSaved({ where: "true" }, { shift: true });
    expect(strokes.isOpen).toBe(false);
    expect(selection.steps).toHaveLength(2);
  });

  it("end when the selection changes otherwise before they have an area", () => {
    draw(onRing);
    addSquare();
    expect([strokes.isOpen, strokes.shown]).toEqual([false, []]);
    draw(onRing);
    drawOnly(around, { alt: true });
    selection.clear();
    wait();
    expect([strokes.isOpen, selection.isEmpty]).toEqual([false, true]);
  });

  it("are redone only until something else is undone", () => {
    draw(onRing);
    strokes.undo();
    expect(strokes.canRedo).toBe(true);
    strokes.forgetUndone();
    expect(strokes.canRedo).toBe(false);
  });

  it("end when the camera moves during the search", () => {
    draw(onRing);
    drawOnly(around, { alt: true });
    seen = camera(2);
    wait();
    seen = camera(1);
    expect([strokes.isOpen, selection.isEmpty]).toEqual([false, true]);
  });

  it("wait for a frame of the current view", () => {
    const sharp = frame;
    frame = null;
    drawRing();
    expect([strokes.state, selection.isEmpty]).toEqual(["searching", true]);
    frame = sharp;
    wait();
    expect([strokes.state, selection.isEmpty]).toEqual(["found", false]);
  });

  it("find the area only once if they follow each other fast", () => {
    draw(onRing);
    strokes.down({ x: 20, y: 20, alt: true });
    strokes.up();
    strokes.down({ x: 380, y: 20, alt: true });
    expect(later).toHaveLength(1);
    wait();
    expect(strokes.state).toBe("searching");
    strokes.up();
    wait();
    expect(strokes.state).toBe("found");
  });

  it("are searched after the next stroke is canceled", () => {
    for (const cancel of [() => strokes.cancel(), () => strokes.key("Escape")]) {
      draw(onRing);
      drawOnly(around, { alt: true });
      strokes.down({ x: 380, y: 20 });
      wait();
      expect(strokes.state).toBe("searching");
      cancel();
      wait();
      expect(strokes.state).toBe("found");
      strokes.giveUp();
    }
  });

  it("do not begin if painting is not possible, and a second finger cancels a stroke", () => {
    allowed = false;
    draw(onRing);
    expect(strokes.shown).toEqual([]);
    allowed = true;
    strokes.down({ x: 20, y: 20 });
    expect(strokes.shown).toHaveLength(1);
    strokes.cancel();
    strokes.down({ x: 20, y: 20 });
    strokes.key("Escape");
    strokes.up();
    expect([strokes.shown, drawing]).toEqual([[], 0]);
  });

  it("without an area between them say so", () => {
    draw(onRing);
    draw(onRing, { alt: true });
    expect([strokes.state, selection.isEmpty]).toEqual(["nothing", true]);
  });
});
