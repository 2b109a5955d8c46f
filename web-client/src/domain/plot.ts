// Where a curve and its axes lie in a plot: round ticks, units, one scale for both axes where that
// is asked for. Knows nothing of how it is drawn.

import { format_fixed } from "../core/locale";
import { format_number, length_unit, ticks } from "./measure";

export interface PlotPoint {
  x: number;
  /** Null: nothing is known there, and the curve has a gap. */
  y: number | null;
}

export interface PlotOf {
  /** Of the curve: it is broken between them. By x. */
  parts: readonly (readonly PlotPoint[])[];
  /** What y is measured in; null: x and y are both lengths in metres. */
  y_unit: string | null;
  /** As high as wide, for lengths: slopes look as they are. */
  equal: boolean;
  /** Of the whole plot, pixels. */
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
  /** Path data of each run without a gap. */
  curves: readonly string[];
  /** Where the curve is broken though nothing lies between, pixels. */
  breaks: readonly number[];
  x_at(x: number): number;
  y_at(y: number): number;
  /** At a pixel of the plot's width. */
  x_of(pixel: number): number;
}

const kCharacter_px = 6.4; // of the ticks' labels
const kTickSpace_px = { x: 48, y: 22 };
const kTop_px = 24; // room for the name of the y axis
const kBottom_px = 38; // for ticks and the name of the x axis
const kRight_px = 14;
// of the heights' range to the distance: what is flatter is noise, and is not blown up to look like
// relief
const kLeastSlope = 1e-5;

/** Round numbers between the limits with as many decimals as all of them need. */
export function tick_labels(numbers: readonly number[]): string[] {
  const [first, second] = numbers;
  if (first === undefined) return [];
  const step = second === undefined ? Math.abs(first) : Math.abs(second - first);
  const size = Math.max(...numbers.map(Math.abs));
  if (size >= 1e9 || (size > 0 && step < 1e-9))
    return numbers.map((each) => format_number(each, 6));
  const decimals =
    Array.from({ length: 12 }, (_, n) => n).find(
      (n) => Math.abs(step * 10 ** n - Math.round(step * 10 ** n)) < 1e-6 * 10 ** n * step,
    ) ?? 11;
  return numbers.map((each) => format_fixed(each === 0 ? 0 : each, decimals));
}

export function make_plot({ parts, y_unit, equal, width, height }: PlotOf): Plot {
  const known = parts.flat().filter((each): each is { x: number; y: number } => each.y !== null);
  const x_max = Math.max(...parts.flat().map(({ x }) => x), 0) || 1e-9;
  const [low, high] = range_of(
    known.map(({ y }) => y),
    y_unit === null ? x_max * kLeastSlope : null,
  );
  const of_lengths = y_unit === null;
  const as_high = equal && of_lengths;

  const largest = Math.max(Math.abs(low), Math.abs(high));
  const x_length = length_unit(as_high ? Math.max(x_max, largest) : x_max);
  const y_length = as_high ? x_length : length_unit(largest);
  const x_factor = x_length.per_metre;
  const y_factor = of_lengths ? y_length.per_metre : 1;

  const [top, bottom, right] = [
    kTop_px,
    Math.max(kTop_px + 1, height - kBottom_px),
    width - kRight_px,
  ];
  const most_y = Math.max(2, Math.floor((bottom - top) / kTickSpace_px.y) + 1);
  const left_of = (limits: readonly [number, number]): number => {
    const labels = tick_labels(ticks(limits[0] * y_factor, limits[1] * y_factor, most_y));
    return Math.ceil(Math.max(0, ...labels.map((label) => label.length)) * kCharacter_px) + 12;
  };
  const limits_of = (left: number): { x: number; y: readonly [number, number] } => {
    if (!as_high) return { x: x_max, y: [low, high] };
    const scale = Math.min((right - left) / x_max, (bottom - top) / (high - low)); // pixels a metre
    const [middle, half] = [(low + high) / 2, (bottom - top) / scale / 2];
    return { x: (right - left) / scale, y: [middle - half, middle + half] };
  };
  let left = left_of([low, high]);
  let limits = limits_of(left);
  if (left_of(limits.y) !== left) {
    left = left_of(limits.y); // labels of the wider range may be longer
    limits = limits_of(left);
  }
  const [y_min, y_max] = limits.y;

  const x_at = (x: number): number => left + (x / limits.x) * (right - left);
  const y_at = (y: number): number => bottom - ((y - y_min) / (y_max - y_min)) * (bottom - top);
  const axis = (
    unit: string,
    factor: number,
    min: number,
    max: number,
    most: number,
    at: (each: number) => number,
  ): PlotAxis => {
    const found = ticks(min * factor, max * factor, most);
    const labels = tick_labels(found);
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
      x_length.unit,
      x_factor,
      0,
      x_max,
      Math.max(2, Math.floor((x_at(x_max) - left) / kTickSpace_px.x) + 1),
      x_at,
    ),
    y: axis(y_unit ?? y_length.unit, y_factor, y_min, y_max, most_y, y_at),
    curves: parts.flatMap((part) => runs_of(part).map((run) => path_of(run, x_at, y_at))),
    breaks: parts.slice(1).flatMap((part) => (part[0] ? [x_at(part[0].x)] : [])),
    x_at,
    y_at,
    x_of: (pixel) => ((pixel - left) / (right - left)) * limits.x,
  };
}

/**
 * A little wider than the numbers. Where they differ by less than `noise`, so wide that they look
 * alike.
 */
function range_of(numbers: readonly number[], noise: number | null): [number, number] {
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

function runs_of(part: readonly PlotPoint[]): { x: number; y: number }[][] {
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

/** A single point is seen, too, as the ends of its line are round. */
function path_of(
  run: readonly { x: number; y: number }[],
  x_at: (x: number) => number,
  y_at: (y: number) => number,
): string {
  const points = run.map(({ x, y }) => `${x_at(x).toFixed(2)} ${y_at(y).toFixed(2)}`);
  return `M${points.join("L")}${points.length === 1 ? "h0.01" : ""}`;
}

/** Which of the places, by their x in ascending order, is nearest. */
export function nearest_index(xs: readonly number[], x: number): number {
  let [low, high] = [0, xs.length - 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (xs[middle]! < x) low = middle + 1;
    else high = middle;
  }
  return low > 0 && x - xs[low - 1]! < xs[low]! - x ? low - 1 : low;
}
