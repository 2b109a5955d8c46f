import { describe, expect, it } from "vitest";
import { misfit, plainText, searched, wordsOf } from "../../src/core/search";

const found = (text: string, ...titles: string[]): string[] =>
  searched(text, titles, (title) => ({ title }));

describe("A search by words", () => {
  it("finds words in any order, without accents and case", () => {
    expect(found("anzeigen risse", "Risse anzeigen", "Risse ausblenden")).toEqual([
      "Risse anzeigen",
    ]);
    expect(found("MASSNAHMEN a", "Maßnahmen")).toEqual([]);
    expect(found("seccion", "Sección", "Selección")).toEqual(["Sección"]);
    expect(found("ÜBERSICHT", "U\u0308bersicht")).toEqual(["U\u0308bersicht"]);
  });

  it("puts beginnings before words, and words before parts of words", () => {
    expect(found("la", "Atlas", "New layer", "Layers", "Palette")).toEqual([
      "Layers",
      "New layer",
      "Atlas",
    ]);
    expect(found("e", "The edge", "Edge")).toEqual(["Edge", "The edge"]);
  });

  it("also reads the further text, but prefers titles", () => {
    const rows = [{ title: "Raking", also: "Light" }, { title: "Next light" }];
    expect(searched("light", rows, (row) => row).map(({ title }) => title)).toEqual([
      "Next light",
      "Raking",
    ]);
    expect(misfit(wordsOf("raking light"), "Raking", "Light")).toBe(3);
    expect(misfit(wordsOf("raking night"), "Raking", "Light")).toBeNull();
  });

  it("keeps the order of equal ones, and everything without words", () => {
    expect(found("b", "b2", "b1", "b3")).toEqual(["b2", "b1", "b3"]);
    expect(found("  ", "b", "a")).toEqual(["b", "a"]);
  });

  it("takes signs as they are", () => {
    for (const sign of [".", "*", "(", "[", "\\", "+", "?", "|", "^", "$", "-", "/"]) {
      expect(found(sign, "plain")).toEqual([]);
      expect(found(sign, `a ${sign} b`)).toHaveLength(1);
    }
    expect(plainText("Señal")).toBe("senal");
  });
});
