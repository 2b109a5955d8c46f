// PNG pictures as {width, height, data} with 4 bytes a pixel.
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const kWebClient = join(dirname(dirname(dirname(dirname(fileURLToPath(import.meta.url))))), "web-client", "package.json");
const library = () => createRequire(kWebClient)("pngjs").PNG; // loaded when used: browser.mjs says first what is not installed

export const decode_png = (file) => library().sync.read(file);

export function encode_png({ width, height, data }) {
  return library().sync.write({ width, height, data: Buffer.from(data) }, { inputHasAlpha: true, colorType: 2 });
}
