// What a picture becomes as the shape of a brush. The server decides; this is what its answer looks
// like beforehand.

export const kShapeSide = 256;

export type ShapePart = "opaque" | "light" | "dark";

interface Pixels {
  width: number;
  height: number;
  data: Uint8ClampedArray;
}

const luma = (data: Uint8ClampedArray, at: number): number =>
  0.2126 * data[at]! + 0.7152 * data[at + 1]! + 0.0722 * data[at + 2]!;

/**
 * Which part a person most likely means: what is opaque; else a light shape on a dark ground, or a
 * dark one on a light.
 */
export function likelyPart({ width, height, data }: Pixels): ShapePart {
  for (let at = 3; at < data.length; at += 4) if (data[at] !== 255) return "opaque";
  let sum = 0;
  let count = 0;
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      if (x > 0 && y > 0 && x < width - 1 && y < height - 1) continue;
      sum += luma(data, 4 * (y * width + x));
      ++count;
    }
  }
  return sum / count >= 128 ? "dark" : "light";
}

/**
 * In place: opaque black where the tool is, transparent elsewhere. Returns whether anything is the
 * tool.
 */
export function toShape({ data }: Pixels, part: ShapePart): boolean {
  let any = false;
  for (let at = 0; at < data.length; at += 4) {
    const alpha = data[at + 3]! / 255;
    const weight =
      part === "opaque"
        ? 255 * alpha
        : (part === "light" ? luma(data, at) : 255 - luma(data, at)) * alpha;
    const inside = weight >= 127.5;
    any ||= inside;
    data.set([0, 0, 0, inside ? 255 : 0], at);
  }
  return any;
}

/** Where a picture lies in the square around it. */
export function inSquare(
  width: number,
  height: number,
  side: number,
): { x: number; y: number; width: number; height: number } {
  const scale = side / Math.max(width, height);
  return {
    x: (side - width * scale) / 2,
    y: (side - height * scale) / 2,
    width: width * scale,
    height: height * scale,
  };
}
