import { beforeEach, describe, expect, it } from "vitest";

import { describeValue } from "../../../src/session/layer-values";
import {
  foldedAtFirst,
  pathTo,
  rowsOf,
  termsWith,
  treeStep,
  type TermRow,
} from "../../../src/session/fields/term-rows";
import { kTermsEndings, termsType } from "../../../src/features/tables/terms-files";
import { kMostTerms, TermTree } from "../../../src/session/fields/term-tree";
import { Api } from "../../../src/net/api";
import { labelOfRecord } from "../../../src/domain/cells";
import { recordPalette } from "../../../src/domain/palette";
import type { Column, ListedTerm } from "../../../src/core/protocol.gen";
import type { Layer } from "../../../src/core/types";

const term = (key: number, depth = 0): ListedTerm => ({
  key,
  depth,
  code: `t${key}`,
  name: `Term ${key}`,
  label: "",
  labels: {},
  below: 0,
  match: true,
  definition: "",
  uri: "",
  color: "#000000",
  pattern: "",
});

// 1 ─ 2 ─ 3
//   └ 4
// 5
// 6 ─ 7
const tree = [term(1), term(2, 1), term(3, 2), term(4, 1), term(5), term(6), term(7, 1)];
const keys = (rows: readonly TermRow[]): number[] => rows.map((row) => row.term.key);

describe("the rows of a tree of terms", () => {
  it("leave out what is folded, with all that is below it", () => {
    expect(keys(rowsOf(tree, new Set()))).toEqual([1, 2, 3, 4, 5, 6, 7]);
    expect(keys(rowsOf(tree, new Set([1])))).toEqual([1, 5, 6, 7]);
    expect(keys(rowsOf(tree, new Set([2, 6])))).toEqual([1, 2, 4, 5, 6]);
    expect(keys(rowsOf(tree, new Set([1, 2])))).toEqual([1, 5, 6, 7]);
    expect(rowsOf([], new Set())).toEqual([]);
  });

  it("know which can be folded: one without terms below cannot", () => {
    const rows = rowsOf(tree, new Set([2, 5]));
    expect(rows.filter(({ parent }) => parent).map((row) => row.term.key)).toEqual([1, 2, 6]);
    expect(rows.filter(({ folded }) => folded).map((row) => row.term.key)).toEqual([2]);
  });

  it("know their places among those of the same parent", () => {
    expect(rowsOf(tree, new Set()).map(({ place, of }) => [place, of])).toEqual([
      [1, 3],
      [1, 2],
      [1, 1],
      [2, 2],
      [2, 3],
      [3, 3],
      [1, 1],
    ]);
    expect(rowsOf(tree, new Set([1])).map(({ place, of }) => [place, of])).toEqual([
      [1, 3],
      [2, 3],
      [3, 3],
      [1, 1],
    ]);
  });

  it("are all shown of a short list; a long one is folded, but for what leads to the chosen term", () => {
    expect(foldedAtFirst(tree, 3)).toEqual(new Set());
    const long = [...tree, ...Array.from({ length: 100 }, (_, at) => term(100 + at))];
    expect(foldedAtFirst(long, 3)).toEqual(new Set([6]));
    expect(foldedAtFirst(long, 0)).toEqual(new Set([1, 2, 6]));
  });

  it("lead to a term from the top", () => {
    expect(pathTo(tree, 3).map(({ key }) => key)).toEqual([1, 2]);
    expect(pathTo(tree, 4).map(({ key }) => key)).toEqual([1]);
    expect(pathTo(tree, 5)).toEqual([]);
    expect(pathTo(tree, 99)).toEqual([]);
  });
});

describe("the keys in a tree of terms", () => {
  const folded = new Set([6]);
  const rows = rowsOf(tree, folded); // the rows are 1 2 3 4 5 6
  const step = (key: string, from: number): unknown =>
    treeStep(key, rows, keys(rows).indexOf(from), 3);

  it("go up and down, as far as there are rows", () => {
    expect(step("ArrowDown", 1)).toEqual({ at: 1 });
    expect(step("ArrowDown", 6)).toEqual({ at: 5 });
    expect(step("ArrowUp", 1)).toEqual({ at: 0 });
    expect(step("PageDown", 2)).toEqual({ at: 4 });
    expect(step("PageDown", 5)).toEqual({ at: 5 });
    expect(step("PageUp", 2)).toEqual({ at: 0 });
  });
  it("begin at the first or the last row where none was at", () => {
    expect(treeStep("ArrowDown", rows, -1, 3)).toEqual({ at: 0 });
    expect(treeStep("ArrowUp", rows, -1, 3)).toEqual({ at: 5 });
    expect(treeStep("ArrowDown", [], -1, 3)).toBeNull();
  });
  it("unfold to the right, then go in; fold to the left, then go out", () => {
    expect(step("ArrowRight", 6)).toEqual({ fold: false });
    expect(step("ArrowRight", 1)).toEqual({ at: 1 });
    expect(step("ArrowRight", 3)).toBeNull();
    expect(step("ArrowLeft", 2)).toEqual({ fold: true });
    expect(step("ArrowLeft", 3)).toEqual({ at: 1 });
    expect(step("ArrowLeft", 4)).toEqual({ at: 0 });
    expect(step("ArrowLeft", 6)).toBeNull();
  });
  it("that are no keys of a tree are left to others", () => {
    for (const key of ["a", "Home", "Tab", "Enter"]) expect(step(key, 1)).toBeNull();
  });
});

describe("the terms of a list", () => {
  let asked: string[];
  let count: number;
  let release: (() => void)[];
  let terms: TermTree;
  const settle = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));
  const answerAll = async (): Promise<void> => {
    for (;;) {
      await settle();
      const waiting = release.splice(0);
      if (waiting.length === 0) return;
      for (const go of waiting) go();
    }
  };

  beforeEach(() => {
    asked = [];
    release = [];
    count = 3;
    const api = new Api(async (path) => {
      const query = new URL(path, "http://x").searchParams;
      asked.push(`${query.get("q") ?? ""}${query.get("lang")}${query.get("offset")}`);
      const [limit, offset] = [Number(query.get("limit")), Number(query.get("offset"))];
      const now = count;
      await new Promise<void>((resolve) => release.push(resolve));
      if (now < 0)
        return new Response(
          JSON.stringify({
            status: 409,
            title: "No list of terms",
            detail: "It is a table of records.",
          }),
          { status: 409 },
        );
      return new Response(
        JSON.stringify({
          terms: Array.from({ length: Math.min(limit, now - offset) }, (_, at) =>
            term(offset + at),
          ),
          total: now,
        }),
      );
    });
    terms = new TermTree(api, 3, () => {}, "es-MX");
  });

  it("are asked for once somebody needs them, in the person's language, a page after the other", async () => {
    terms.refresh();
    expect(asked).toEqual([]);
    count = 1500;
    terms.want();
    terms.want();
    await answerAll();
    expect(asked).toEqual(["es-MX0", "es-MX1000"]);
    expect([terms.terms.length, terms.total, terms.loaded]).toEqual([1500, 1500, true]);
  });

  it("are the first ones of a very large list, and it tells how many there are", async () => {
    count = kMostTerms * 5;
    terms.want();
    await answerAll();
    expect([terms.terms.length, terms.total]).toEqual([kMostTerms, kMostTerms * 5]);
  });

  it("are asked for again when the list changes, once for all that changed meanwhile", async () => {
    terms.want();
    await answerAll();
    count = 4;
    for (let n = 0; n < 5; ++n) terms.refresh();
    await answerAll();
    expect(terms.terms).toHaveLength(4);
    expect(asked).toHaveLength(3);
    expect(terms.generation).toBe(2);
  });

  it("stay with what is wrong when they cannot be read, until they can", async () => {
    terms.want();
    await answerAll();
    count = -1;
    terms.refresh();
    await answerAll();
    expect(terms.problem).toBe("It is a table of records.");
    expect(terms.terms).toHaveLength(3);
    count = 2;
    terms.refresh();
    await answerAll();
    expect([terms.problem, terms.terms.length]).toEqual(["", 2]);
  });

  it("are looked for by the server, in all of its languages", async () => {
    const found = terms.search("salt");
    await answerAll();
    expect((await found).total).toBe(3);
    expect(asked).toEqual(["saltes-MX0"]);
  });
});

describe("a tree that is looked through", () => {
  const term = (key: number, depth: number, name: string): ListedTerm =>
    ({ key, depth, name }) as ListedTerm;
  const all = [
    term(1, 0, "Verlust"),
    term(2, 1, "Abrieb"),
    term(3, 2, "Ölfleck"),
    term(4, 1, "Riss"),
    term(5, 0, "Auflage"),
    term(6, 1, "Salz"),
  ];
  const found = (words: string): unknown[] =>
    termsWith(all, words).map(({ key, match }) => [key, match]);

  it("has what holds all words, whatever the accents, with what is above it", () => {
    expect(found("olf")).toEqual([
      [1, false],
      [2, false],
      [3, true],
    ]);
    expect(found("A")).toEqual([
      [1, false],
      [2, true],
      [5, true],
      [6, true],
    ]);
    expect(found("ris s")).toEqual([
      [1, false],
      [4, true],
    ]);
    expect(found("")).toHaveLength(6);
    expect(found("nothing")).toEqual([]);
  });
});

describe("terms", () => {
  const text = (id: number, slug: string, more: Partial<Column> = {}): Column => ({
    id,
    name: slug,
    slug,
    labels: {},
    kind: "text",
    required: false,
    unique: false,
    comment: "",
    order: id,
    visibility: "public",
    ...more,
  });
  const columns = [
    text(1, "code", { required: true, unique: true }),
    text(2, "label"),
    text(3, "label-es"),
    text(4, "label-pt-br"),
  ];
  const name = (values: Record<string, string>, languages: string[]): string =>
    labelOfRecord({ kind: "terms", columns }, { values }, languages);

  it("are called by their label in the person's language, in none, or by their code", () => {
    const salt = { code: "salt", label: "Salts", "label-es": "Sales" };
    expect(name(salt, ["es-MX", "en"])).toBe("Sales");
    expect(name(salt, ["pt-BR"])).toBe("Salts");
    expect(name({ code: "salt" }, ["es"])).toBe("salt");
    expect(labelOfRecord({ kind: "records", columns }, { values: salt }, ["es"])).toBe("salt");
  });

  it("are told by that name, whatever the layer's legend calls them", () => {
    const palette = {
      ...recordPalette(),
      points: [{ at: 1, color: "#000000ff", label: "Salts" }],
    };
    const layer = {
      id: 7,
      kind: "database",
      type: "u16",
      unit: "",
      palette,
      table: 3,
    } as unknown as Layer;
    expect(describeValue(layer, 1, { label: () => "Sales", term: () => "Sales" })).toBe("Sales");
    expect(describeValue(layer, 1, { label: () => "salt", term: () => null })).toBe("Salts");
  });
});

describe("files of terms", () => {
  it("are known by their names", () => {
    for (const name of ["stone.csv", "Stone.TSV", "a.b.txt"])
      expect(termsType(name)).toBe("text/csv");
    for (const name of ["aat.ttl", "aat.nt"]) expect(termsType(name)).toBe("text/turtle");
    for (const name of ["aat.rdf", "aat.xml"]) expect(termsType(name)).toBe("application/rdf+xml");
    for (const name of ["aat.json", "csv", "terms.pdf", ""]) expect(termsType(name)).toBeNull();
    for (const ending of kTermsEndings.split(",")) expect(termsType(`x${ending}`)).not.toBeNull();
  });
});
