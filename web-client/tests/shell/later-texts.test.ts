// Some texts are loaded later. The code that the page shows first must not read them, because they
// would be missing.

import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { describe, expect, it } from "vitest";
import { laterTexts } from "../../src/texts/later-en";

const kSource = join(__dirname, "../../src");
/** The modules that strata-app.ts loads without later(). */
const kFirst = [
  "shell/main.ts",
  "shell/strata-app.ts",
  "shell/model-page.ts",
  "features/home/home-page.ts",
  "features/account/sign-in.ts",
  "features/account/join-page.ts",
];

/** Returns the imports at run time. Omits modules that are loaded later. */
function importsOf(file: string): string[] {
  const code = readFileSync(file, "utf8");
  const found = code.matchAll(/^(?:import|export)\s+(?!type\b)(?:[^;"]*?from\s+)?"(\.[^"]+)"/gm);
  return [...found].flatMap(([, path]) => {
    const at = join(dirname(file), path!);
    return [`${at}.ts`, join(at, "index.ts")].filter((each) => existsSync(each));
  });
}

function reachedFrom(files: readonly string[]): Set<string> {
  const reached = new Set<string>();
  const visit = (file: string): void => {
    if (reached.has(file)) return;
    reached.add(file);
    importsOf(file).forEach(visit);
  };
  files.forEach(visit);
  return reached;
}

const readsLater = (code: string): string[] =>
  [...code.matchAll(/\btexts\.(\w+)/g)]
    .map(([, name]) => name!)
    .filter((name) => name in laterTexts);

describe("Texts that are loaded later", () => {
  const first = [...reachedFrom(kFirst.map((file) => join(kSource, file)))];

  it("are not read by what is shown first", () => {
    expect(first.length).toBeGreaterThan(150);
    expect(first).not.toContain(join(kSource, "shell/model-dialogs.ts"));
    const wrong = first.flatMap((file) =>
      readsLater(readFileSync(file, "utf8")).map((name) => `${file} reads ${name}`),
    );
    expect(wrong).toEqual([]);
  });

  it("are noticed where they are", () => {
    expect(readsLater("const words = texts.measure;")).toEqual(["measure"]);
    expect(readsLater("texts.layers.open")).toEqual([]);
  });

  it("are loaded before each other part", () => {
    const app = readFileSync(join(kSource, "shell/strata-app.ts"), "utf8");
    const parts = app.slice(app.indexOf("setPartLoads({"), app.indexOf("});"));
    const without = [...parts.matchAll(/^ {2}(\w+): \(\) =>/gm)].map(([, part]) => part);
    expect(without).toEqual(["home", "model", "join", "sign_in"]);
  });
});
