// Layout of a curve and its axes in a plot: round ticks, units, and one scale for both axes on
// request. Independent of how the plot is drawn.

import { formatFixed } from "../core/locale";
import { formatNumber, lengthUnit, ticks } from "./measure";

export interface PlotPoint {
  x: number;
  /** Null: unknown; the curve has a gap there. */
  y: number | null;
}

export interface PlotOf {
  /** Parts of the curve, sorted by x; the curve is broken between them. */
  parts: readonly (readonly PlotPoint[])[];
  /** The unit of y; null: x and y are both lengths in meters. */
  yUnit: string | null;
  /** Equal scale on both axes, for lengths: slopes keep their angle. */
  equal: boolean;
  /** Size of the whole plot in pixels. */
  width: number;
  height: number;
}

export interface PlotTick {
  at: number; // pixel
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
  /** SVG path data of each run without a gap. */
  curves: readonly string[];
  /** Positions of breaks in the curve without a gap between the parts, in pixels. */
  breaks: readonly number[];
  xAt(x: number): number;
  yAt(y: number): number;
  /** The x at a pixel of the plot's width. */
  xOf(pixel: number): number;
}

const kCharacterPx = 6.4; // width of a character in a tick label
const kTickSpacePx = { x: 48, y: 22 };
const kTopPx = 24; // room for the label of the y axis
const kBottomPx = 38; // for ticks and the label of the x axis
const kRightPx = 14;
// range of heights divided by distance: anything flatter is noise and is not magnified into relief
const kLeastSlope = 1e-5;

/** Round numbers between the limits, all with the number of decimals that they need. */
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
    const scale = Math.min((right - left) / xMax, (bottom - top) / (high - low)); // px per meter
    const [middle, half] = [(low + high) / 2, (bottom - top) / scale / 2];
    return { x: (right - left) / scale, y: [middle - half, middle + half] };
  };
  let left = leftOf([low, high]);
  let limits = limitsOf(left);
  if (leftOf(limits.y) !== left) {
    left = leftOf(limits.y); // the labels of the wider range may be longer
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
 * A range slightly larger than that of the numbers. Where they differ by less than `noise`, the
 * range is so large that the curve looks flat.
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

/** A single point is visible as well, since its line has round ends. */
function pathOf(
  run: readonly { x: number; y: number }[],
  xAt: (x: number) => number,
  yAt: (y: number) => number,
): string {
  const points = run.map(({ x, y }) => `${xAt(x).toFixed(2)} ${yAt(y).toFixed(2)}`);
  return `M${points.join("L")}${points.length === 1 ? "h0.01" : ""}`;
}

/** The index of the nearest place; `xs` ascends. */
export function nearestIndex(xs: readonly number[], x: number): number {
  let [low, high] = [0, xs.length - 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (xs[middle]! < x) low = middle + 1;
    else high = middle;
  }
  return low > 0 && x - xs[low - 1]! < xs[low]! - x ? low - 1 : low;
}
