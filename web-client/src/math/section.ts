// Planes that cut a model open, from a user's choice: a cut across one axis, or a box. Positions
// are fractions of the model's bounds, so they have the same meaning for a coin and a quarry. Other
// planes come from saved views and are not changed.

import type { Bounds } from "./camera";
import type { Plane } from "../core/protocol.gen";

export type Axis = "x" | "y" | "z";
export type SectionMode = "off" | Axis | "box" | "planes";

export interface SectionChoice {
  mode: SectionMode;
  position: number; // position of a cut, 0…1
  flipped: boolean; // the cut keeps the other side
  box: { min: [number, number, number]; max: [number, number, number] }; // fractions, 0…1
  planes: Plane[]; // unchanged planes, for the mode "planes"
}

export const kAxes: readonly Axis[] = ["x", "y", "z"];
/** The smallest fraction of the model that remains in a box. */
export const kThinnestBox = 0.01;
const kRounded = 1e-9; // rounding error of a fraction in world coordinates

export const noSection = (): SectionChoice => ({
  mode: "off",
  position: 0.5,
  flipped: false,
  box: { min: [0, 0, 0], max: [1, 1, 1] },
  planes: [],
});

/** Returns the world position on an axis for a fraction of the bounds. */
export function worldPosition(bounds: Bounds, axis: number, share: number): number {
  return bounds.min[axis]! + (bounds.max[axis]! - bounds.min[axis]!) * share;
}

/**
 * Returns the planes of a choice. A plane [a, b, c, d] keeps the half-space a x + b y + c z + d ≥
 * 0.
 */
export function sectionPlanes(choice: SectionChoice, bounds: Bounds): Plane[] {
  const plane = (axis: number, share: number, keepsAbove: boolean): Plane => {
    const sign = keepsAbove ? 1 : -1;
    const result: Plane = [0, 0, 0, -sign * worldPosition(bounds, axis, share)];
    result[axis] = sign;
    return result;
  };
  if (choice.mode === "off") return [];
  if (choice.mode === "planes") return choice.planes;
  if (choice.mode !== "box")
    return [plane(kAxes.indexOf(choice.mode), choice.position, choice.flipped)];
  const planes: Plane[] = [];
  for (const axis of [0, 1, 2]) {
    if (choice.box.min[axis]! > 0) planes.push(plane(axis, choice.box.min[axis]!, true));
    if (choice.box.max[axis]! < 1) planes.push(plane(axis, choice.box.max[axis]!, false));
  }
  return planes;
}

/**
 * Returns the choice for these planes. If possible, it is a cut or a box within the bounds.
 * Otherwise it keeps the planes.
 */
export function sectionChoice(planes: readonly Plane[], bounds: Bounds): SectionChoice {
  if (planes.length === 0) return noSection();
  const kept: SectionChoice = { ...noSection(), mode: "planes", planes: [...planes] };
  const sides = planes.map((plane) => sideOf(plane, bounds));
  const [first] = sides;
  if (sides.length === 1 && first)
    return {
      ...noSection(),
      mode: kAxes[first.axis]!,
      position: first.share,
      flipped: first.keepsAbove,
    };
  const { box } = noSection();
  const taken = new Set<string>();
  for (const side of sides) {
    const key = `${side?.axis} ${side?.keepsAbove}`;
    if (!side || taken.has(key)) return kept;
    taken.add(key);
    box[side.keepsAbove ? "min" : "max"][side.axis] = side.share;
  }
  const isInsideOut = [0, 1, 2].some((axis) => box.min[axis]! >= box.max[axis]!);
  return isInsideOut ? kept : { ...noSection(), mode: "box", box };
}

/**
 * Returns the position of a plane that crosses an axis within the bounds, or null for any other
 * plane.
 */
function sideOf(
  [a, b, c, d]: Plane,
  { min, max }: Bounds,
): { axis: number; share: number; keepsAbove: boolean } | null {
  const normal = [a, b, c];
  const axis = normal.findIndex((part) => part !== 0);
  if (axis < 0 || normal.filter((part) => part !== 0).length > 1) return null;
  const share = (-d / normal[axis]! - min[axis]!) / (max[axis]! - min[axis]!);
  // For a flat model, the fraction is NaN.
  if (!(share >= -kRounded && share <= 1 + kRounded)) return null;
  return { axis, share: Math.min(1, Math.max(0, share)), keepsAbove: normal[axis]! > 0 };
}

/** Moves a side of the box to a fraction of the bounds, but never past the opposite side. */
export function withBoxSide(
  choice: SectionChoice,
  side: "min" | "max",
  axis: number,
  share: number,
): SectionChoice {
  const box: SectionChoice["box"] = { min: [...choice.box.min], max: [...choice.box.max] };
  box[side][axis] =
    side === "min"
      ? Math.max(0, Math.min(share, box.max[axis]! - kThinnestBox))
      : Math.min(1, Math.max(share, box.min[axis]! + kThinnestBox));
  return { ...choice, box };
}
