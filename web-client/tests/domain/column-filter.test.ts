// The choices in a column's filter, and their text form.
import { describe, expect, it } from "vitest";
import {
  chosenIn,
  conditionOf,
  conditionsOf,
  filterKinds,
  filterOf,
  withChoice,
  type ColumnFilter,
} from "../../src/domain/column-filter";
import type { ColumnKind } from "../../src/core/protocol.gen";
import { countValues } from "../../src/domain/value-counts";

const column = (slug: string, kind: ColumnKind) => ({ slug, kind });
const soil = column("soil", "enumeration");
const depth = column("depth", "numeric");
const note = column("note", "text");
const above = column("above", "relation");
const kind = column("kind", "term");
const dug = column("dug", "date");
const number = column("2-no", "integer"); // the name begins with a digit

const chosen: [ReturnType<typeof column>, ColumnFilter, string][] = [
  [soil, { is: "one_of", values: ["clay"], empty: false }, "soil = 'clay'"],
  [soil, { is: "one_of", values: ["clay", "it's"], empty: false }, "soil in ('clay', 'it''s')"],
  [soil, { is: "one_of", values: ["clay"], empty: true }, "(soil = 'clay' or soil is null)"],
  [column("sealed", "boolean"), { is: "one_of", values: [true], empty: false }, "sealed = true"],
  [kind, { is: "one_of", values: [3, 5], empty: false }, "kind in (3, 5)"],
  [above, { is: "one_of", values: [3, 5], empty: false }, "a_overlaps(above, (3, 5))"],
  [above, { is: "one_of", values: [3], empty: true }, "(a_overlaps(above, (3)) or above is null)"],
  [depth, { is: "range", from: "-1.5", to: "20" }, "depth between -1.5 and 20"],
  [depth, { is: "range", from: "1e-7", to: "" }, "depth >= 1e-7"],
  [depth, { is: "range", from: "", to: "3" }, "depth <= 3"],
  [
    dug,
    { is: "range", from: "1999-01-01", to: "2001-12-31" },
    "dug between '1999-01-01' and '2001-12-31'",
  ],
  [
    note,
    { is: "contains", text: "50 % of a_b's \\" },
    "casei(note) like casei('%50 \\% of a\\_b''s \\\\%')",
  ],
  [note, { is: "empty" }, "note is null"],
  [note, { is: "filled" }, "note is not null"],
  [number, { is: "one_of", values: [7], empty: false }, '"2-no" = 7'],
];

describe("the filter of a column", () => {
  it.each(chosen)("of %o says %o as “%s”, and is found again in it", (of, filter, text) => {
    expect(conditionOf(of, filter)).toBe(text);
    expect(filterOf(of, text)).toEqual(filter);
    expect(chosenIn(`other is not null and ${text} and x between 1 and 2`, of)).toEqual(filter);
  });

  it("asks nothing where nothing is chosen", () => {
    expect(conditionOf(soil, { is: "one_of", values: [], empty: false })).toBe("");
    expect(conditionOf(soil, { is: "one_of", values: [], empty: true })).toBe("soil is null");
    expect(conditionOf(depth, { is: "range", from: "", to: "" })).toBe("");
    expect(conditionOf(note, { is: "contains", text: "" })).toBe("");
    expect(withChoice("", soil, null)).toBe("");
  });

  it("does not take for its own what it did not write", () => {
    for (const typed of [
      "soil = 'clay' or depth > 1",
      "depth > 2",
      "depth < 2 + 3",
      "casei(note) = 'x'",
      "notes is null",
      "not soil = 'clay'",
    ])
      expect([soil, depth, note].map((of) => chosenIn(typed, of))).toEqual([null, null, null]);
  });

  it("parts a text at its outer “and” alone", () => {
    expect(
      conditionsOf("a = 'x and y' and (b = 1 and c = 2) and d between 1 and 2 AND e is null"),
    ).toEqual(["a = 'x and y'", "(b = 1 and c = 2)", "d between 1 and 2", "e is null"]);
    expect(conditionsOf('"and" = 1 and land = 2')).toEqual(['"and" = 1', "land = 2"]);
    expect(conditionsOf("a = 1 or b = 2")).toEqual(["(a = 1 or b = 2)"]);
    expect(conditionsOf("  ")).toEqual([]);
  });

  it("replaces its own condition and leaves the others", () => {
    const byDepth = withChoice("soil = 'clay' and note like 'x%'", depth, {
      is: "range",
      from: "1",
      to: "",
    });
    expect(byDepth).toBe("soil = 'clay' and note like 'x%' and depth >= 1");
    expect(withChoice(byDepth, soil, { is: "one_of", values: ["sand"], empty: false })).toBe(
      "note like 'x%' and depth >= 1 and soil = 'sand'",
    );
    expect(withChoice(byDepth, soil, null)).toBe("note like 'x%' and depth >= 1");
    expect(withChoice("a = 1 or b = 2", soil, { is: "empty" })).toBe(
      "(a = 1 or b = 2) and soil is null",
    );
    expect(withChoice("(a = 1 or b = 2) and soil is null", soil, null)).toBe("a = 1 or b = 2");
  });

  it("asks of each kind of column what it can hold", () => {
    expect(filterKinds(depth)).toEqual(["range", "one_of", "filled", "empty"]);
    expect(filterKinds(note)).toEqual(["one_of", "contains", "filled", "empty"]);
    expect(filterKinds(column("photos", "picture"))).toEqual(["filled", "empty"]);
  });
});

describe("the values of a column", () => {
  const record = (key: number, value: unknown) =>
    ({ key, version: 1, values: { a: value } }) as never;
  it("are counted over all pages, each record that a cell names by itself", async () => {
    const all = [record(1, [3, 5]), record(2, [5]), record(3, null), record(4, undefined)];
    const asked: number[] = [];
    const counts = await countValues(({ offset }) => {
      asked.push(offset);
      return Promise.resolve({
        records: all.slice(offset, offset + 3),
        total: all.length,
      } as never);
    }, "a");
    expect(asked).toEqual([0, 3]);
    expect([...counts.ofValue]).toEqual([
      [3, 1],
      [5, 2],
    ]);
    expect(counts).toMatchObject({ empty: 2, least: 3, greatest: 5, counted: 4, total: 4 });
  });
});
