// Planes that cut a model open, from what a person chooses: a cut across one axis, or a box. Positions are shares of the
// model's bounds, so that they mean the same for a coin and for a quarry.

import type { Bounds } from "./camera";
import type { Plane } from "./protocol.gen";

export type Axis = "x" | "y" | "z";
export type SectionMode = "off" | Axis | "box";

export interface SectionChoice {
  mode: SectionMode;
  position: number; // of a cut, 0…1
  flipped: boolean; // the other side is kept
  box: { min: [number, number, number]; max: [number, number, number] }; // 0…1
}

export const kAxes: readonly Axis[] = ["x", "y", "z"];
/** So much of the model stays in a box at least. */
export const kThinnestBox = 0.01;

export const no_section = (): SectionChoice => ({
  mode: "off",
  position: 0.5,
  flipped: false,
  box: { min: [0, 0, 0], max: [1, 1, 1] },
});

/** A position in the world on an axis. */
export function world_position(bounds: Bounds, axis: number, share: number): number {
  return bounds.min[axis]! + (bounds.max[axis]! - bounds.min[axis]!) * share;
}

/** [a, b, c, d] keeps what has a x + b y + c z + d ≥ 0. */
export function section_planes(choice: SectionChoice, bounds: Bounds): Plane[] {
  const plane = (axis: number, share: number, keeps_above: boolean): Plane => {
    const sign = keeps_above ? 1 : -1;
    const result: Plane = [0, 0, 0, -sign * world_position(bounds, axis, share)];
    result[axis] = sign;
    return result;
  };
  if (choice.mode === "off") return [];
  if (choice.mode !== "box") return [plane(kAxes.indexOf(choice.mode), choice.position, choice.flipped)];
  const planes: Plane[] = [];
  for (const axis of [0, 1, 2]) {
    if (choice.box.min[axis]! > 0) planes.push(plane(axis, choice.box.min[axis]!, true));
    if (choice.box.max[axis]! < 1) planes.push(plane(axis, choice.box.max[axis]!, false));
  }
  return planes;
}

/** A side of the box moved to a share, never past the opposite side. */
export function with_box_side(choice: SectionChoice, side: "min" | "max", axis: number, share: number): SectionChoice {
  const box = { min: [...choice.box.min], max: [...choice.box.max] } as SectionChoice["box"];
  box[side][axis] =
    side === "min"
      ? Math.max(0, Math.min(share, box.max[axis]! - kThinnestBox))
      : Math.min(1, Math.max(share, box.min[axis]! + kThinnestBox));
  return { ...choice, box };
}
