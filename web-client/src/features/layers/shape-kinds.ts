// The values that can be computed from a model's shape, in terms of users who study it.

import { readNumber } from "../../core/locale";
import type { Model, ShapeRecipe } from "../../core/types";
import { texts } from "../../texts";

/** The number of rays per point for ambient occlusion. */
export const kRays = { least: 16, most: 1024, usual: 64 } as const;

export type ShapeKind = ShapeRecipe["kind"];

export interface ShapeKindInfo {
  kind: ShapeKind;
  title: string;
  lead: string;
  /** The parameters that this kind requires. */
  takes: readonly (
    | ShapeLength
    | SunAngle
    | RainNumber
    | "months"
    | "wind_shares"
    | "rays"
    | "absolute"
    | "model"
    | "property"
    | "look"
  )[];
}

/** The lengths in millimeters that users can enter. */
export type ShapeLength = "radius" | "distance" | "normal" | "projection" | "registration";

/** The angles in degrees that users can enter. */
export type SunAngle = "latitude" | "north";
export const kSunAngles = { latitude: 90, north: 360 } as const; // the largest values

/** The numbers of the climate that users can enter, with their least and largest values. */
export const kRainNumbers = {
  wind_speed_m_s: { least: 0, most: 100, unit: "m/s" },
  rain_mm: { least: 0.1, most: 100_000, unit: "mm" },
  rain_mm_per_hour: { least: 0.01, most: 1000, unit: "mm/h" },
} as const;
export type RainNumber = keyof typeof kRainNumbers;
export const kRain = Object.keys(kRainNumbers) as readonly RainNumber[];

const kRainTakes = ["north", "wind_shares", ...kRain] as const;
const kSunTakes = ["latitude", "north", "months"] as const;
const kChangeTakes = ["model", "registration", "projection", "normal", "distance"] as const;

const words = texts.shape.kinds;

export const kShapeGroups: readonly { title: string; kinds: readonly ShapeKindInfo[] }[] = [
  {
    title: texts.shape.groups.form,
    kinds: [
      { kind: "mean_curvature", ...words.mean_curvature, takes: ["radius"] },
      { kind: "gaussian_curvature", ...words.gaussian_curvature, takes: ["radius"] },
      { kind: "max_curvature", ...words.max_curvature, takes: ["radius"] },
      { kind: "min_curvature", ...words.min_curvature, takes: ["radius"] },
      { kind: "roughness", ...words.roughness, takes: ["radius"] },
      { kind: "ambient_occlusion", ...words.ambient_occlusion, takes: ["distance", "rays"] },
    ],
  },
  {
    title: texts.shape.groups.place,
    kinds: [
      { kind: "height", ...words.height, takes: ["absolute"] },
      { kind: "slope", ...words.slope, takes: [] },
      { kind: "azimuth", ...words.azimuth, takes: [] },
      { kind: "part", ...words.part, takes: [] },
    ],
  },
  {
    title: texts.shape.groups.distance,
    kinds: [
      { kind: "boundary_distance", ...words.boundary_distance, takes: [] },
      { kind: "model_distance", ...words.model_distance, takes: ["model", "distance"] },
    ],
  },
  {
    title: texts.shape.groups.change,
    kinds: [
      { kind: "change", ...words.change, takes: kChangeTakes },
      { kind: "significant_change", ...words.significant_change, takes: kChangeTakes },
      { kind: "level_of_detection", ...words.level_of_detection, takes: kChangeTakes },
    ],
  },
  {
    title: texts.shape.groups.sun,
    kinds: [
      { kind: "sun_hours", ...words.sun_hours, takes: kSunTakes },
      { kind: "sun_energy", ...words.sun_energy, takes: kSunTakes },
    ],
  },
  {
    title: texts.shape.groups.rain,
    kinds: [{ kind: "driving_rain", ...words.driving_rain, takes: kRainTakes }],
  },
  {
    title: texts.shape.groups.color,
    kinds: [{ kind: "lightness", ...words.lightness, takes: ["look"] }],
  },
  {
    title: texts.shape.groups.file,
    kinds: [{ kind: "vertex_property", ...words.vertex_property, takes: ["property"] }],
  },
];

export const shapeKind = (kind: ShapeKind): ShapeKindInfo =>
  kShapeGroups.flatMap((group) => group.kinds).find((info) => info.kind === kind)!;

/** The first and the last month of a period, from 1 to 12. */
export interface Months {
  from: number;
  to: number;
}

/** The user's input, as texts. */
export interface ShapeInput extends Record<ShapeLength | SunAngle | RainNumber, string> {
  kind: ShapeKind;
  months: Months;
  wind_shares: string;
  rays: string;
  absolute: boolean;
  model: string;
  property: string; // in the format "source/property"
  look: string; // id of the surface image, or empty for the visible colors
}

/** Returns the recipe, or the problem of the input. Omits parameters of other kinds. */
export function recipeOf(input: ShapeInput): ShapeRecipe | { problem: string; field: string } {
  const { takes } = shapeKind(input.kind);
  const recipe: ShapeRecipe = { kind: input.kind };
  for (const [name, member] of [
    ["radius", "radius_mm"],
    ["distance", "distance_mm"],
    ["normal", "normal_scale_mm"],
    ["projection", "projection_scale_mm"],
    ["registration", "registration_mm"],
  ] as const) {
    const text = input[name];
    if (!takes.includes(name) || text.trim() === "") continue;
    const value = readNumber(text);
    if (!(value > 0) && !(name === "registration" && value === 0))
      return { problem: texts.shape.bad_length, field: name };
    recipe[member] = value;
  }
  for (const name of ["latitude", "north"] as const) {
    const text = input[name];
    if (!takes.includes(name) || (name === "north" && text.trim() === "")) continue;
    const value = readNumber(text);
    const most = kSunAngles[name];
    if (!(Math.abs(value) <= most)) return { problem: texts.shape.sun[name].wrong, field: name };
    recipe[`${name}_deg`] = value;
  }
  if (takes.includes("months")) {
    const { from, to } = input.months;
    recipe.from = `${twoDigits(from)}-01`;
    recipe.to = `${twoDigits(to)}-${kDaysOfMonth[to - 1]}`;
  }
  if (takes.includes("wind_shares")) {
    const shares = windShares(input.wind_shares);
    if (!shares) return { problem: texts.shape.rain.wind_shares.wrong, field: "wind_shares" };
    recipe.wind_shares = shares;
  }
  for (const name of kRain) {
    const text = input[name];
    if (!takes.includes(name) || (name === "rain_mm_per_hour" && text.trim() === "")) continue;
    const value = readNumber(text);
    const { least, most } = kRainNumbers[name];
    if (!(value >= least && value <= most))
      return { problem: texts.shape.rain[name].wrong, field: name };
    recipe[name] = value;
  }
  if (takes.includes("rays") && input.rays.trim() !== "") {
    const rays = readNumber(input.rays);
    const { least, most } = kRays;
    if (!Number.isInteger(rays) || rays < least || rays > most)
      return { problem: texts.shape.bad_rays(least, most), field: "rays" };
    recipe.rays = rays;
  }
  if (takes.includes("absolute") && input.absolute) recipe.absolute = true;
  if (takes.includes("model")) {
    if (!input.model) return { problem: texts.shape.model_missing, field: "model" };
    recipe.model = input.model;
  }
  if (takes.includes("look") && input.look) recipe.look = input.look;
  if (takes.includes("property")) {
    // only the name of a property can contain slashes, not the source
    const slash = input.property.indexOf("/");
    if (slash < 0) return { problem: texts.shape.property_missing, field: "property" };
    recipe.source = input.property.slice(0, slash);
    recipe.property = input.property.slice(slash + 1);
  }
  return recipe;
}

/** Returns 8 or 16 numbers from a text that separates them by spaces or semicolons. */
function windShares(text: string): number[] | undefined {
  const shares = text
    .split(/[\s;]+/)
    .filter((part) => part !== "")
    .map(readNumber);
  const isRose = shares.length === 8 || shares.length === 16;
  return isRose && shares.every((share) => share >= 0) && shares.some((share) => share > 0)
    ? shares
    : undefined;
}

const kDaysOfMonth = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] as const;
const twoDigits = (number: number): string => String(number).padStart(2, "0");

/**
 * Returns the models that this one can be compared with. Surveys of the same object are first, the
 * newest survey before this one at the top. The other models of this model's project follow.
 */
export function otherModels(all: readonly Model[], model: Model): Model[] {
  const others = all.filter((other) => other.id !== model.id);
  const dateOf = (each: Model): string => each.survey_date ?? "";
  const rank = (other: Model): number => {
    if (model.object !== undefined && other.object === model.object)
      return dateOf(other) < dateOf(model) ? 0 : 1;
    return other.project === model.project ? 2 : 3;
  };
  return others.sort((a, b) => {
    const ranks = rank(a) - rank(b);
    if (ranks !== 0 || rank(a) > 1) return ranks;
    return dateOf(b).localeCompare(dateOf(a));
  });
}
