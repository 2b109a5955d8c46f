// The page's development dependencies, for tests outside its folder.
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const kRoot = dirname(dirname(dirname(dirname(dirname(fileURLToPath(import.meta.url))))));

/** Ends the test: as a failure in CI, and as visibly skipped in a run by hand. */
export function missing(what) {
  console.log(`${process.env.CI === "true" ? "FAILED" : "SKIPPED"}: ${what}`);
  process.exit(process.env.CI === "true" ? 1 : 77);
}

export function load_module(name) {
  try {
    return createRequire(join(kRoot, "web-client", "package.json"))(name);
  } catch (error) {
    if (error.code !== "MODULE_NOT_FOUND") throw error;
    return missing(`${name.split("/")[0]} is not installed: npm ci in web-client`);
  }
}
