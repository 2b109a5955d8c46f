// PNG images as {width, height, data} with 4 bytes per pixel.
import { load_module } from "./modules.mjs";

// loaded at the first use, after browser.mjs has reported missing programs
const library = () => load_module("pngjs").PNG;

export const decode_png = (file) => library().sync.read(file);

export function encode_png({ width, height, data }) {
  return library().sync.write(
    { width, height, data: Buffer.from(data) },
    { inputHasAlpha: true, colorType: 2 },
  );
}
