import { readdirSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { describe, expect, it } from "vitest";

import { themeOf } from "../../src/ui/preferences";

const kSource = join(__dirname, "../../src");
const css = readFileSync(join(kSource, "shell", "theme.css"), "utf8");
/** The files of the page; the kiosk has separate colors. */
const pageFiles = ["ui", "session", "features", "shell"].flatMap((folder) =>
  readdirSync(join(kSource, folder), { recursive: true, encoding: "utf8" }).map((name) =>
    join(kSource, folder, name),
  ),
);

/** The colors of a theme, including those inherited from the light one. */
function colorsOf(theme: "light" | "dark" | "contrast"): Map<string, string> {
  const block = (head: string): [string, string][] => {
    const start = css.indexOf(head);
    expect(start, head).toBeGreaterThanOrEqual(0);
    return [
      ...css.slice(start, css.indexOf("\n}", start)).matchAll(/(--[\w-]+): (#[0-9a-f]{6});/g),
    ].map(([, name, value]) => [name!, value!]);
  };
  return new Map([
    ...block("\n:root {"),
    ...(theme === "light" ? [] : block(`:root[data-theme="${theme}"] {`)),
  ]);
}

/** WCAG 2.2, contrast ratio. */
function contrast(a: string, b: string): number {
  const luminance = (hex: string): number => {
    const [red, green, blue] = [1, 3, 5].map((at) => {
      const share = parseInt(hex.slice(at, at + 2), 16) / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * red! + 0.7152 * green! + 0.0722 * blue!;
  };
  const [brighter, darker] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (brighter! + 0.05) / (darker! + 0.05);
}

describe("themes", () => {
  it("are chosen, or follow the system, where more contrast goes before dark", () => {
    expect(themeOf("system", { dark: false, contrast: false })).toBe("light");
    expect(themeOf("system", { dark: true, contrast: false })).toBe("dark");
    expect(themeOf("system", { dark: true, contrast: true })).toBe("contrast");
    expect(themeOf("light", { dark: true, contrast: true })).toBe("light");
  });

  it.each([
    ["light", 4.5, 3],
    ["dark", 4.5, 3],
    ["contrast", 7, 7],
  ] as const)(
    "%s: words and the lines of fields stand out from what is below them",
    (theme, words, lines) => {
      const colors = colorsOf(theme);
      const ratio = (a: string, b: string): number => contrast(colors.get(a)!, colors.get(b)!);
      for (const ground of ["--paper", "--surface", "--raised"]) {
        for (const ink of ["--ink", "--ink-soft", "--accent", "--danger"])
          expect(ratio(ink, ground), `${ink} on ${ground}`).toBeGreaterThanOrEqual(words);
        for (const line of ["--line-strong", "--news"])
          expect(ratio(line, ground), `${line} on ${ground}`).toBeGreaterThanOrEqual(lines);
      }
      for (const hue of ["--accent", "--calm", "--danger"])
        expect(ratio(`${hue}-ink`, hue), `${hue}-ink`).toBeGreaterThanOrEqual(words);
      for (const hue of ["--accent", "--calm", "--danger", "--warn", "--ink"])
        expect(
          ratio(hue === "--ink" ? "--ink" : hue, hue === "--ink" ? "--accent-soft" : `${hue}-soft`),
          `${hue} on its soft ground`,
        ).toBeGreaterThanOrEqual(words);
      expect(
        ratio("--surface", "--ink-soft"),
        "on what is as dark as soft ink",
      ).toBeGreaterThanOrEqual(words);
      expect(
        ratio("--mark-light", "--mark-settled"),
        "on the pin of a resolved comment",
      ).toBeGreaterThanOrEqual(words);
      expect(ratio("--on-stage", "--stage"), "on the stage").toBeGreaterThanOrEqual(words);
    },
  );

  it("are the only place of colours, beside those of data", () => {
    const kOfData = [
      "layer-dialog.ts: #d55e00ff",
      "legend.ts: #e69f00",
      "legend.ts: #56b4e9",
      "legend.ts: #009e73",
      "legend.ts: #cc79a7",
    ];
    const files = pageFiles.filter(
      (path) => /\.(ts|css)$/.test(path) && basename(path) !== "theme.css",
    );
    const found = files.flatMap((path) => {
      const name = basename(path);
      const code = readFileSync(path, "utf8")
        .replace(/\/\*[^]*?\*\//g, "")
        .replace(/\/\/.*/g, "");
      return [...code.matchAll(/#[0-9a-f]{3,8}\b|\b(?:rgb|hsl)a?\(/gi)].map(
        ([color]) => `${name}: ${color}`,
      );
    });
    expect(found.filter((each) => !kOfData.includes(each))).toEqual([]);
  });

  it("set the strength of all lines in their colours", () => {
    const files = pageFiles.filter((path) => path.endsWith(".ts"));
    const found = files.filter((path) =>
      /\d(px)? (solid|dashed) var\(--line\)/.test(readFileSync(path, "utf8")),
    );
    expect(found).toEqual([]);
  });
});
