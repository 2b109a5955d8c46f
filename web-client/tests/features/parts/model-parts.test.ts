import { describe, expect, it } from "vitest";
import type { ModelPart } from "../../../src/core/protocol.gen";
import { boundsOf, partsIn, partTree } from "../../../src/features/parts/model-parts";

const part = (name: string, folder = "", x = 0): ModelPart => ({
  name,
  folder,
  triangles: 2,
  area_m2: 1,
  bounds: { min: [x, 0, 0], max: [x + 1, 2, 3] },
});

describe("the tree of the parts of a model", () => {
  const tree = partTree([
    part("North 10", "Tower/Outside"),
    part("North 2", "Tower/Outside"),
    part("Stairs", "Tower"),
    part("Nave"),
  ]);

  it("has the folders of the parts", () => {
    expect(tree.parts.map(({ name, number }) => [name, number])).toEqual([["Nave", 3]]);
    const tower = tree.folders[0]!;
    expect([tower.name, tower.path, tower.parts[0]!.number]).toEqual(["Tower", "Tower", 2]);
    expect(tower.folders[0]).toMatchObject({ name: "Outside", path: "Tower/Outside" });
  });
  it("orders numbers in names by their value", () => {
    const outside = tree.folders[0]!.folders[0]!;
    expect(outside.parts.map(({ name }) => name)).toEqual(["North 2", "North 10"]);
  });
  it("lists all parts in a folder", () => {
    expect(partsIn(tree.folders[0]!).map(({ number }) => number)).toEqual([2, 1, 0]);
  });
});

describe("the box of parts", () => {
  it("contains all parts", () => {
    expect(boundsOf([part("a", "", -4), part("b", "", 5)])).toEqual({
      min: [-4, 0, 0],
      max: [6, 2, 3],
    });
    expect(boundsOf([])).toBeNull();
  });
});
