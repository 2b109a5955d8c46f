// Pictures for tests of what follows edges.

import type { SharpFrame } from "../src/features/painting/sharp-frame";

/** Returns normally distributed numbers, always the same ones. */
export function noise(deviation: number): () => number {
  let state = 12345;
  const uniform = (): number => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return (state + 0.5) / 2 ** 32;
  };
  return () => deviation * Math.sqrt(-2 * Math.log(uniform())) * Math.cos(2 * Math.PI * uniform());
}

/** Makes a gray frame. `valueAt` gets the middle of each pixel. `read` is called for each part. */
export function frameOf(
  width: number,
  height: number,
  valueAt: (x: number, y: number) => number,
  read: (part: { x: number; y: number; width: number; height: number }) => void = () => {},
): SharpFrame {
  return {
    number: 1,
    camera: 1,
    width,
    height,
    read: (x, y, partWidth, partHeight) => {
      read({ x, y, width: partWidth, height: partHeight });
      const pixels = new Uint8ClampedArray(4 * partWidth * partHeight);
      for (let at = 0; at < partWidth * partHeight; ++at)
        pixels.fill(
          valueAt(x + (at % partWidth) + 0.5, y + Math.floor(at / partWidth) + 0.5),
          4 * at,
          4 * at + 4,
        );
      return pixels;
    },
  };
}
