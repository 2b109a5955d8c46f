// Colors of values according to the server's palette, for legends and swatches.

import type { CellValue } from "../core/protocol.gen";
import type { Layer, Palette, PalettePoint, ValueType } from "../core/types";

export interface Rgba {
  r: number;
  g: number;
  b: number;
  a: number; // 0…255, like r, g and b
}

export function parseColor(text: string): Rgba {
  const hex = text.replace("#", "");
  const byte = (at: number): number => parseInt(hex.slice(at, at + 2), 16);
  return { r: byte(0), g: byte(2), b: byte(4), a: hex.length >= 8 ? byte(6) : 255 };
}

export const cssColor = (text: string): string => {
  const { r, g, b, a } = parseColor(text);
  return `rgb(${r} ${g} ${b} / ${(a / 255).toFixed(3)})`;
};

/** Returns #rrggbb for an <input type="color">, which has no opacity. */
export const opaqueColor = (text: string): string => text.slice(0, 7);

/** Returns the CSS gradient of a linear or stepped palette, from its lower to its upper limit. */
export function cssGradient(palette: Palette, direction = "to right"): string {
  const span = palette.max - palette.min || 1;
  const points = [...palette.points].sort((a, b) => a.at - b.at);
  if (points.length === 0) return "transparent";
  const share = (at: number): string =>
    `${(Math.min(1, Math.max(0, (at - palette.min) / span)) * 100).toFixed(2)}%`;
  const stops: string[] = [];
  points.forEach((point, index) => {
    stops.push(`${cssColor(point.color)} ${share(point.at)}`);
    const next = points[index + 1];
    if (palette.mode === "step" && next) stops.push(`${cssColor(point.color)} ${share(next.at)}`);
  });
  if (stops.length === 1) stops.push(stops[0]!.replace(/ [\d.]+%$/, " 100%"));
  return `linear-gradient(${direction}, ${stops.join(", ")})`;
}

export function pointOf(palette: Palette, value: number): PalettePoint | undefined {
  return palette.points.find((point) => point.at === value);
}

/**
 * Returns the color of a class that the palette does not list. The server computes the same color.
 */
export function generatedColor(key: number): string {
  const hash = Math.imul(key, 2654435761) >>> 0;
  const hue = ((hash >>> 8) / 16777216) * 6;
  const saturation = 0.55 + (0.25 * (hash & 0xff)) / 255;
  const channel = (offset: number): string => {
    const k = (offset + hue) % 6;
    const value = 0.85 - 0.85 * saturation * Math.min(1, Math.max(0, Math.min(k, 4 - k)));
    return Math.round(value * 255)
      .toString(16)
      .padStart(2, "0");
  };
  return `#${channel(5)}${channel(3)}${channel(1)}ff`;
}

// The server's color of records without a value in the coloring column.
export const kNoValueColor = "#9a9a9a80";

/**
 * Returns the color of a value. Returns null if the palette has no colors, or if the color depends
 * on the record with this key.
 */
export function colorOf(palette: Palette, value: number): string | null {
  if (palette.column) return null;
  return colorOfNumber(palette, value);
}

/** Returns the color of a record, from the coloring column or from its key. */
export function recordColor(
  palette: Palette,
  record: { key: number; values: Record<string, CellValue> },
): string | null {
  if (!palette.column) return colorOf(palette, record.key);
  const value = record.values[palette.column] ?? null;
  if (value === null) return palette.others ?? kNoValueColor;
  const named = palette.points.find((point) => point.value === String(value));
  if (named) return named.color;
  if (palette.mode === "categorical" && (typeof value !== "number" || !pointOf(palette, value)))
    return palette.others ?? kNoValueColor;
  return typeof value === "number" ? colorOfNumber(palette, value) : null;
}

function colorOfNumber(palette: Palette, value: number): string | null {
  if (palette.mode === "categorical")
    return pointOf(palette, value)?.color ?? palette.others ?? generatedColor(value);
  const points = [...palette.points].sort((a, b) => a.at - b.at);
  const first = points[0];
  const last = points[points.length - 1];
  if (!first || !last) return null;
  const at = Math.min(palette.max, Math.max(palette.min, value));
  if (at <= first.at) return first.color;
  if (at >= last.at) return last.color;
  const above = points.findIndex((point) => point.at > at);
  const low = points[above - 1]!;
  const high = points[above]!;
  if (palette.mode === "step") return low.color;
  const t = (at - low.at) / (high.at - low.at);
  const [a, b] = [parseColor(low.color), parseColor(high.color)];
  const blend = (x: number, y: number): string =>
    Math.round(x + (y - x) * t)
      .toString(16)
      .padStart(2, "0");
  return `#${blend(a.r, b.r)}${blend(a.g, b.g)}${blend(a.b, b.b)}${blend(a.a, b.a)}`;
}

export type LayerPurpose = "presence" | "classes" | "measurement" | "records";
/** The type of the values in a layer for this purpose. */
export const kTypeOfPurpose: Readonly<Record<LayerPurpose, ValueType>> = {
  presence: "u8",
  classes: "u8",
  measurement: "f32",
  records: "u32",
};

/** Returns the purpose of a layer, as named in the dialog that creates layers. */
export function purposeOf(layer: Pick<Layer, "kind" | "palette">): LayerPurpose {
  if (layer.kind === "database") return "records";
  if (layer.palette.mode !== "categorical") return "measurement";
  return layer.palette.points.length === 1 ? "presence" : "classes";
}

/** Returns whether the layer has classes, or records with columns. */
export const canBeColored = (layer: Layer): boolean =>
  layer.table !== undefined ||
  layer.palette.mode === "step" ||
  (layer.palette.mode === "categorical" && layer.palette.points.length > 0);

// The colors of Okabe and Ito, and two more colors. Users with color blindness can distinguish
// them.
export const kClassColors = [
  "#e69f00ff",
  "#56b4e9ff",
  "#009e73ff",
  "#f0e442ff",
  "#0072b2ff",
  "#d55e00ff",
  "#cc79a7ff",
  "#8c6d46ff",
  "#7f7f9fff",
];

export const presencePalette = (label: string, color: string): Palette => ({
  mode: "categorical",
  min: 1,
  max: 1,
  points: [{ at: 1, color, label }],
});

/** Returns a palette without points. The color of each key is generated from the key. */
export const recordPalette = (): Palette => ({ mode: "categorical", min: 0, max: 1, points: [] });

/** Returns all members of a point, with defaults for absent members. */
const told = ({
  at,
  color,
  label = "",
  value = "",
  pattern = "solid",
  angle = 45,
  spacing_mm: spacingMm = 0,
}: PalettePoint): string => JSON.stringify([at, color, label, value, pattern, angle, spacingMm]);

/** Whether both palettes give each value the same color and label. */
export function samePalette(a: Palette, b: Palette): boolean {
  return (
    [a.mode, a.min, a.max, a.column, a.others, a.points.length].join() ===
      [b.mode, b.min, b.max, b.column, b.others, b.points.length].join() &&
    a.points.every((point, index) => told(point) === told(b.points[index]!))
  );
}

/** Returns a copy of the palette with another range of values. */
export function withRange(palette: Palette, min: number, max: number): Palette {
  const span = palette.max - palette.min || 1;
  const points = palette.points.map((point) => ({
    ...point,
    at: min + ((point.at - palette.min) / span) * (max - min),
  }));
  return { ...palette, min, max, points };
}

/** Multiplies the opacity of a color by `share`. */
function withShare(color: string, share: number): string {
  const { a } = parseColor(color);
  return `${opaqueColor(color)}${Math.round(a * share)
    .toString(16)
    .padStart(2, "0")}`;
}

/**
 * Returns the style of a legend's square, which is filled as on the surface. The lengths
 * are the same as in shaders/shared/shade.h.
 */
export function swatchStyle({
  color,
  pattern = "solid",
  angle = 45,
}: Pick<PalettePoint, "color" | "pattern" | "angle">): Record<string, string> {
  const shown = cssColor(color);
  if (pattern === "outline")
    return { background: "transparent", border: `2px solid ${shown}`, "box-shadow": "none" };
  // CSS measures the angle clockwise from the vertical, perpendicular to the lines.
  const ground = cssColor(withShare(color, 0.3));
  const border = { "box-shadow": `inset 0 0 0 2px ${shown}` };
  if (pattern === "hatch")
    return {
      background: `repeating-linear-gradient(${-angle}deg, ${shown} 0 2.8px, ${ground} 2.8px 7px)`,
      ...border,
    };
  if (pattern === "dots")
    return {
      background: `radial-gradient(circle at center, ${shown} 0 2.2px, ${ground} 2.6px) 0 0 / 7px 7px`,
      ...border,
    };
  return { background: shown };
}

/** Returns a palette for the values of a column, in the order of `classes`. */
export function categoryPalette(
  column: string,
  classes: { value: string; label: string; color: string }[],
): Palette {
  return {
    mode: "categorical",
    column,
    min: 0,
    max: Math.max(0, classes.length - 1),
    points: classes.map(({ value, label, color }, at) => ({
      at,
      value,
      color,
      ...(label === "" || label === value ? {} : { label }),
    })),
  };
}

/** Returns a palette for classes of numbers, given by their lower limits. */
export function graduatedPalette(
  column: string,
  classes: { from: number; to: number }[],
  colors: string[],
): Palette {
  const points = classes.map(({ from }, index) => ({
    at: from,
    color: colors[index] ?? colors[colors.length - 1] ?? "#808080ff",
  }));
  return {
    mode: "step",
    column,
    min: classes[0]?.from ?? 0,
    max: classes[classes.length - 1]?.to ?? 1,
    points,
  };
}

/**
 * Color ramps from low to high: viridis, and two ramps for one increasing quantity. Their colors
 * can be distinguished with any color vision and in grayscale.
 */
export const kRamps = {
  viridis: [
    "#440154",
    "#472d7b",
    "#3b528b",
    "#2c728e",
    "#21918c",
    "#28ae80",
    "#5ec962",
    "#addc30",
    "#fde725",
  ],
  reds: [
    "#fff5f0",
    "#fddbca",
    "#fbb499",
    "#fa8a6b",
    "#f55d43",
    "#de2c26",
    "#b91419",
    "#8a0811",
    "#5a040a",
  ],
  blues: [
    "#f7fbff",
    "#dbe9f6",
    "#bcd7ec",
    "#8fc1de",
    "#5ba3cf",
    "#3282be",
    "#1461a8",
    "#08458a",
    "#08306b",
  ],
} as const;
export type Ramp = keyof typeof kRamps;

/** Returns `count` colors that are evenly spaced on the ramp. */
export function rampColors(ramp: Ramp, count: number): string[] {
  const stops = kRamps[ramp];
  const scale: Palette = {
    mode: "linear",
    min: 0,
    max: 1,
    points: stops.map((color, index) => ({ at: index / (stops.length - 1), color: `${color}ff` })),
  };
  return Array.from({ length: count }, (_, index) =>
    colorOfNumber(scale, count === 1 ? 0.5 : index / (count - 1))!,
  );
}

export const classPalette = (classes: { label: string; color: string; at: number }[]): Palette => {
  const points = [...classes]
    .sort((a, b) => a.at - b.at)
    .map(({ at, color, label }) => ({ at, color, label }));
  return {
    mode: "categorical",
    min: points[0]?.at ?? 0,
    max: points[points.length - 1]?.at ?? 1,
    points,
  };
};

export const measurementPalette = (
  min: number,
  max: number,
  mode: "linear" | "step" = "linear",
): Palette => ({
  mode,
  min,
  max,
  points: kRamps.viridis.map((color, index) => ({
    at: min + ((max - min) * index) / (kRamps.viridis.length - (mode === "step" ? 0 : 1)),
    color: `${color}ff`,
  })),
});
