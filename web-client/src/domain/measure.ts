// Lengths, areas and numbers as people write them, and the smallest detail a layer can hold.

import { format_count, page_locale, with_decimal_sign } from "../core/locale";
import type { Atlas, Model, Unit } from "../core/types";

export const metres_per = (unit: Unit): number => ({ mm: 0.001, cm: 0.01, m: 1 })[unit];

/** About three significant digits, without an exponent for everyday sizes. */
export function format_number(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e9 || size < 1e-5) return with_decimal_sign(value.toExponential(digits - 1));
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toLocaleString(page_locale(), { maximumFractionDigits: Math.min(decimals, 20) });
}

/** The unit that suits a length, and how many of it a metre has. */
export function length_unit(metres: number): { unit: string; per_metre: number } {
  const size = Math.abs(metres);
  if (size > 0 && size < 1e-5) return { unit: "µm", per_metre: 1e6 };
  if (size < 0.01) return { unit: "mm", per_metre: 1e3 };
  if (size < 1) return { unit: "cm", per_metre: 100 };
  return size < 1000 ? { unit: "m", per_metre: 1 } : { unit: "km", per_metre: 1e-3 };
}

function length_text(metres: number, digits: number): string {
  const { unit, per_metre } = length_unit(metres);
  return `${format_number(metres * per_metre, digits)} ${unit}`;
}

function area_text(square_metres: number, digits: number): string {
  const size = Math.abs(square_metres);
  if (size === 0) return "0 mm²";
  if (size < 1e-4) return `${format_number(square_metres * 1e6, digits)} mm²`;
  if (size < 0.1) return `${format_number(square_metres * 1e4, digits)} cm²`;
  return `${format_number(square_metres, digits)} m²`;
}

/** A length in metres with the unit that suits its size: "0.8 mm", "12.4 cm", "3.1 m". */
export const format_length = (metres: number): string =>
  length_text(metres, Math.abs(metres) < 0.01 ? 2 : 3);
export const format_area = (square_metres: number): string => area_text(square_metres, 3);

export const kMeasuredDigits = 4;
/** What was measured: "12.43 cm". */
export const measured_length = (metres: number): string => length_text(metres, kMeasuredDigits);
export const measured_area = (square_metres: number): string =>
  area_text(square_metres, kMeasuredDigits);

/** Three sides in one unit, for "105 × 99 × 91 mm". */
export function format_size(sides_in_metres: readonly number[]): string {
  const largest = Math.max(...sides_in_metres);
  const [factor, unit] = largest < 1 ? [1000, "mm"] : largest < 10 ? [100, "cm"] : [1, "m"];
  const side = (metres: number): string => {
    const value = metres * factor;
    return value >= 100 ? format_count(Math.round(value)) : format_number(value);
  };
  return `${sides_in_metres.map(side).join(" × ")} ${unit}`;
}

/**
 * What is asked about a model first: while nobody has confirmed it, what the server proposes where
 * nobody has said otherwise.
 */
export function likely_scale(
  model: Pick<Model, "unit" | "unit_assumed" | "scale_verified" | "up" | "proposal">,
): Pick<Model, "unit" | "up"> {
  const { proposal } = model;
  if (model.scale_verified || !proposal) return { unit: model.unit, up: model.up };
  return {
    unit: model.unit_assumed ? proposal.unit : model.unit,
    up: model.up === kUpWithoutProposal ? proposal.up : model.up,
  };
}
// of models whose importer said nothing and did not ask for the proposal
const kUpWithoutProposal = "z";

export function format_bytes(bytes: number): string {
  if (bytes < 1e6) return `${format_number(bytes / 1e3)} kB`;
  if (bytes < 1e9) return `${format_number(bytes / 1e6)} MB`;
  return `${format_number(bytes / 1e9)} GB`;
}

export interface DetailChoice {
  resolution: number;
  detail_m: number; // side of the smallest spot that can be painted anywhere on the surface
}

/** The choices of "smallest detail" for a new layer, coarsest first. */
export function detail_choices(
  atlas: Pick<Atlas, "lowest_resolution" | "texel_area_max_m2" | "texel_sizes">,
): DetailChoice[] {
  const choices: DetailChoice[] = [];
  for (
    let resolution = Math.max(2048, atlas.lowest_resolution);
    resolution <= 8192;
    resolution *= 2
  ) {
    const measured = atlas.texel_sizes?.find((size) => size.resolution === resolution);
    choices.push({
      resolution,
      detail_m: measured
        ? Math.sqrt(measured.area_max_m2)
        : (Math.sqrt(atlas.texel_area_max_m2) * atlas.lowest_resolution) / resolution,
    });
  }
  return choices;
}

/** A round length (1, 2 or 5 × 10ⁿ metres) of at most `max_px` pixels. */
export function scale_bar(
  metres_per_px: number,
  max_px: number,
): { metres: number; px: number; label: string } {
  const longest = metres_per_px * max_px;
  const power = Math.pow(10, Math.floor(Math.log10(longest)));
  const factor = longest / power >= 5 ? 5 : longest / power >= 2 ? 2 : 1;
  const metres = factor * power;
  return { metres, px: metres / metres_per_px, label: format_length(metres) };
}

/** Round numbers between the limits, at most `most` of them. */
export function ticks(min: number, max: number, most = 5): number[] {
  const span = max - min;
  if (!(span > 0)) return [min];
  const rough = span / Math.max(1, most - 1);
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 2.5, 5, 10]
    .map((factor) => factor * power)
    .find((candidate) => candidate >= rough * 0.999)!;
  const found: number[] = [];
  for (let index = Math.ceil(min / step - 1e-9); index * step <= max + step * 1e-9; ++index) {
    found.push(Number((index * step).toPrecision(12)));
  }
  return found;
}
