// Writes `FILE.br` and `FILE.gz` next to each text file of the build. The server sends these files
// unchanged.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import type { Plugin } from "vite";

const kTexts = /\.(js|css|html|svg|webmanifest|txt)$/;
const kMinBytes = 1024; // a smaller file fits into one packet anyway

export function compress(folder: string): void {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const file = join(folder, entry.name);
    if (entry.isDirectory()) compress(file);
    else if (kTexts.test(entry.name)) {
      const bytes = readFileSync(file);
      if (bytes.length < kMinBytes) continue;
      const mode = {
        [constants.BROTLI_PARAM_MODE]: constants.BROTLI_MODE_TEXT,
        [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
      };
      writeFileSync(`${file}.br`, brotliCompressSync(bytes, { params: mode }));
      writeFileSync(`${file}.gz`, gzipSync(bytes, { level: 9 }));
    }
  }
}

export function compressedBeside(): Plugin {
  let folder = "";
  return {
    name: "compressed-beside",
    apply: "build",
    configResolved: (config) => {
      folder = config.build.outDir;
    },
    closeBundle: () => compress(folder),
  };
}
