import { describe, expect, it } from "vitest";
import {
  classNumbers,
  complete,
  corrected,
  markedAt,
  nameInText,
} from "../../src/domain/completion";

const all = [
  "moisture",
  "pieces",
  "pieces.thickness",
  'pieces."2nd"',
  "min(",
  '"3d"',
  "is not null",
].map((text) => ({ text, hint: "" }));
const texts = (text: string, caret = text.length): string[] =>
  complete(text, caret, all).suggestions.map((each) => each.text);

describe("completion of an expression", () => {
  it("offers what begins with the word, then what has a part that does", () => {
    expect(texts("m")).toEqual(["moisture", "min("]);
    expect(texts("moisture > 1 and pie")).toEqual(["pieces", "pieces.thickness", 'pieces."2nd"']);
    expect(texts("thick")).toEqual(["pieces.thickness"]);
    expect(texts("PIECES.t")).toEqual(["pieces.thickness"]);
    expect(texts("pieces")).toEqual(["pieces.thickness", 'pieces."2nd"']);
    expect(texts('"3')).toEqual(['"3d"']);
  });
  it("replaces the word at the caret, wherever it stands", () => {
    expect(complete("moi > 1", 3, all)).toMatchObject({
      from: 0,
      suggestions: [{ text: "moisture" }],
    });
    expect(complete("1 + moi", 7, all).from).toBe(4);
  });
  it("offers nothing after a number or a sign, nor within a text", () => {
    for (const text of ["", "1", "moisture > ", "(", "pieces.state = 'm", "x 'a' = 'b"])
      expect(texts(text)).toEqual([]);
    expect(texts("pieces.state = 'a' and m")).toEqual(["moisture", "min("]);
  });
  it("puts names in quotes that are words of the language or begin with a digit", () => {
    expect(["moisture", "3d", "and", "min"].map(nameInText)).toEqual([
      "moisture",
      '"3d"',
      '"and"',
      "min",
    ]);
  });
  it("marks the character that is wrong by code point", () => {
    expect(markedAt("ä𝄞b", 1)).toEqual(["ä", "𝄞", "b"]);
    expect(markedAt("ab", 2)).toEqual(["ab", " ", ""]);
  });
  it("marks all wrong characters if their number is known", () => {
    expect(markedAt("ä wte > 1", 2, 3)).toEqual(["ä ", "wte", " > 1"]);
    expect(markedAt("wte", 0, 0)).toEqual(["", "w", "te"]);
  });
  it("replaces the wrong characters by a suggestion", () => {
    expect(corrected("𝄞 wte > 1", { offset: 2, length: 3 }, "wet")).toBe("𝄞 wet > 1");
    expect(corrected("wet > 3 mm", { offset: 6, length: 4 }, "3")).toBe("wet > 3");
    expect(corrected("wet", { offset: 3 }, " > 1")).toBe("wet > 1");
  });
  it("finds the number of a class that is named after its layer", () => {
    const classes = [
      { layer: "damage", value: 1, label: "Cracks" },
      { layer: "damage", value: 2, label: "Flaking" },
      { layer: '"3d"', value: 7, label: "Flaking" },
    ];
    const numbers = (text: string): number[] => {
      const offset = [...text.slice(0, text.indexOf("'"))].length;
      const length = [...text.slice(text.indexOf("'"))].length;
      return classNumbers(text, { offset, length }, classes).map(({ value }) => value);
    };
    expect(numbers("damage = 'flaking'")).toEqual([2]);
    expect(numbers("ä = 1 and damage <> 'Flakes'")).toEqual([2]);
    expect(numbers("damage in (1, 'Cracks'")).toEqual([1]);
    expect(numbers("\"3d\" = 'Flaking'")).toEqual([7]);
    expect(numbers("damage = 'Salt'")).toEqual([]);
    expect(numbers("wet = 'Cracks'")).toEqual([]);
    expect(numbers("'Cracks' = damage")).toEqual([]);
  });
});
