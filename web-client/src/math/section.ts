// Planes that cut a model open, from a user's choice: a cut across one axis, or a box. Positions
// are shares of the model's bounds, so that they have the same meaning for a coin and a quarry.
// Other planes come from named views and are not changed.

import type { Bounds } from "./camera";
import type { Plane } from "../core/protocol.gen";

export type Axis = "x" | "y" | "z";
export type SectionMode = "off" | Axis | "box" | "planes";

export interface SectionChoice {
  mode: SectionMode;
  position: number; // of a cut, 0…1
  flipped: boolean; // the other side is kept
  box: { min: [number, number, number]; max: [number, number, number] }; // 0…1
  planes: Plane[]; // unchanged, for the mode "planes"
}

export const kAxes: readonly Axis[] = ["x", "y", "z"];
/** Smallest share of the model that remains in a box. */
export const kThinnestBox = 0.01;
const kRounded = 1e-9; // rounding error of a share in world coordinates

export const noSection = (): SectionChoice => ({
  mode: "off",
  position: 0.5,
  flipped: false,
  box: { min: [0, 0, 0], max: [1, 1, 1] },
  planes: [],
});

/** A position in the world on an axis. */
export function worldPosition(bounds: Bounds, axis: number, share: number): number {
  return bounds.min[axis]! + (bounds.max[axis]! - bounds.min[axis]!) * share;
}

/** [a, b, c, d] keeps the half space a x + b y + c z + d ≥ 0. */
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
 * The choice for these planes: a cut or a box within the bounds where possible, else the planes
 * themselves.
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

/** For a plane across an axis and through the bounds; null: any other plane. */
function sideOf(
  [a, b, c, d]: Plane,
  { min, max }: Bounds,
): { axis: number; share: number; keepsAbove: boolean } | null {
  const normal = [a, b, c];
  const axis = normal.findIndex((part) => part !== 0);
  if (axis < 0 || normal.filter((part) => part !== 0).length > 1) return null;
  const share = (-d / normal[axis]! - min[axis]!) / (max[axis]! - min[axis]!);
  // also for a flat model, where it is NaN
  if (!(share >= -kRounded && share <= 1 + kRounded)) return null;
  return { axis, share: Math.min(1, Math.max(0, share)), keepsAbove: normal[axis]! > 0 };
}

/** A side of the box moved to a share, never past the opposite side. */
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
