import { beforeEach, describe, expect, it } from "vitest";
import type { SelectResponse, Within } from "../../../src/core/protocol.gen";
import type { Layer } from "../../../src/core/types";
import type { CameraMessage } from "../../../src/math/camera";
import { ApiError } from "../../../src/net/api-error";
import type { Point } from "../../../src/net/stroke";
import type { LitRequest } from "../../../src/session/lit-area";
import { middleAfter, Selection } from "../../../src/features/painting/selection";
import { isPart, kMostParts } from "../../../src/features/painting/selection-steps";

const square: Point[] = [
  [0, 0],
  [100, 0],
  [100, 100],
  [0, 100],
];
const camera = (turn: number): CameraMessage =>
  ({ view: [turn], width: 800, height: 600 }) as unknown as CameraMessage;
const layerOf = (id: number, slug: string, mode = "linear", kind = "numeric"): Layer =>
  ({ id, slug, kind, palette: { mode, min: 0, max: 10 } }) as unknown as Layer;
const damage = layerOf(1, "damage", "categorical");
const relief = layerOf(2, "relief");

let selection: Selection;
let seen: CameraMessage;
let chosen: Layer;
let lit: (LitRequest | null)[];
let waiting: ((found: SelectResponse | Error) => void)[];
let painted: [Within, boolean][];
let failures: unknown[];
let full: number;
let paints: boolean;

const flush = (): Promise<void> => new Promise((done) => setTimeout(done));
const answer = async (found: Partial<SelectResponse> | Error): Promise<void> => {
  waiting.shift()!(found as SelectResponse);
  await flush();
};
const problem = (status: number): ApiError => new ApiError({ title: "No", status });
const likes = (): unknown[] => lit.map((request) => request?.within?.like);
const combines = (): string[] => selection.steps.filter(isPart).map(({ combine }) => combine);

beforeEach(() => {
  seen = camera(1);
  chosen = damage;
  lit = [];
  waiting = [];
  painted = [];
  failures = [];
  full = 0;
  paints = true;
  selection = new Selection({
    lit: {
      showLasting: (request) => {
        lit.push(request);
        if (!request) return Promise.resolve(null);
        return new Promise((done, fail) =>
          waiting.push((found) => (found instanceof Error ? fail(found) : done(found))),
        );
      },
    },
    camera: () => seen,
    scale: () => 1,
    selected: () => chosen,
    layer: (id) => [damage, relief].find((each) => each.id === id) ?? null,
    mayPaint: () => paints,
    erases: () => false,
    paint: (within, erases) => {
      painted.push([within, erases]);
      return Promise.resolve(paints);
    },
    full: () => (full += 1),
    failed: (error) => void failures.push(error),
    changed: () => {},
  });
});

const draw = (keys = {}, corners = true): void =>
  selection.addOutline({ camera: seen, path: square, through: false, corners }, keys);
const click = (at: Point = [40, 50], keys = {}): void => selection.addSimilar(at, keys);

describe("the selection", () => {
  it("is one part, which a further one replaces unless a key is held", () => {
    draw();
    click();
    expect(selection.steps).toHaveLength(1);
    draw({ shift: true });
    click([1, 1], { alt: true });
    draw({ shift: true, alt: true });
    expect(combines()).toEqual(["add", "add", "subtract", "intersect"]);
    draw();
    expect(selection.steps).toHaveLength(1);
  });

  it("combines parts as the chosen mode says; the first one is always added", () => {
    selection.setMode("subtract");
    draw();
    click();
    draw({ shift: true });
    expect(combines()).toEqual(["add", "subtract", "add"]);
    selection.clear();
    expect(selection.mode).toBe("replace");
  });

  it("is sent in the contract's format, in the order of its parts", () => {
    click();
    draw({ alt: true });
    selection.grow(5);
    selection.addSaved({ where: "wet > 1" }, { shift: true });
    selection.smooth(2);
    const like = {
      at: { camera: seen, x: 40, y: 50 },
      by: "color",
      tolerance: 12,
      contiguous: true,
    };
    const wanted = {
      parts: [
        {
          combine: "add",
          within: {
            parts: [
              { combine: "add", within: { like } },
              { combine: "subtract", within: { camera: seen, path: square } },
            ],
            grow_mm: 5,
          },
        },
        { combine: "add", within: { where: "wet > 1" } },
      ],
      smooth_mm: 2,
    };
    expect(selection.within).toEqual(wanted);
    expect(lit.at(-1)).toEqual({ within: wanted, layers: ["damage"] });
  });

  it("keeps the camera that each outline was drawn in", () => {
    draw();
    seen = camera(2);
    draw({ alt: true });
    expect(selection.within).toEqual({
      camera: camera(1),
      path: square,
      steps: [{ combine: "subtract", camera: camera(2), path: square }],
    });
    expect(selection.outlines.map(({ outline }) => selection.isInView(outline))).toEqual([
      false,
      true,
    ]);
  });

  it("has a limited number of parts and of nested changes of the border", () => {
    for (let i = 0; i < kMostParts; ++i) draw({ shift: true });
    expect(selection.refusesMore({ shift: true })).toBe(true);
    click([1, 1], { shift: true });
    expect([selection.steps.length, full]).toEqual([kMostParts, 2]);
    expect(selection.refusesMore({})).toBe(false); // starts another selection
    click();
    for (let i = 0; i < 9; ++i) selection.grow(i % 2 === 0 ? 5 : -5);
    // shrinking on a fifth level is refused, but not more growth on the fourth
    expect([selection.steps.length, full]).toEqual([8, 4]);
  });

  it("loads a saved selection as its steps, and cannot be changed while it is empty", () => {
    selection.grow(5);
    expect(selection.isEmpty).toBe(true);
    selection.addSaved({
      parts: [{ within: { where: "a" } }, { within: { where: "b" } }],
      grow_mm: 3,
    });
    expect(selection.steps).toEqual([
      { combine: "add", within: { where: "a" } },
      { combine: "add", within: { where: "b" } },
      { grow_mm: 3 },
    ]);
  });
});

describe("its measurement", () => {
  it("is requested after each change, and only the newest answer counts", async () => {
    draw();
    draw({ shift: true });
    expect(lit).toHaveLength(2);
    waiting[1]!({ area_m2: 2 } as SelectResponse);
    waiting[0]!({ area_m2: 1 } as SelectResponse);
    await flush();
    expect(selection.measured).toEqual({ area_m2: 2 });
    selection.clear();
    await flush();
    expect([selection.measured, lit.at(-1)]).toEqual([null, null]);
  });

  it("names the layer whose values are shown, also after another one was selected", async () => {
    draw();
    await answer({ texels: 1 });
    chosen = relief;
    selection.measureAgain();
    expect(lit.map((request) => request?.layers)).toEqual([["damage"], ["relief"]]);
    await answer({ texels: 2 });
    expect(selection.measured?.texels).toBe(2);
  });

  it("is requested again if the moved camera ended the request", async () => {
    click();
    await answer(problem(499));
    expect([lit.length, failures]).toEqual([2, []]);
    await answer({ texels: 3 });
    expect(selection.measured?.texels).toBe(3);
  });

  it("that a newer request has ended reports nothing", async () => {
    draw();
    draw();
    await answer(problem(499));
    expect([failures, lit.length]).toEqual([[], 2]);
  });

  it("that fails keeps the selection, and can be repeated", async () => {
    draw();
    await answer(problem(503));
    expect([failures.length, selection.unmeasured, selection.isEmpty]).toEqual([1, true, false]);
    selection.measureAgain();
    await answer({ texels: 3 });
    expect([selection.unmeasured, selection.measured?.texels]).toEqual([false, 3]);
  });

  it("that the server refuses drops the first part", async () => {
    click();
    const refusal = problem(422);
    await answer(refusal);
    expect([failures, selection.isEmpty]).toEqual([[refusal], true]);
  });

  it("that the server refuses returns to the steps before", async () => {
    draw();
    await answer({ texels: 1 });
    const [before] = selection.steps;
    click([1, 1], { alt: true });
    await answer(problem(422));
    expect([selection.steps, selection.canUndo, failures.length]).toEqual([[before], false, 1]);
    await answer({ texels: 1 });
    expect(selection.measured?.texels).toBe(1);
  });

  it("of a discarded selection is not shown later", async () => {
    click();
    selection.clear();
    expect(lit.at(-1)).toBeNull();
    await answer(problem(499));
    expect([lit.length, selection.isEmpty, failures]).toEqual([2, true, []]);
    selection.clear();
    expect(lit).toHaveLength(2);
  });
});

describe("the options of the wand", () => {
  it("change its last part while it is the last one", async () => {
    click();
    await answer({ texels: 1 });
    selection.wand.setTolerance(30);
    expect(likes()).toMatchObject([{ tolerance: 12 }, { tolerance: 30 }]);
    await answer({ texels: 2 });
    selection.grow(5);
    selection.wand.setTolerance(40);
    expect(selection.within).toMatchObject({ like: { tolerance: 40 }, grow_mm: 5 });
    draw({ shift: true });
    const asked = lit.length;
    selection.wand.setTolerance(50);
    expect([selection.clicked, lit.length]).toEqual([null, asked]);
    click([2, 2], { shift: true });
    expect(likes().filter(Boolean)).toHaveLength(3);
    expect(selection.clicked?.within.like?.tolerance).toBe(50);
  });

  it("apply to the part of a brush too, which grows while the brush moves", async () => {
    selection.wandIsActive(true);
    selection.useBrush(true);
    expect(selection.mode).toBe("add");
    selection.addSimilar([10, 10], {}, 4);
    await answer({ texels: 1 });
    selection.brushTo(
      [
        [12, 10],
        [13, 10],
        [19, 10],
      ],
      3,
    );
    const at = { camera: seen, x: 10, y: 10 };
    const path = [
      [10, 10],
      [13, 10],
      [16, 10], // the pointer was faster than the frames
      [19, 10],
    ];
    expect(likes().at(-1)).toMatchObject({ at, path, radius_mm: 4, tolerance: 12 });
    selection.brushTo([[20, 10]], 3); // too near to the last pixel
    await answer({ texels: 2 });
    expect(lit).toHaveLength(2);
    selection.wand.setTolerance(30);
    expect(likes().at(-1)).toMatchObject({ path, tolerance: 30 });
    selection.addSimilar([50, 50], { alt: true }, 4);
    expect(combines()).toEqual(["add", "subtract"]);
    selection.undo(); // a stroke is one step
    expect(selection.steps).toHaveLength(1);
    selection.brushTo([[99, 99]], 3);
    expect(selection.steps).toMatchObject([{ within: { like: { path } } }]);
    selection.clear();
    expect(selection.mode).toBe("add");
    selection.wandIsActive(false); // other tools replace the selection
    expect(selection.mode).toBe("replace");
    selection.wandIsActive(true);
    selection.setMode("subtract"); // a choice of the user stays
    selection.useBrush(false);
    expect(selection.mode).toBe("subtract");
  });

  it("of a brush are kept if the server refuses the next stroke before it has measured them", async () => {
    selection.wandIsActive(true);
    selection.useBrush(true);
    selection.addSimilar([10, 10], {}, 4);
    selection.brushTo([[30, 10]], 4);
    const [first] = selection.steps;
    selection.addSimilar([500, 10], {}, 4); // off the model
    await answer(problem(499));
    await answer(problem(422));
    expect([selection.steps, selection.canUndo]).toEqual([[first], false]);
  });

  it("of a brush have a longest path", () => {
    selection.addSimilar([0, 0], {}, 4);
    selection.brushTo(
      Array.from({ length: 5000 }, (_, x): Point => [x + 1, 0]),
      1,
    );
    expect(selection.clicked?.within.like?.path).toHaveLength(4096);
  });

  it("send only the newest of the changes during a request", async () => {
    click();
    for (const tolerance of [3, 6, 9]) selection.wand.setTolerance(tolerance);
    expect(lit).toHaveLength(1);
    await answer({ texels: 1 });
    expect(selection.measured).toBeNull();
    expect(likes()).toMatchObject([{ tolerance: 12 }, { tolerance: 9 }]);
    await answer({ texels: 2 });
    expect(selection.measured?.texels).toBe(2);
  });

  it("select nothing for users who cannot paint", () => {
    paints = false;
    click();
    expect(selection.isEmpty).toBe(true);
  });
});

describe("undo", () => {
  it("returns to the steps before a change, and redo to those after it", () => {
    draw();
    click([1, 1], { shift: true });
    selection.grow(3);
    const states = [selection.steps];
    selection.undo();
    states.unshift(selection.steps);
    expect(selection.steps).toHaveLength(2);
    selection.undo();
    expect([selection.steps.length, selection.canUndo]).toEqual([1, false]);
    selection.undo();
    selection.redo();
    selection.redo();
    expect([selection.steps, selection.canRedo]).toEqual([states[1], false]);
    expect(lit).toHaveLength(7);
  });

  it("restores a selection that another one has replaced", () => {
    draw();
    draw({ shift: true });
    click();
    expect(selection.steps).toHaveLength(1);
    selection.undo();
    expect(combines()).toEqual(["add", "add"]);
    click([1, 1], { shift: true });
    expect(selection.canRedo).toBe(false);
  });

  it("ends when the selection is discarded", () => {
    draw();
    draw({ shift: true });
    selection.clear();
    draw();
    expect([selection.canUndo, selection.canRedo]).toEqual([false, false]);
  });
});

describe("keys", () => {
  it("Enter fills, Escape discards, Backspace removes the last step", async () => {
    expect(["Enter", "Escape", "Backspace"].map((key) => selection.key(key))).toEqual([
      false,
      false,
      false,
    ]);
    draw();
    click([1, 1], { shift: true });
    selection.grow(5);
    expect(selection.key("a")).toBe(false);
    selection.key("Backspace");
    expect(selection.steps).toHaveLength(2);
    selection.key("Backspace");
    selection.key("Enter");
    await flush();
    expect(painted).toEqual([[{ camera: seen, path: square }, false]]);
    draw();
    selection.key("Escape");
    expect(selection.isEmpty).toBe(true);
  });

  it("a painted selection is discarded, and one that cannot be painted stays", async () => {
    click();
    const { within } = selection;
    paints = false;
    await selection.paint(true);
    expect(selection.isEmpty).toBe(false);
    paints = true;
    await selection.paint(false);
    expect(painted).toEqual([
      [within, true],
      [within, false],
    ]);
    expect(selection.isEmpty).toBe(true);
    await selection.paint(false);
    expect(painted).toHaveLength(2);
  });

  it("what is selected during painting stays", async () => {
    click();
    const painting = selection.paint(false);
    click([7, 8]);
    await painting;
    expect(painted).toHaveLength(1);
    expect(selection.within?.like?.at).toMatchObject({ x: 7, y: 8 });
    expect(selection.busy).toBe(false);
  });
});

describe("the corners of an outline", () => {
  const path = (): Point[] => selection.outlines[0]!.outline.within.path;

  it("are moved by a drag, which is measured once at its end", () => {
    draw();
    const asked = lit.length;
    expect(selection.grab({ x: 97, y: 4 })).toBe(true);
    selection.drag({ x: 120, y: -10 });
    selection.drag({ x: 130, y: -20 });
    expect(path()[1]).toEqual([130, -20]);
    expect(lit.length).toBe(asked);
    selection.release(true);
    expect(lit.length).toBe(asked + 1);
    selection.undo();
    expect(path()).toEqual(square);
  });

  it("are inserted by a drag of the middle between two", () => {
    draw();
    expect(middleAfter(square, 3)).toEqual([0, 50]);
    selection.grab({ x: 2, y: 50 });
    selection.drag({ x: -30, y: 50 });
    selection.release(true);
    expect(path()).toEqual([...square, [-30, 50]]);
  });

  it("return to their place if the drag is canceled", () => {
    draw();
    selection.grab({ x: 0, y: 0 });
    selection.drag({ x: 50, y: 50 });
    selection.release(false);
    expect(path()).toEqual(square);
  });

  it("are deleted by Delete after a press, down to a triangle", () => {
    draw();
    for (const [x, y] of [square[3]!, square[0]!]) {
      selection.grab({ x, y });
      selection.release(true);
      selection.key("Delete");
    }
    expect(path()).toEqual(square.slice(0, 3));
    expect(selection.canDelete).toBe(false);
  });

  it("are out of reach with a held key, in another view, or of a lasso", () => {
    draw();
    expect(selection.grab({ x: 0, y: 0, shift: true })).toBe(false);
    expect(selection.grab({ x: 30, y: 30 })).toBe(false);
    seen = camera(2);
    expect(selection.grab({ x: 0, y: 0 })).toBe(false);
    draw({}, false);
    expect(selection.grab({ x: 0, y: 0 })).toBe(false);
  });
});
