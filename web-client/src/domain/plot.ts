// Computes the layout of a curve and its axes in a plot: round ticks, units, and optionally one
// scale for both axes. Other code draws the plot.

import { formatFixed } from "../core/locale";
import { formatNumber, lengthUnit, ticks } from "./measure";

export interface PlotPoint {
  x: number;
  /** Null if unknown. The curve has a gap at this point. */
  y: number | null;
}

export interface PlotOf {
  /** The parts of the curve, sorted by x. The curve has breaks between them. */
  parts: readonly (readonly PlotPoint[])[];
  /** The unit of y. Null if x and y are both lengths in meters. */
  yUnit: string | null;
  /** Whether both axes have the same scale, if y is a length. Slopes then keep their angles. */
  equal: boolean;
  /** The size of the whole plot in pixels. */
  width: number;
  height: number;
}

export interface PlotTick {
  at: number; // position in pixels
  label: string;
}

export interface PlotAxis {
  unit: string;
  ticks: readonly PlotTick[];
}

export interface Plot {
  width: number;
  height: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  x: PlotAxis;
  y: PlotAxis;
  /** The SVG path data of each continuous run of points. */
  curves: readonly string[];
  /** The positions in pixels at which parts of the curve meet without a gap between them. */
  breaks: readonly number[];
  xAt(x: number): number;
  yAt(y: number): number;
  /** Returns the x value at a horizontal pixel position. */
  xOf(pixel: number): number;
}

const kCharacterPx = 6.4; // width of a character in a tick label
const kTickSpacePx = { x: 48, y: 22 };
const kTopPx = 24; // space for the label of the y axis
const kBottomPx = 38; // space for the ticks and the label of the x axis
const kRightPx = 14;
// The range of heights divided by the distance. A flatter curve is noise and is not magnified.
const kLeastSlope = 1e-5;

/**
 * Formats the numbers of ticks. All labels have the same number of decimals, as many as the numbers
 * need.
 */
export function tickLabels(numbers: readonly number[]): string[] {
  const [first, second] = numbers;
  if (first === undefined) return [];
  const step = second === undefined ? Math.abs(first) : Math.abs(second - first);
  const size = Math.max(...numbers.map(Math.abs));
  if (size >= 1e9 || (size > 0 && step < 1e-9)) return numbers.map((each) => formatNumber(each, 6));
  const decimals =
    Array.from({ length: 12 }, (_, n) => n).find(
      (n) => Math.abs(step * 10 ** n - Math.round(step * 10 ** n)) < 1e-6 * 10 ** n * step,
    ) ?? 11;
  return numbers.map((each) => formatFixed(each === 0 ? 0 : each, decimals));
}

export function makePlot({ parts, yUnit, equal, width, height }: PlotOf): Plot {
  const known = parts.flat().filter((each): each is { x: number; y: number } => each.y !== null);
  const xMax = Math.max(...parts.flat().map(({ x }) => x), 0) || 1e-9;
  const [low, high] = rangeOf(
    known.map(({ y }) => y),
    yUnit === null ? xMax * kLeastSlope : null,
  );
  const ofLengths = yUnit === null;
  const asHigh = equal && ofLengths;

  const largest = Math.max(Math.abs(low), Math.abs(high));
  const xLength = lengthUnit(asHigh ? Math.max(xMax, largest) : xMax);
  const yLength = asHigh ? xLength : lengthUnit(largest);
  const xFactor = xLength.perMetre;
  const yFactor = ofLengths ? yLength.perMetre : 1;

  const [top, bottom, right] = [kTopPx, Math.max(kTopPx + 1, height - kBottomPx), width - kRightPx];
  const mostY = Math.max(2, Math.floor((bottom - top) / kTickSpacePx.y) + 1);
  const leftOf = (limits: readonly [number, number]): number => {
    const labels = tickLabels(ticks(limits[0] * yFactor, limits[1] * yFactor, mostY));
    return Math.ceil(Math.max(0, ...labels.map((label) => label.length)) * kCharacterPx) + 12;
  };
  const limitsOf = (left: number): { x: number; y: readonly [number, number] } => {
    if (!asHigh) return { x: xMax, y: [low, high] };
    // pixels per meter
    const scale = Math.min((right - left) / xMax, (bottom - top) / (high - low));
    const [middle, half] = [(low + high) / 2, (bottom - top) / scale / 2];
    return { x: (right - left) / scale, y: [middle - half, middle + half] };
  };
  let left = leftOf([low, high]);
  let limits = limitsOf(left);
  if (leftOf(limits.y) !== left) {
    left = leftOf(limits.y); // the labels of a wider range may be longer
    limits = limitsOf(left);
  }
  const [yMin, yMax] = limits.y;

  const xAt = (x: number): number => left + (x / limits.x) * (right - left);
  const yAt = (y: number): number => bottom - ((y - yMin) / (yMax - yMin)) * (bottom - top);
  const axis = (
    unit: string,
    factor: number,
    min: number,
    max: number,
    most: number,
    at: (each: number) => number,
  ): PlotAxis => {
    const found = ticks(min * factor, max * factor, most);
    const labels = tickLabels(found);
    return {
      unit,
      ticks: found.map((each, index) => ({ at: at(each / factor), label: labels[index]! })),
    };
  };
  return {
    width,
    height,
    left,
    right,
    top,
    bottom,
    x: axis(
      xLength.unit,
      xFactor,
      0,
      xMax,
      Math.max(2, Math.floor((xAt(xMax) - left) / kTickSpacePx.x) + 1),
      xAt,
    ),
    y: axis(yUnit ?? yLength.unit, yFactor, yMin, yMax, mostY, yAt),
    curves: parts.flatMap((part) => runsOf(part).map((run) => pathOf(run, xAt, yAt))),
    breaks: parts.slice(1).flatMap((part) => (part[0] ? [xAt(part[0].x)] : [])),
    xAt,
    yAt,
    xOf: (pixel) => ((pixel - left) / (right - left)) * limits.x,
  };
}

/**
 * Returns a range that is slightly larger than the range of the numbers. If the numbers differ by
 * less than `noise`, the range is so large that the curve looks flat.
 */
function rangeOf(numbers: readonly number[], noise: number | null): [number, number] {
  let [min, max] = [Infinity, -Infinity];
  for (const each of numbers) [min, max] = [Math.min(min, each), Math.max(max, each)];
  if (min > max) return [0, 1];
  const size = Math.max(Math.abs(min), Math.abs(max));
  const flat = noise ?? size * 1e-6;
  const span =
    max - min > flat ? max - min : (noise === null ? size / 5 : noise / kLeastSlope / 10) || 1;
  const middle = (min + max) / 2;
  return [middle - span * 0.54, middle + span * 0.54];
}

function runsOf(part: readonly PlotPoint[]): { x: number; y: number }[][] {
  const runs: { x: number; y: number }[][] = [];
  let open = false;
  for (const { x, y } of part) {
    if (y !== null) {
      if (!open) runs.push([]);
      runs[runs.length - 1]!.push({ x, y });
    }
    open = y !== null;
  }
  return runs;
}

/**
 * Returns the path of a run. A run of one point is visible too, because its line has round ends.
 */
function pathOf(
  run: readonly { x: number; y: number }[],
  xAt: (x: number) => number,
  yAt: (y: number) => number,
): string {
  const points = run.map(({ x, y }) => `${xAt(x).toFixed(2)} ${yAt(y).toFixed(2)}`);
  return `M${points.join("L")}${points.length === 1 ? "h0.01" : ""}`;
}

/** Returns the index of the value in `xs` nearest to `x`. `xs` is in ascending order. */
export function nearestIndex(xs: readonly number[], x: number): number {
  let [low, high] = [0, xs.length - 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (xs[middle]! < x) low = middle + 1;
    else high = middle;
  }
  return low > 0 && x - xs[low - 1]! < xs[low]! - x ? low - 1 : low;
}
