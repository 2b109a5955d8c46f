import { describe, expect, it } from "vitest";

import {
  kCommonLanguages,
  labels_of,
  name_of_language,
  rows_of,
  well_written_tag,
} from "../../src/core/languages";

describe("languages", () => {
  it("are called as those who speak them do, each of those that are offered", () => {
    expect(name_of_language("es")).toBe("español");
    expect(name_of_language("pt-br")).toMatch(/^português/);
    for (const tag of kCommonLanguages) expect(name_of_language(tag), tag).not.toBe("");
  });

  it("have no name where nobody knows them, or where the tag is none", () => {
    for (const tag of ["", "es_MX", "e", "a language", "qaa"])
      expect(name_of_language(tag), tag).toBe("");
  });

  it("are written as usual", () => {
    expect(well_written_tag("PT-br")).toBe("pt-BR");
    expect(well_written_tag("es_MX")).toBeNull();
  });
});

describe("names in several languages", () => {
  it("are a row each, and what rows say", () => {
    const labels = { es: "Nota", de: "Notiz" };
    expect(rows_of(labels)).toEqual([
      { language: "de", label: "Notiz" },
      { language: "es", label: "Nota" },
    ]);
    expect(labels_of(rows_of(labels))).toEqual({ labels });
    expect(
      labels_of([
        { language: " es ", label: " Nota " },
        { language: "fr", label: " " },
        { language: "", label: "" },
      ]),
    ).toEqual({ labels: { es: "Nota" } });
  });

  it("need a language, and one name in it", () => {
    expect(
      labels_of([
        { language: "es", label: "Nota" },
        { language: "", label: "Notiz" },
      ]),
    ).toEqual({ row: 1, wrong: "no_language" });
    expect(
      labels_of([
        { language: "es", label: "Nota" },
        { language: "ES", label: "Apunte" },
      ]),
    ).toEqual({ row: 1, wrong: "twice" });
  });
});
