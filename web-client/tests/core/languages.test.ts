import { describe, expect, it } from "vitest";

import {
  kCommonLanguages,
  labelsOf,
  nameOfLanguage,
  rowsOf,
  wellWrittenTag,
} from "../../src/core/languages";

describe("languages", () => {
  it("are called as those who speak them do, each of those that are offered", () => {
    expect(nameOfLanguage("es")).toBe("español");
    expect(nameOfLanguage("pt-br")).toMatch(/^português/);
    for (const tag of kCommonLanguages) expect(nameOfLanguage(tag), tag).not.toBe("");
  });

  it("have no name where nobody knows them, or where the tag is none", () => {
    for (const tag of ["", "es_MX", "e", "a language", "qaa"])
      expect(nameOfLanguage(tag), tag).toBe("");
  });

  it("are written as usual", () => {
    expect(wellWrittenTag("PT-br")).toBe("pt-BR");
    expect(wellWrittenTag("es_MX")).toBeNull();
  });
});

describe("names in several languages", () => {
  it("are a row each, and what rows say", () => {
    const labels = { es: "Nota", de: "Notiz" };
    expect(rowsOf(labels)).toEqual([
      { language: "de", label: "Notiz" },
      { language: "es", label: "Nota" },
    ]);
    expect(labelsOf(rowsOf(labels))).toEqual({ labels });
    expect(
      labelsOf([
        { language: " es ", label: " Nota " },
        { language: "fr", label: " " },
        { language: "", label: "" },
      ]),
    ).toEqual({ labels: { es: "Nota" } });
  });

  it("need a language, and one name in it", () => {
    expect(
      labelsOf([
        { language: "es", label: "Nota" },
        { language: "", label: "Notiz" },
      ]),
    ).toEqual({ row: 1, wrong: "no_language" });
    expect(
      labelsOf([
        { language: "es", label: "Nota" },
        { language: "ES", label: "Apunte" },
      ]),
    ).toEqual({ row: 1, wrong: "twice" });
  });
});
