import { describe, expect, it } from "vitest";
import {
  groupCalled,
  groupNames,
  groupsOf,
  placeAfterStep,
  withMoved,
} from "../../src/domain/layer-groups";

interface L {
  id: number;
  group?: string;
}
/** "a1" is layer 1 in group a. "2" is layer 2 without a group. */
const layers = (text: string): L[] =>
  text.split(" ").map((each) => {
    const group = each.replace(/\d/g, "");
    return { id: Number(each.replace(/\D/g, "")), ...(group ? { group } : {}) };
  });
const told = (text: string): string =>
  groupsOf(layers(text))
    .map(({ name, layers: inside }) => `${name ?? ""}(${inside.map(({ id }) => id).join(" ")})`)
    .join(" ");

describe("Groups of layers", () => {
  it("are where their topmost layer is", () => {
    expect(told("1 2")).toBe("(1 2)");
    expect(told("a1 a2 3 b4 5")).toBe("a(1 2) (3) b(4) (5)");
    expect(told("a1 2 a3 4")).toBe("a(1 3) (2 4)");
    expect(groupsOf([])).toEqual([]);
  });

  it("have names in alphabetical order, and are found in other letters", () => {
    const some = layers("b1 Ä2 b3 4 a5");
    expect(groupNames(some)).toEqual(["a", "Ä", "b"]);
    expect(groupCalled(" B ", some)).toBe("b");
    expect(groupCalled("A", layers("Ä1"))).toBe("Ä");
    expect(groupCalled("  New one ", some)).toBe("New one");
    expect(groupCalled("  ", some)).toBe("");
  });
});

describe("A step in the list", () => {
  const after = (text: string, id: number, step: 1 | -1): string | null => {
    const groups = groupsOf(layers(text));
    const flat = groups.flatMap((group) => group.layers);
    const layer = flat.find((each) => each.id === id)!;
    const place = placeAfterStep(groups, layer, step);
    if (place === null) return null;
    const rest = flat.filter((each) => each !== layer);
    rest.splice(place, 0, layer);
    return rest.map((each) => each.id).join(" ");
  };

  it("stays in the group", () => {
    expect(after("a1 a2 3", 1, 1)).toBe("2 1 3");
    expect(after("a1 a2 3", 2, -1)).toBe("2 1 3");
    expect(after("a1 a2 3", 2, 1)).toBeNull();
    expect(after("3 a1 a2", 1, -1)).toBeNull();
  });

  it("passes over whole groups", () => {
    expect(after("1 a2 a3 4", 1, 1)).toBe("2 3 1 4");
    expect(after("1 a2 a3 4", 4, -1)).toBe("1 4 2 3");
    expect(after("1 2", 1, -1)).toBeNull();
    expect(after("1 2", 2, 1)).toBeNull();
  });
});

describe("A moved layer", () => {
  const moved = (text: string, id: number, index: number, group?: string): string => {
    const top = layers(text);
    const layer = top.find((each) => each.id === id)!;
    return withMoved(top, group === undefined ? layer : { ...layer, group }, index)
      .map((each) => `${each.group ?? ""}${each.id}`)
      .join(" ");
  };

  it("is the only one that changes its place among all", () => {
    // the list shows a(1 3) 2 4
    expect(moved("a1 2 a3 4", 4, 2)).toBe("a1 4 2 a3");
    expect(moved("a1 2 a3 4", 4, 0)).toBe("4 a1 2 a3");
    expect(moved("a1 2 a3 4", 2, 3)).toBe("a1 a3 4 2");
    expect(moved("a1 2 a3 4", 1, 1)).toBe("2 a3 a1 4");
  });

  it("is listed next to the layer of its group that it was put next to", () => {
    let checked = 0;
    for (const text of ["1 2 3 4", "a1 2 a3 4", "a1 b2 a3 b4 5", "1 a2 3 a4"]) {
      const listed = groupsOf(layers(text)).flatMap((each) => each.layers);
      for (const layer of listed)
        for (const index of listed.keys()) {
          const others = listed.filter((each) => each !== layer);
          const [above, below] = [others[index - 1], others[index]];
          const now = groupsOf(withMoved(layers(text), layer, index))
            .flatMap((each) => each.layers)
            .map(({ id }) => id);
          const at = now.indexOf(layer.id);
          const says = `${text}: ${layer.id} to ${index}: ${now.join(" ")}`;
          if (above && above.group === layer.group) expect(now[at - 1], says).toBe(above.id);
          else if (below && below.group === layer.group) expect(now[at + 1], says).toBe(below.id);
          else continue;
          checked += 1;
        }
    }
    expect(checked).toBe(40);
  });

  it("joins the layers of its new group", () => {
    expect(moved("a1 2 a3 4", 4, 2, "a")).toBe("a1 2 a3 a4");
    expect(moved("1 a2", 1, 1, "a")).toBe("a2 a1");
  });
});
