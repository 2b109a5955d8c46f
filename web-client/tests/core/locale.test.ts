import { afterEach, describe, expect, it } from "vitest";

import { toldDate, toldTime } from "../../src/domain/times";
import { loadLaterTexts, loadTexts, texts } from "../../src/texts";
import type { Texts } from "../../src/texts/shape";
import { cellText, labelOf, parseCell } from "../../src/domain/cells";
import {
  formatCount,
  formatList,
  formatPlace,
  kPageLanguages,
  pageLanguage,
  pageLocale,
  personLanguages,
  readNumber,
  setLocale,
  typedNumber,
} from "../../src/core/locale";
import { formatArea, formatLength, formatNumber } from "../../src/domain/measure";

afterEach(async () => {
  await loadTexts("en", true, []);
  await loadLaterTexts();
});

describe("the language of the page", () => {
  it("is the one that was chosen, else the first of the browser's that there is, else English", () => {
    expect(pageLanguage(null, ["de-AT", "en"])).toBe("de");
    expect(pageLanguage(null, ["fr", "es-MX", "de"])).toBe("es");
    expect(pageLanguage("es", ["de"])).toBe("es");
    expect(pageLanguage(null, ["fr"])).toBe("en");
    expect(pageLanguage(null, [])).toBe("en");
    // a page with more languages stored this setting
    expect(pageLanguage("tlh", ["de"])).toBe("de");
  });

  it("is written as in the browser's variety of it, and data are called by it first where it was chosen", () => {
    setLocale("de", false, ["fr", "de-CH", "de"]);
    expect(pageLocale()).toBe("de-CH");
    expect(personLanguages()).toEqual(["fr", "de-CH", "de"]);
    setLocale("es", true, ["de-CH", "de"]);
    expect(pageLocale()).toBe("es");
    expect(personLanguages()).toEqual(["es", "de-CH", "de"]);
    expect(labelOf({ name: "State", labels: { de: "Zustand", es: "Estado" } })).toBe("Estado");
  });
});

describe("numbers", () => {
  it("are written as in the language", () => {
    const written = (): string[] => [
      formatCount(1234567),
      formatNumber(0.125),
      formatLength(1.24),
      formatArea(2.5e9),
      typedNumber(-1.5),
      formatPlace(["1", "2"]),
    ];
    setLocale("en", false, ["en-GB"]);
    expect(written()).toEqual(["1,234,567", "0.125", "1.24 m", "2.50e+9 m²", "-1.5", "1, 2"]);
    setLocale("de", false, ["de-DE"]);
    expect(written()).toEqual(["1.234.567", "0,125", "1,24 m", "2,50e+9 m²", "-1,5", "1; 2"]);
    setLocale("es", false, ["es-MX"]);
    expect(written()).toEqual(["1,234,567", "0.125", "1.24 m", "2.50e+9 m²", "-1.5", "1, 2"]);
  });

  it("are read with the language's decimal sign or a point, and never guessed", () => {
    setLocale("de", false, []);
    expect(["1,5", " -0,25 ", "1.5", "0.125", "1e-3", ",5", "1500"].map(readNumber)).toEqual([
      1.5, -0.25, 1.5, 0.125, 0.001, 0.5, 1500,
    ]);
    for (const wrong of [
      "1.500",
      "12.345.678",
      "1,500.5",
      "1.500,5",
      "1,5,5",
      "",
      "eins",
      "1 500",
      "NaN",
      "Infinity",
    ])
      expect(readNumber(wrong), wrong).toBeNaN();
    setLocale("en", false, []);
    expect(["1.5", "1.500"].map(readNumber)).toEqual([1.5, 1.5]);
    for (const wrong of ["1,5", "1,500"]) expect(readNumber(wrong), wrong).toBeNaN();
  });

  it("are in fields of records as they may be typed again", () => {
    for (const language of kPageLanguages) {
      setLocale(language, true, []);
      for (const value of [0, 1.5, -1234.5678, 1e21, 1e-7, 1500, 0.001])
        expect(parseCell({ kind: "numeric" }, cellText(value))).toEqual({ value });
    }
  });
});

describe("moments and lists", () => {
  it("are told as in the language", () => {
    const now = new Date(2026, 10, 21, 15, 0);
    const at = (days: number): string => new Date(2026, 10, 21 - days, 14, 5).toISOString();
    const told = (): string[] => [
      toldTime(at(0), now),
      toldTime(at(1), now),
      toldDate(at(2)),
      formatList(["a", "b", "c"]),
    ];
    setLocale("en", false, ["en-GB"]);
    expect(told()).toEqual(["today, 14:05", "yesterday, 14:05", "19 Nov 2026", "a, b, c"]);
    setLocale("de", false, ["de-DE"]);
    expect(told()).toEqual(["heute, 14:05", "gestern, 14:05", "19. Nov. 2026", "a, b und c"]);
    setLocale("es", false, ["es-ES"]);
    expect(told()).toEqual(["hoy, 14:05", "ayer, 14:05", "19 nov 2026", "a, b, c"]);
  });
});

/** Returns all texts with their paths. A function's texts are its results. */
function leaves(from: unknown, path = ""): [string, string][] {
  if (typeof from === "string") return [[path, from]];
  if (typeof from === "function") {
    const makes = from as (...args: unknown[]) => string;
    return [1, 7].map((n) => [
      `${path}(${n})`,
      makes(
        ...Array.from({ length: makes.length }, () => n).map((each, i) =>
          takesWords.has(path) ? `word${i}` : each,
        ),
      ),
    ]);
  }
  if (typeof from !== "object" || from === null) return [];
  return Object.entries(from).flatMap(([key, value]) =>
    leaves(value, path ? `${path}.${key}` : key),
  );
}
const takesWords = new Set([
  "account.token_line",
  "join.lead",
  "people.role_now",
  "project_roles.by_groups",
  "project_roles.by_groups_also",
  "project_roles.lead",
  "site_people.role_changed",
  "wand.amount.value",
]);

async function inLanguage(language: (typeof kPageLanguages)[number]): Promise<Map<string, string>> {
  await loadTexts(language, true, []);
  await loadLaterTexts();
  return new Map(leaves(texts satisfies Texts));
}

describe("the texts", () => {
  it("are there in each language, none empty, and none left in English", async () => {
    const english = await inLanguage("en");
    expect(english.size).toBeGreaterThan(900);
    // texts that may be the same in two languages: names, symbols, examples of input
    const alike =
      /^(product|brush\.width_|account\.token_line|expressions\.functions|expressions\.surface_functions\.\d+\.0|areas\.grammar|tables\.examples|view\.sections|labels\.language_example|shape\.rain\.wind_shares\.hint|help\.\w+\.\d+\.0)/;
    for (const language of ["de", "es"] as const) {
      const translated = await inLanguage(language);
      expect([...translated.keys()]).toEqual([...english.keys()]);
      for (const [path, text] of translated) {
        expect(text, `${language} ${path}`).not.toBe("");
        if (english.get(path)!.length > 14 && !alike.test(path))
          expect(text, `${language} ${path}`).not.toBe(english.get(path));
        expect(text.includes("undefined"), `${language} ${path}: ${text}`).toBe(false);
      }
    }
  });

  it("keep what they are told: each argument of a text is in each language's", async () => {
    const english = await inLanguage("en");
    for (const language of ["de", "es"] as const) {
      for (const [path, text] of await inLanguage(language)) {
        if (!path.endsWith("(7)")) continue;
        const told = (said: string): number => said.split(/7|word\d/).length - 1;
        expect(told(text) > 0, `${language} ${path}: ${text}`).toBe(told(english.get(path)!) > 0);
      }
    }
  });

  it("have the plurals of the language", async () => {
    await loadTexts("en", true, []);
    expect([0, 1, 2].map(texts.home.count)).toEqual(["0 models", "1 model", "2 models"]);
    await loadTexts("de", true, []);
    expect([0, 1, 1200].map(texts.tables.records)).toEqual([
      "0 Datensätze",
      "1 Datensatz",
      "1.200 Datensätze",
    ]);
    await loadTexts("es", true, []);
    expect([1, 2, 1000000].map(texts.home.triangles)).toEqual([
      "1 triángulo",
      "2 triángulos",
      "1.000.000 de triángulos",
    ]);
  });
});
