// The costs of paths along the edges of a picture, as in "Intelligent scissors for image
// composition" (Mortensen and Barrett, SIGGRAPH 1995). A pixel costs little if it is on an edge or
// on a thin dark line such as a crack. Runs in any thread and has no access to the page.

export interface Picture {
  width: number;
  height: number;
  /** The numbers of a pixel: gray, or red, green, blue and an alpha value that is ignored. */
  channels: 1 | 4;
  /** The pixels from left to right and top to bottom. */
  pixels: Uint8Array | Uint8ClampedArray;
}

/** The highest cost of a pixel, where the picture is flat. */
export const kMaxCost = 255;
/** The lowest cost. Its ratio to the highest cost limits the detours that an edge is worth. */
export const kMinCost = 12;

// A normal distribution with a standard deviation of one pixel, from its middle to its end.
const [kBlur0, kBlur1, kBlur2, kBlur3] = [0.3992, 0.242, 0.054, 0.0044] as const;
const kReach = 3;
// The center of a line up to three pixels wide must be stronger than its two sides, and the sides
// of a step must not look like lines.
const kLineGain = 1.5;
const kStepShare = 0.5;
// A pixel that is not the strongest one across its edge has this share of its strength.
const kOffCrest = 0.5;
// Edges that are this many times stronger than most pixels are no noise.
const kAboveNoise = 2;
const kLeastNoise = 1.5; // in levels of gray per pixel
const kBins = 1024;

/** A number for each pixel, with a border of one pixel. */
interface Plane {
  values: Float32Array;
  width: number;
  height: number;
  /** The distance of the rows in `values`. */
  stride: number;
}

/** The strength of the edge or line at each pixel, and its direction. */
interface Edges extends Plane {
  /** The direction across the edge, as an index of `kSteps`. */
  across: Uint8Array;
}

/**
 * Returns the cost of each pixel. Time and memory are proportional to the number of pixels. Throws
 * a RangeError if the number of pixels does not match the size.
 */
export function edgeCosts(picture: Picture): Uint8Array {
  const { width, height, channels, pixels } = picture;
  if (!(width >= 1 && height >= 1 && pixels.length === width * height * channels))
    throw new RangeError(`${pixels.length} values for ${width} × ${height} × ${channels}`);
  const gray = planeOf(width, height);
  const edges = { ...planeOf(width, height), across: new Uint8Array(gray.values.length) };
  const colors = channels === 1 ? 1 : 3;
  for (let color = 0; color < colors; ++color) {
    const plane = smoothed(picture, color);
    addSteps(plane, edges);
    for (let at = 0; at < gray.values.length; ++at) gray.values[at]! += plane.values[at]! / colors;
  }
  addLines(gray, edges);
  return costsOf(edges);
}

function planeOf(width: number, height: number): Plane {
  const stride = width + 2;
  return { values: new Float32Array(stride * (height + 2)), width, height, stride };
}

/** Returns one channel, smoothed. The pixels of the border are repeated outside the picture. */
function smoothed({ pixels, width, height, channels }: Picture, channel: number): Plane {
  // The rows above and below the picture are repeated as often as the two steps need them.
  const above = kReach + 1;
  const rows = new Float32Array(width * (height + 2 * above));
  const line = new Float32Array(width + 2 * kReach);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x)
      line[x + kReach] = pixels[(y * width + x) * channels + channel]!;
    line.fill(line[kReach]!, 0, kReach);
    line.fill(line[width + kReach - 1]!, width + kReach);
    const row = (y + above) * width;
    for (let x = 0; x < width; ++x)
      rows[row + x] =
        kBlur0 * line[x + 3]! +
        kBlur1 * (line[x + 2]! + line[x + 4]!) +
        kBlur2 * (line[x + 1]! + line[x + 5]!) +
        kBlur3 * (line[x]! + line[x + 6]!);
  }
  const last = (height + above - 1) * width;
  for (let y = 0; y < above; ++y) {
    rows.copyWithin(y * width, above * width, (above + 1) * width);
    rows.copyWithin(last + (y + 1) * width, last, last + width);
  }
  const plane = planeOf(width, height);
  const { values, stride } = plane;
  for (let y = 0; y < height + 2; ++y) {
    const [from, to] = [(y + kReach) * width, y * stride + 1];
    for (let x = from; x < from + width; ++x)
      values[to + x - from] =
        kBlur0 * rows[x]! +
        kBlur1 * (rows[x - width]! + rows[x + width]!) +
        kBlur2 * (rows[x - 2 * width]! + rows[x + 2 * width]!) +
        kBlur3 * (rows[x - 3 * width]! + rows[x + 3 * width]!);
    values[to - 1] = values[to]!;
    values[to + width] = values[to + width - 1]!;
  }
  return plane;
}

/** Takes over the gradient (Sobel), in levels per pixel, where it is stronger. */
function addSteps({ values, width, height, stride }: Plane, edges: Edges): void {
  for (let y = 1; y <= height; ++y)
    for (let at = y * stride + 1; at <= y * stride + width; ++at) {
      const falling = values[at + stride + 1]! - values[at - stride - 1]!;
      const rising = values[at - stride + 1]! - values[at + stride - 1]!;
      const dx = (falling + rising + 2 * (values[at + 1]! - values[at - 1]!)) / 8;
      const dy = (falling - rising + 2 * (values[at + stride]! - values[at - stride]!)) / 8;
      const size = Math.sqrt(dx * dx + dy * dy);
      if (size <= edges.values[at]!) continue;
      edges.values[at] = size;
      edges.across[at] = directionOf(dx, dy);
    }
}

/** Takes over thin dark lines where they are stronger: the largest curvature of the gray values. */
function addLines({ values, width, height, stride }: Plane, edges: Edges): void {
  for (let y = 1; y <= height; ++y)
    for (let at = y * stride + 1; at <= y * stride + width; ++at) {
      const twice = 2 * values[at]!;
      const [left, right] = [values[at - 1]!, values[at + 1]!];
      const [up, down] = [values[at - stride]!, values[at + stride]!];
      const xx = left + right - twice;
      const yy = up + down - twice;
      const xy =
        (values[at - stride - 1]! +
          values[at + stride + 1]! -
          values[at - stride + 1]! -
          values[at + stride - 1]!) /
        4;
      const half = (xx - yy) / 2;
      const root = Math.sqrt(half * half + xy * xy);
      const [dx, dy] = [(right - left) / 2, (down - up) / 2];
      const curvature = (xx + yy) / 2 + root;
      const size = kLineGain * (curvature - kStepShare * Math.sqrt(dx * dx + dy * dy));
      if (size <= edges.values[at]!) continue;
      edges.values[at] = size;
      edges.across[at] = half > 0 ? directionOf(half + root, xy) : directionOf(xy, root - half);
    }
}

// Steps in x and y for the four directions, by multiples of 45°.
const kSteps = [
  [1, 0],
  [1, 1],
  [0, 1],
  [-1, 1],
] as const;
const kTan22 = Math.SQRT2 - 1;

function directionOf(dx: number, dy: number): number {
  const [x, y] = [Math.abs(dx), Math.abs(dy)];
  if (y <= kTan22 * x) return 0;
  if (x <= kTan22 * y) return 2;
  return dx * dy > 0 ? 1 : 3;
}

function costsOf({ values, across, width, height, stride }: Edges): Uint8Array {
  const noise = Math.max(kLeastNoise, kAboveNoise * medianOf(values));
  const steps = kSteps.map(([x, y]) => y * stride + x);
  const costs = new Uint8Array(width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const at = (y + 1) * stride + x + 1;
      const own = values[at]!;
      const step = steps[across[at]!]!;
      const isOff = values[at + step]! > own || values[at - step]! > own;
      const share = (isOff ? kOffCrest * own : own) / noise;
      costs[y * width + x] = Math.round(kMinCost + (kMaxCost - kMinCost) / (1 + share * share));
    }
  return costs;
}

/** Returns a value that half of the values do not exceed, with the accuracy of the histogram. */
function medianOf(values: Float32Array): number {
  let most = 0;
  for (const value of values) most = Math.max(most, value);
  if (most === 0) return 0;
  const bins = new Uint32Array(kBins);
  for (const value of values) bins[Math.min(kBins - 1, Math.floor((value / most) * kBins))]! += 1;
  let [bin, below] = [0, bins[0]!];
  while (2 * below < values.length) below += bins[++bin]!;
  return ((bin + 0.5) / kBins) * most;
}
