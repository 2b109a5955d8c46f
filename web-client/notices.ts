// Adds `third-party-notices.txt` to the build. It contains the licenses of the npm packages whose
// code or fonts are in the build.
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import type { Plugin } from "vite";

const kFolder = /^(.*\/node_modules\/((?:@[^/]+\/)?[^/]+))\//;

function noticeOf(folder: string): string {
  const file = readdirSync(folder).find((name) => /^licen[cs]e/i.test(name));
  if (!file || !existsSync(join(folder, file)))
    throw new Error(`${folder} has no licence file: its code cannot be shipped`);
  return readFileSync(join(folder, file), "utf8").trim();
}

export function thirdPartyNotices(): Plugin {
  let root = "";
  return {
    name: "third-party-notices",
    apply: "build",
    configResolved: (config) => {
      root = config.root;
    },
    generateBundle(_, bundle) {
      const packages = new Map<string, string>();
      for (const part of Object.values(bundle))
        for (const id of part.type === "chunk"
          ? Object.keys(part.modules)
          : part.originalFileNames.map((name) => resolve(root, name))) {
          // Rollup marks modules that it generates from CommonJS with a null byte.
          const found = kFolder.exec(id.replaceAll("\\", "/").replace(/^\0/, ""));
          if (found) packages.set(found[2]!, found[1]!);
        }
      const notices = [...packages].sort().map(([name, folder]) => {
        const { version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8")) as {
          version: string;
        };
        return `${name} ${version}\n\n${noticeOf(folder)}\n`;
      });
      this.emitFile({
        type: "asset",
        fileName: "third-party-notices.txt",
        source: notices.join(`\n${"=".repeat(80)}\n\n`),
      });
    },
  };
}
