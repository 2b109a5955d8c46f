import { readdirSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { describe, expect, it } from "vitest";

import { themeOf } from "../../src/ui/preferences";
import { designSheet } from "./design-sheet";

const kSource = join(__dirname, "../../src");
const css = readFileSync(join(kSource, "shell", "theme.css"), "utf8");
/** The files of the page. The kiosk has separate colors. */
const pageFiles = ["ui", "session", "features", "shell"].flatMap((folder) =>
  readdirSync(join(kSource, folder), { recursive: true, encoding: "utf8" }).map((name) =>
    join(kSource, folder, name),
  ),
);

/** Returns the colors of a theme, including those inherited from the light theme. */
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

/** Returns the contrast ratio of WCAG 2.2. */
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

/** Returns the background color of texts over the 3D view. */
function sheerOf(theme: "light" | "dark" | "contrast"): string {
  const head = theme === "light" ? "\n:root {" : `:root[data-theme="${theme}"] {`;
  return /--on-stage-ground: ([^;]+);/.exec(css.slice(css.indexOf(head)))![1]!;
}

/** Blends a color such as "rgb(18 19 19 / 0.76)" or "#ffffff" over an opaque one. */
function over(sheer: string, beneath: string): string {
  const parts = /^rgb\((\d+) (\d+) (\d+) \/ ([\d.]+)\)$/.exec(sheer);
  if (!parts) return sheer;
  const share = Number(parts[4]);
  const channel = (index: number): string => {
    const below = parseInt(beneath.slice(1 + 2 * index, 3 + 2 * index), 16);
    const mixed = Math.round(share * Number(parts[1 + index]) + (1 - share) * below);
    return mixed.toString(16).padStart(2, "0");
  };
  return `#${channel(0)}${channel(1)}${channel(2)}`;
}

/** Returns the declarations in the styles of a file. */
function declarationsOf(path: string): [name: string, value: string][] {
  const text = readFileSync(path, "utf8");
  const styles = path.endsWith(".css")
    ? [text]
    : [...text.matchAll(/css`([^`]*)`/g)].map((found) => found[1]!);
  return styles.flatMap((style) =>
    [...style.matchAll(/(?<=^|[\s{])([a-z-]+):\s+([^;{}]+);/g)].map(
      ([, name, value]) => [name!, value!] as [string, string],
    ),
  );
}

/**
 * Returns whether the value has a length below 48 px, or a duration below 300 ms, outside of a
 * function.
 */
function strayIn(value: string): boolean {
  let plain = value;
  while (plain !== (plain = plain.replace(/[a-z-]+\([^()]*\)/g, "")));
  return [...plain.matchAll(/(?<![\w.])-?(\d*\.?\d+)(px|rem|ms)\b/g)].some(
    ([, number, unit]) =>
      Number(number) > 0 && Number(number) * (unit === "rem" ? 16 : 1) < (unit === "ms" ? 300 : 48),
  );
}

describe("the picture of the tokens", () => {
  it("shows theme.css; `npm run design` writes it", async () => {
    await expect(designSheet(css)).toMatchFileSnapshot("../../../docs/developer/design.svg");
  });
});

describe("measures", () => {
  it("are tokens wherever a style sets space, sizes of texts, corners or durations", () => {
    const kOfTokens =
      /^((row-|column-)?gap|(padding|margin)(-[a-z-]+)?|font(-size)?|border-radius|transition|animation)$/;
    const files = pageFiles.filter((path) => /\.(ts|css)$/.test(path));
    const found = files.flatMap((path) =>
      ["theme.css", "fonts.css"].includes(basename(path))
        ? []
        : declarationsOf(path)
            .filter(([name, value]) => kOfTokens.test(name) && strayIn(value))
            .map(([name, value]) => `${basename(path)}: ${name}: ${value}`),
    );
    expect(found, "docs/developer/design.md lists the tokens").toEqual([]);
  });

  it("are refused where they are numbers", () => {
    for (const value of [
      "0.5rem",
      "0 6px",
      "-4px auto",
      "600 0.9rem var(--serif)",
      "opacity 120ms",
    ])
      expect(strayIn(value), value).toBe(true);
    for (const value of [
      "0",
      "var(--space-2) 0",
      "calc(-1 * var(--space-2))",
      "clamp(1rem, 4vw, 3.5rem)",
      "4.125rem auto",
      "1.2em",
      "50%",
      "turn 900ms linear",
    ])
      expect(strayIn(value), value).toBe(false);
  });

  it("have their name in theme.css wherever a style uses one", () => {
    const known = new Set([...css.matchAll(/(--[\w-]+):/g)].map(([, name]) => name));
    const kMeasures = /var\((--(?:space|text|radius|control|shadow|fast|slow)[\w-]*)/g;
    const used = pageFiles
      .filter((path) => path.endsWith(".ts"))
      .flatMap((path) =>
        [...readFileSync(path, "utf8").matchAll(kMeasures)].map(([, name]) => name),
      );
    expect(used.length).toBeGreaterThan(500);
    expect(used.filter((name) => !known.has(name))).toEqual([]);
  });
});

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
      for (const ground of ["--paper", "--surface", "--raised", "--field"]) {
        for (const ink of ["--ink", "--ink-soft", "--accent", "--calm", "--danger", "--warn"])
          expect(ratio(ink, ground), `${ink} on ${ground}`).toBeGreaterThanOrEqual(words);
        for (const line of ["--line-strong", "--news", "--focus-color"])
          expect(ratio(line, ground), `${line} on ${ground}`).toBeGreaterThanOrEqual(lines);
      }
      for (const hue of ["--accent", "--danger"])
        expect(ratio(`${hue}-ink`, `${hue}-strong`), `${hue}-strong`).toBeGreaterThanOrEqual(words);
      if (colors.has("--chosen"))
        expect(
          ratio(colors.has("--chosen-ink") ? "--chosen-ink" : "--ink", "--chosen"),
          "on the chosen one",
        ).toBeGreaterThanOrEqual(words);
      for (const beneath of ["#000000", "#ffffff"])
        expect(
          contrast(colors.get("--on-stage")!, over(sheerOf(theme), beneath)),
          `over a part of the picture in ${beneath}`,
        ).toBeGreaterThanOrEqual(4.5);
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
