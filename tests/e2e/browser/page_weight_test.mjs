// The number of bytes that a browser loads before it first shows a page. The test counts the bytes
// of the gzip files, although the Brotli files are smaller, because browsers accept only gzip over
// plain HTTP.
import assert from "node:assert/strict";
import { existsSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { kRoot, missing } from "../support/js/modules.mjs";

const kMost = 200_000;
const kMostFonts = 100_000; // for the fonts that the page requests immediately
const dist = join(kRoot, "web-client", "dist");
const list = join(dist, ".vite", "manifest.json");
if (!existsSync(list)) missing("the page is not built");
const manifest = JSON.parse(readFileSync(list, "utf8"));

/** Returns an entry with all its direct and indirect imports. */
function with_imports(key, found = new Set()) {
  if (found.has(key)) return found;
  assert.ok(manifest[key], `${key} is no piece of the page: ${Object.keys(manifest)}`);
  found.add(key);
  for (const next of manifest[key].imports ?? []) with_imports(next, found);
  return found;
}

function weight(...keys) {
  const pieces = new Set(keys.flatMap((key) => [...with_imports(key)]));
  const files = new Set(
    [...pieces].flatMap((key) => [manifest[key].file, ...(manifest[key].css ?? [])]),
  );
  const bytes = [...files].map(
    (file) =>
      statSync(existsSync(join(dist, `${file}.gz`)) ? join(dist, `${file}.gz`) : join(dist, file))
        .size,
  );
  return bytes.reduce((sum, each) => sum + each, statSync(join(dist, "index.html")).size);
}

// other entries import this one, so it does not have the name of a source file
const kShell = [
  "index.html",
  Object.keys(manifest).find((key) => manifest[key].name === "strata-app"),
];
const kFirst = {
  "signing in": ["src/features/account/sign-in.ts"],
  "the gallery": ["src/features/home/home-page.ts"],
  "a model": ["src/shell/model-page.ts"],
};
for (const language of ["en", "de", "es"])
  for (const [what, keys] of Object.entries(kFirst)) {
    const bytes = weight(...kShell, `src/texts/${language}.ts`, ...keys);
    console.log(`${language}, ${what}: ${bytes} bytes`);
    assert.ok(bytes <= kMost, `${what} (${language}) takes ${bytes} bytes before it is shown`);
  }
const kiosk = weight("index.html", "src/kiosk/main.ts");
console.log(`a kiosk: ${kiosk} bytes`);
assert.ok(kiosk <= kMost);

const document = readFileSync(join(dist, "index.html"), "utf8");
const fonts = [...document.matchAll(/href="\/(assets\/[^"]+\.woff2)"/g)].map(
  ([, file]) => statSync(join(dist, file)).size,
);
const font_bytes = fonts.reduce((sum, each) => sum + each, 0);
console.log(`fonts: ${font_bytes} bytes in ${fonts.length} files`);
assert.equal(fonts.length, 2);
assert.ok(font_bytes <= kMostFonts);

// Encoded files have the same content as the plain files, and every script has a source map.
const { brotliDecompressSync, gunzipSync } = await import("node:zlib");
for (const { file } of Object.values(manifest)) {
  const at = join(dist, file);
  if (!file.endsWith(".js") || statSync(at).size < 1024) continue;
  assert.deepEqual(gunzipSync(readFileSync(`${at}.gz`)), readFileSync(at));
  assert.deepEqual(brotliDecompressSync(readFileSync(`${at}.br`)), readFileSync(at));
  assert.ok(existsSync(`${at}.map`), `${file} has no source map`);
}
