// The page's texts in one of its languages, from the page's own sources.
import { join } from "node:path";
import { kRoot, load_module } from "./modules.mjs";

export function texts_of(language) {
  const { buildSync } = load_module("esbuild"); // the copy that vite installs
  const contents = `
    import { setLocale } from "./core/locale";
    export { texts } from "./texts/${language}";
    export { laterTexts } from "./texts/later-${language}";
    export { help } from "./texts/help-${language}";
    setLocale("${language}", true, []);`;
  const stdin = { contents, resolveDir: join(kRoot, "web-client", "src"), loader: "ts" };
  const [{ text }] = buildSync({
    stdin,
    bundle: true,
    write: false,
    format: "cjs",
    target: "node18",
  }).outputFiles;
  const made = { exports: {} };
  new Function("module", "exports", text)(made, made.exports);
  const { texts, laterTexts, help } = made.exports;
  return { ...texts, ...laterTexts, help: { ...texts.help, ...help } };
}
