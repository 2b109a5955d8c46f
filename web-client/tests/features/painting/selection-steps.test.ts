import fc from "fast-check";
import { describe, expect, it } from "vitest";
import type { Camera, Combination, Within } from "../../../src/core/protocol.gen";
import {
  fitsRequest,
  kMostParts,
  type SelectionStep,
  stepsOf,
  withinOf,
} from "../../../src/features/painting/selection-steps";

const cameraOf = (turn: number): Camera => ({ view: [turn] }) as unknown as Camera;
const outline = (turn: number, combine: Combination = "add"): SelectionStep => ({
  combine,
  within: {
    camera: cameraOf(turn),
    path: [
      [0, 0],
      [turn, 0],
      [0, turn],
    ],
  },
  corners: true,
});
const where = (text: string, combine: Combination = "add"): SelectionStep => ({
  combine,
  within: { where: text },
});

// The oracle: a surface of 40 texels in a line, 1 mm wide each. A part is the set of texels where
// the bit of its text is set. The border of the line is no border of a part.
const kTexels = 40;
type Area = readonly boolean[];

const leaf = (text: string): Area =>
  Array.from({ length: kTexels }, (_, at) => (Number(text) >> (at % 16)) % 2 === 1);
const near = (area: Area, mm: number): Area =>
  area.map((_, at) => area.slice(Math.max(0, at - mm), at + mm + 1).some(Boolean));
const not = (area: Area): Area => area.map((inside) => !inside);
const changed = (area: Area, { grow_mm: grow = 0, smooth_mm: smooth = 0 }: Within): Area => {
  const grown = grow < 0 ? not(near(not(area), -grow)) : near(area, grow);
  const opened = near(not(near(not(grown), smooth)), smooth);
  return not(near(not(near(opened, smooth)), smooth));
};
const combined = (area: Area, combine: Combination, next: Area): Area =>
  area.map((inside, at) => {
    if (combine === "add") return inside || next[at]!;
    return inside && (combine === "intersect") === next[at];
  });

/** The area of a request, as the contract defines it. */
function areaOf(within: Within): Area {
  const [first, ...rest] = within.parts ?? [];
  const area = first
    ? rest.reduce(
        (soFar, part) => combined(soFar, part.combine ?? "add", areaOf(part.within)),
        areaOf(first.within),
      )
    : (within.steps ?? []).reduce(
        (soFar, step) => combined(soFar, step.combine, leaf(String(step.path[1]![0]))),
        leaf(within.where ?? String(within.path![1]![0])),
      );
  return changed(area, within);
}

/** The area after one step after another, as the user makes them. */
function areaAfter(steps: readonly SelectionStep[]): Area {
  return steps.reduce<Area>((area, step, index) => {
    if (!("within" in step)) return changed(area, step);
    return index === 0 ? areaOf(step.within) : combined(area, step.combine, areaOf(step.within));
  }, leaf("0"));
}

const combines = fc.constantFrom<Combination>("add", "subtract", "intersect");
const numbers = fc.integer({ min: 1, max: 65_535 });
const part = fc.oneof(
  fc.tuple(numbers, combines).map(([bits, combine]) => where(String(bits), combine)),
  fc.tuple(numbers, combines).map(([bits, combine]) => outline(bits, combine)),
);
const step = fc.oneof(
  { weight: 3, arbitrary: part },
  {
    weight: 1,
    arbitrary: fc.constantFrom<SelectionStep>({ grow_mm: 1 }, { grow_mm: -1 }, { smooth_mm: 1 }),
  },
);
const selections = fc
  .tuple(part, fc.array(step, { maxLength: 12 }))
  .map(([first, rest]) => [first, ...rest]);

describe("a request of a selection", () => {
  it("means the same area as its steps in their order", () => {
    fc.assert(
      fc.property(selections, (steps) => {
        expect(areaOf(withinOf(steps)!)).toEqual(areaAfter(steps));
      }),
    );
  });

  it("becomes the same request again after it was saved and loaded", () => {
    fc.assert(
      fc.property(selections, (steps) => {
        const within = withinOf(steps)!;
        expect(withinOf(stepsOf(within))).toEqual(within);
      }),
    );
  });

  it("is nothing without a part", () => {
    expect([withinOf([]), withinOf([{ grow_mm: 5 }])]).toEqual([null, null]);
  });

  it("is the part itself if there is only one, with the changes of its border", () => {
    expect(withinOf([where("wet > 1")])).toEqual({ where: "wet > 1" });
    expect(withinOf([where("wet > 1"), { grow_mm: 5 }, { smooth_mm: 2 }])).toEqual({
      where: "wet > 1",
      grow_mm: 5,
      smooth_mm: 2,
    });
  });

  it("has only outlines as steps of the first outline", () => {
    expect(withinOf([outline(1), outline(2, "subtract"), { smooth_mm: 3 }])).toEqual({
      camera: cameraOf(1),
      path: [
        [0, 0],
        [1, 0],
        [0, 1],
      ],
      steps: [
        {
          combine: "subtract",
          camera: cameraOf(2),
          path: [
            [0, 0],
            [2, 0],
            [0, 2],
          ],
        },
      ],
      smooth_mm: 3,
    });
  });

  it("nests the area whose border was changed before another part", () => {
    expect(withinOf([where("a"), { grow_mm: 5 }, where("b", "subtract")])).toEqual({
      parts: [
        { combine: "add", within: { where: "a", grow_mm: 5 } },
        { combine: "subtract", within: { where: "b" } },
      ],
    });
  });

  it("adds up growth, but keeps growing before shrinking, which closes gaps", () => {
    expect(withinOf([where("a"), { grow_mm: 5 }, { grow_mm: 2 }])).toEqual({
      where: "a",
      grow_mm: 7,
    });
    expect(withinOf([where("a"), { grow_mm: 5 }, { grow_mm: -5 }])).toEqual({
      parts: [{ combine: "add", within: { where: "a", grow_mm: 5 } }],
      grow_mm: -5,
    });
    expect(withinOf([where("a"), { grow_mm: 900 }, { grow_mm: 900 }])!.grow_mm).toBe(900);
  });

  it("fits while it has at most 32 parts and 4 levels", () => {
    const many = Array.from({ length: kMostParts }, () => where("a"));
    expect([fitsRequest(many), fitsRequest([...many, where("a")])]).toEqual([true, false]);
    const turns = (n: number): SelectionStep[] => [
      where("a"),
      ...Array.from({ length: n }, (_, i) => ({ grow_mm: i % 2 === 0 ? 5 : -5 })),
    ];
    expect([fitsRequest(turns(5)), fitsRequest(turns(6))]).toEqual([true, false]);
  });
});

describe("a loaded selection", () => {
  it("has outlines with corners again, except long ones", () => {
    const lasso = Array.from({ length: 200 }, (_, i): [number, number] => [i, i * i]);
    const [polygon, drawn] = stepsOf({
      ...(outline(1) as { within: Within }).within,
      steps: [{ combine: "add", camera: cameraOf(1), path: lasso }],
    });
    expect([polygon, drawn]).toMatchObject([{ corners: true }, { combine: "add" }]);
    expect(drawn).not.toHaveProperty("corners");
  });

  it("keeps nested combinations as one part", () => {
    const nested: Within = {
      parts: [{ within: { where: "b" } }, { combine: "subtract", within: { selection: 3 } }],
    };
    expect(
      stepsOf({ parts: [{ within: { where: "a" } }, { combine: "intersect", within: nested }] }),
    ).toEqual([
      { combine: "add", within: { where: "a" } },
      { combine: "intersect", within: nested },
    ]);
  });
});
