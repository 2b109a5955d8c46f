import { describe, expect, it } from "vitest";
import { keyPieces } from "../../src/ui/keys/key-caps";

const kNames = ["Ctrl", "Enter", "Escape", "Page"];
const keysOf = (text: string): string[] =>
  keyPieces(text, kNames)
    .filter(({ isKey }) => isKey)
    .map(({ text }) => text);

describe("keys in a text", () => {
  it("are single characters and known names, alone between separators", () => {
    expect(keysOf("B · E · I")).toEqual(["B", "E", "I"]);
    expect(keysOf("Ctrl + Enter · Escape")).toEqual(["Ctrl", "Enter", "Escape"]);
    expect(keysOf("C, then click")).toEqual(["C"]);
    expect(keysOf("+ · −")).toEqual(["+", "−"]);
    expect(keysOf("[ · ]")).toEqual(["[", "]"]);
    expect(keysOf("1 – 6")).toEqual(["1", "6"]);
  });

  it("are no words that only contain them", () => {
    expect(keysOf("A column's ⋯ → Change")).toEqual([]);
    expect(keysOf("Paged")).toEqual([]);
    expect(keysOf("Enter a name")).toEqual([]);
  });

  it("leave the text as it is", () => {
    for (const text of ["Ctrl + Z · Ctrl + Shift + Z", "C, then click", "Wheel", "1 – 6"])
      expect(
        keyPieces(text, kNames)
          .map((piece) => piece.text)
          .join(""),
      ).toBe(text);
  });
});
