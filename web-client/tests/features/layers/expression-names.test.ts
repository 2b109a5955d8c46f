import { describe, expect, it } from "vitest";
import type { Column, Table } from "../../../src/core/protocol.gen";
import { completeLayer, type Layer } from "../../../src/core/types";
import {
  examplesFor,
  foundIn,
  nameGroups,
  namedClasses,
  withName,
  type NamesOf,
} from "../../../src/features/layers/expression-names";

const point = (at: number, label: string): { at: number; label: string; color: string } => ({
  at,
  label,
  color: "#ff0000ff",
});
const layer = (given: object): Layer =>
  completeLayer({
    id: 1,
    name: "",
    labels: {},
    slug: "",
    kind: "numeric",
    type: "u8",
    resolution: 2048,
    palette: { mode: "linear", min: 0, max: 100, points: [point(0, ""), point(100, "")] },
    ...given,
  } as never);
const moisture = layer({ id: 1, name: "Moisture", slug: "moisture", unit: "%" });
const cracks = layer({
  id: 2,
  name: "Cracks",
  slug: "cracks",
  palette: { mode: "categorical", points: [point(1, "Cracks")] },
});
const damage = layer({
  id: 3,
  name: "Damage",
  slug: "3d-damage",
  palette: { mode: "categorical", points: [point(1, "Flaking"), point(2, "Salt")] },
});
const pieces = layer({ id: 4, name: "Pieces", slug: "pieces", kind: "database", table: 9 });
const columns = [
  { id: 1, name: "Width", slug: "width", labels: {}, kind: "numeric", unit: "mm" },
  {
    id: 2,
    name: "State",
    slug: "state",
    labels: {},
    kind: "enumeration",
    choices: ["it's loose", "firm"],
  },
] as unknown as Column[];
const of = (layers: Layer[], computes = false): NamesOf => ({
  layers,
  table: (id) => (id === 9 ? ({ columns } as unknown as Table) : null),
  computes,
});
const all = of([moisture, cracks, damage, pieces]);
const textsOf = (names: NamesOf, title: string): string[] =>
  nameGroups(names)
    .find((group) => group.title === title)!
    .names.map(({ text }) => text);

describe("the names that an expression can contain", () => {
  it("are the layers with their classes and columns", () => {
    expect(textsOf(all, "Layers")).toEqual(["moisture", "cracks", '"3d-damage"', "pieces"]);
    expect(textsOf(all, "Classes of Damage")).toEqual(['"3d-damage" = 1', '"3d-damage" = 2']);
    expect(textsOf(all, "Columns of the records in Pieces")).toEqual([
      "pieces.width",
      "pieces.state",
    ]);
    const [layers] = nameGroups(all);
    expect(layers!.names[0]).toMatchObject({ label: "Moisture", hint: "0 to 100 %" });
    expect(namedClasses(all.layers).at(-1)).toEqual({
      layer: '"3d-damage"',
      value: 2,
      label: "Salt",
    });
  });
  it("are those of the surface that work there", () => {
    expect(textsOf(all, "Surface")).toEqual(["x", "y", "z", "area"]);
    expect(textsOf(of([], true), "Surface")).toContain("slope");
  });
  it("are functions along the surface only in computed layers", () => {
    const functions = "Functions and operators";
    expect(textsOf(of([], true), functions)).toEqual(
      expect.arrayContaining(["distance(", "within(", "nearest(", "focal_mean(", "interpolated("]),
    );
    expect(textsOf(of([]), functions)).not.toContain("distance(");
  });
  it("are found by their text, their name and their group", () => {
    const found = (search: string): string[] =>
      foundIn(nameGroups(all), search).flatMap(({ names }) => names.map(({ text }) => text));
    expect(found("width")).toEqual(["pieces.width"]);
    expect(found("salt")).toEqual(['"3d-damage" = 2']);
    expect(found("columns mm")).toEqual(["pieces.width"]);
    expect(found("nothing of this kind")).toEqual([]);
    expect(found("  ")).toHaveLength(nameGroups(all).flatMap(({ names }) => names).length);
  });
});

describe("a name in a text", () => {
  const put = (text: string, name: { text: string; value?: number }): string => {
    const at = text.indexOf("|");
    const done = withName(text.replace("|", ""), [at, at], { hint: "", ...name });
    return `${done.text.slice(0, done.caret)}|${done.text.slice(done.caret)}`;
  };
  it("is separated from its neighbors", () => {
    expect(put("|", { text: "moisture" })).toBe("moisture|");
    expect(put("1 <|", { text: "moisture" })).toBe("1 < moisture|");
    expect(put("valid(|)", { text: "cracks" })).toBe("valid(cracks|)");
    expect(put("|> 1", { text: "moisture" })).toBe("moisture| > 1");
    expect(put("not |", { text: "valid(" })).toBe("not valid(|");
    expect(put("moisture > 1 |x > 2", { text: "and " })).toBe("moisture > 1 and |x > 2");
  });
  it("replaces the selected text", () => {
    expect(withName("wte > 1", [0, 3], { text: "moisture", hint: "" })).toEqual({
      text: "moisture > 1",
      caret: 8,
    });
  });
  it("is only the number of a class after a comparison with its layer", () => {
    const salt = { text: '"3d-damage" = 2', value: 2 };
    expect(put("|", salt)).toBe('"3d-damage" = 2|');
    expect(put('"3d-damage" <> |', salt)).toBe('"3d-damage" <> 2|');
    expect(put('"3d-damage" in (1, |)', salt)).toBe('"3d-damage" in (1, 2|)');
    expect(put("moisture = |", salt)).toBe('moisture = "3d-damage" = 2|');
  });
});

describe("the examples", () => {
  const examples = (names: NamesOf): string[] =>
    examplesFor(names, { bounds: { min: [0, 0, 0], max: [10, 10, 80] }, unit: "mm" }).map(
      ({ text }) => text,
    );
  it("name the model's own layers", () => {
    expect(examples(all)).toEqual([
      "moisture > 50",
      "moisture > 50 and not valid(cracks)",
      '"3d-damage" = 2',
      "pieces.state = 'it''s loose'",
    ]);
    expect(examples(of([cracks]))).toEqual(["valid(cracks)", "z > 40"]);
    expect(examples(of([moisture], true))).toEqual(["moisture * 2", "moisture > 50", "slope"]);
    expect(examples(of([cracks], true))).toEqual(["within(cracks, 2)", "valid(cracks)", "slope"]);
  });
  it("need no layer", () => {
    expect(examples(of([]))).toEqual(["z > 40"]);
  });
});
