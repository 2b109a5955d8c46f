// Formats lengths, areas and numbers, and computes the smallest detail that a layer can store.

import { formatCount, pageLocale, typedNumber, withDecimalSign } from "../core/locale";
import type { Atlas, Model, Unit } from "../core/types";

export const metresPer = (unit: Unit): number => ({ mm: 0.001, cm: 0.01, m: 1 })[unit];

/** Formats a number with about three significant digits. Common magnitudes have no exponent. */
export function formatNumber(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e9 || size < 1e-5) return withDecimalSign(value.toExponential(digits - 1));
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toLocaleString(pageLocale(), { maximumFractionDigits: Math.min(decimals, 20) });
}

/** Returns a suitable unit for a length, and the number of these units in a meter. */
export function lengthUnit(metres: number): { unit: string; perMetre: number } {
  const size = Math.abs(metres);
  if (size > 0 && size < 1e-5) return { unit: "µm", perMetre: 1e6 };
  if (size < 0.01) return { unit: "mm", perMetre: 1e3 };
  if (size < 1) return { unit: "cm", perMetre: 100 };
  return size < 1000 ? { unit: "m", perMetre: 1 } : { unit: "km", perMetre: 1e-3 };
}

function lengthText(metres: number, digits: number): string {
  const { unit, perMetre } = lengthUnit(metres);
  return `${formatNumber(metres * perMetre, digits)} ${unit}`;
}

function areaText(squareMetres: number, digits: number): string {
  const size = Math.abs(squareMetres);
  if (size === 0) return "0 mm²";
  if (size < 1e-4) return `${formatNumber(squareMetres * 1e6, digits)} mm²`;
  if (size < 0.1) return `${formatNumber(squareMetres * 1e4, digits)} cm²`;
  return `${formatNumber(squareMetres, digits)} m²`;
}

/** Formats a length in meters with a suitable unit, such as "0.8 mm", "12.4 cm" or "3.1 m". */
export const formatLength = (metres: number): string =>
  lengthText(metres, Math.abs(metres) < 0.01 ? 2 : 3);
export const formatArea = (squareMetres: number): string => areaText(squareMetres, 3);

export const kMeasuredDigits = 4;
/** Formats a measured length, such as "12.43 cm". */
export const measuredLength = (metres: number): string => lengthText(metres, kMeasuredDigits);
export const measuredArea = (squareMetres: number): string =>
  areaText(squareMetres, kMeasuredDigits);

/** Formats the lengths of three sides with one unit, such as "105 × 99 × 91 mm". */
export function formatSize(sidesInMetres: readonly number[]): string {
  const largest = Math.max(...sidesInMetres);
  const [factor, unit] = largest < 1 ? [1000, "mm"] : largest < 10 ? [100, "cm"] : [1, "m"];
  const side = (metres: number): string => {
    const value = metres * factor;
    return value >= 100 ? formatCount(Math.round(value)) : formatNumber(value);
  };
  return `${sidesInMetres.map(side).join(" × ")} ${unit}`;
}

/**
 * Returns the unit and up axis that the page suggests. Until a user confirms them, the server's
 * proposal applies to each value that was not set at the import.
 */
export function likelyScale(
  model: Pick<Model, "unit" | "unit_assumed" | "scale_verified" | "up" | "proposal">,
): Pick<Model, "unit" | "up"> {
  const { proposal } = model;
  if (model.scale_verified || !proposal) return { unit: model.unit, up: model.up };
  return {
    unit: model.unit_assumed ? proposal.unit : model.unit,
    up: model.up === kUpWithoutProposal ? proposal.up : model.up,
  };
}
// The up axis of models for which the import set no up axis and requested no proposal.
const kUpWithoutProposal = "z";

export function formatBytes(bytes: number): string {
  if (bytes < 1e6) return `${formatNumber(bytes / 1e3)} kB`;
  if (bytes < 1e9) return `${formatNumber(bytes / 1e6)} MB`;
  return `${formatNumber(bytes / 1e9)} GB`;
}

export interface DetailChoice {
  resolution: number;
  detailM: number; // side of the smallest area that can be painted everywhere
}

/** Returns the choices for the "smallest detail" of a new layer, the coarsest first. */
export function detailChoices(
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
      detailM: measured
        ? Math.sqrt(measured.area_max_m2)
        : (Math.sqrt(atlas.texel_area_max_m2) * atlas.lowest_resolution) / resolution,
    });
  }
  return choices;
}

/** Returns a round length (1, 2 or 5 × 10ⁿ meters) of at most `maxPx` pixels. */
export function scaleBar(
  metresPerPx: number,
  maxPx: number,
): { metres: number; px: number; label: string } {
  const longest = metresPerPx * maxPx;
  const power = Math.pow(10, Math.floor(Math.log10(longest)));
  const factor = longest / power >= 5 ? 5 : longest / power >= 2 ? 2 : 1;
  const metres = factor * power;
  return { metres, px: metres / metresPerPx, label: formatLength(metres) };
}

/** Returns at most `most` round numbers between the limits. */
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

/** Returns a share of an area such as "98.2 %", for reports. */
export const shareText = (part: number, whole: number): string =>
  whole > 0 ? `${formatNumber((100 * part) / whole, 3)} %` : "–";

/** Returns the direction of north in degrees for a field, or as another program wrote it. */
export const typedNorth = ({ north }: Pick<Model, "north">): string =>
  north === "" || Number.isNaN(Number(north)) ? north : typedNumber(Number(north));
