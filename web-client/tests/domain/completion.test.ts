import { describe, expect, it } from "vitest";
import { complete, markedAt, nameInText } from "../../src/domain/completion";

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
});
