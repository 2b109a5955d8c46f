// Converts an image to a brush shape, for a preview. The server makes the final shape.

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
 * Returns the most likely shape in the image. If some pixels are transparent, this is the opaque
 * part. Otherwise it is the light part on a dark background, or the dark part on a light one.
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
 * Overwrites the pixels: opaque black inside the shape, transparent outside. Returns whether the
 * shape has any pixels.
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

/** Returns the position of an image in the square around it. */
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
