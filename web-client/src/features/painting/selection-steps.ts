// The steps that make up a selection, and their format in the contract. A step combines a part with
// the area so far, or changes the border of the area so far. Converting the steps only when a
// request is sent keeps each of them removable.

import type { Combination, Within, WithinPart } from "../../core/protocol.gen";

export interface SelectionPart {
  combine: Combination;
  within: Within;
  /** Whether the user can move the corners of the outline. */
  corners?: boolean;
}

export type BorderChange = Pick<Within, "grow_mm" | "smooth_mm">;

export type SelectionStep = SelectionPart | BorderChange;

/** A part with one outline. */
export type OutlinePart = SelectionPart & { within: Required<Pick<Within, "camera" | "path">> };

export const kMostParts = 32;
export const kMostMm = 1000; // by which a selection can grow or be smoothed
const kMostDepth = 4;
const kMostCorners = 64; // an outline with more points was drawn with the lasso

export const isPart = (step: SelectionStep): step is SelectionPart => "within" in step;

export const isOutline = (step: SelectionStep): step is OutlinePart =>
  isPart(step) && step.within.path !== undefined && !step.within.steps && !isChanged(step.within);

const isChanged = ({ grow_mm: grow, smooth_mm: smooth }: BorderChange): boolean =>
  grow !== undefined || smooth !== undefined;

/** Returns the selected area in the contract's format, or null without a part. */
export function withinOf(steps: readonly SelectionStep[]): Within | null {
  let parts: SelectionPart[] = [];
  let change: BorderChange = {};
  const close = (): void => {
    parts = [{ combine: "add", within: joined(parts, change) }];
    change = {};
  };
  for (const step of steps) {
    if (isPart(step)) {
      if (isChanged(change)) close();
      // Nothing precedes the first part.
      parts.push(parts.length === 0 ? { ...step, combine: "add" } : step);
    } else if (parts.length > 0) {
      const both = merged(change, step);
      if (!both) close();
      change = both ?? step;
    }
  }
  return parts.length === 0 ? null : joined(parts, change);
}

/**
 * Returns one change with the effect of two, or null if no such change exists. The server smooths an
 * area after growing it. Two steps that both grow the area grow it by their sum, but growing and
 * then shrinking closes gaps.
 */
function merged(change: BorderChange, next: BorderChange): BorderChange | null {
  const { grow_mm: grow, smooth_mm: smooth } = change;
  if (smooth !== undefined) return null;
  if (grow === undefined || next.grow_mm === undefined) return { ...change, ...next };
  const sum = grow + next.grow_mm;
  return grow * next.grow_mm > 0 && Math.abs(sum) <= kMostMm ? { grow_mm: sum } : null;
}

function joined(parts: readonly SelectionPart[], change: BorderChange): Within {
  const [first, ...rest] = parts as [SelectionPart, ...SelectionPart[]];
  if (rest.length === 0 && !(isChanged(first.within) && isChanged(change)))
    return { ...first.within, ...change };
  if (parts.every(isOutline)) {
    const steps = rest.map(({ combine, within: { camera, path, through } }) => ({
      combine,
      camera: camera!,
      path: path!,
      ...(through ? { through } : {}),
    }));
    return { ...first.within, ...(steps.length > 0 ? { steps } : {}), ...change };
  }
  return { parts: parts.map(({ combine, within }) => ({ combine, within })), ...change };
}

/**
 * Returns the steps of an area in the contract's format. Nested combinations that the page cannot
 * edit are one part.
 */
export function stepsOf(within: Within): SelectionStep[] {
  const { grow_mm: grow, smooth_mm: smooth, ...area } = within;
  return [
    ...partsOf(area),
    ...(grow === undefined ? [] : [{ grow_mm: grow }]),
    ...(smooth === undefined ? [] : [{ smooth_mm: smooth }]),
  ];
}

function partsOf(within: Within): SelectionStep[] {
  const { parts, steps, ...area } = within;
  if (parts) {
    const [first, ...rest] = parts as [WithinPart, ...WithinPart[]];
    if ((first.combine ?? "add") !== "add") return [{ combine: "add", within }];
    return [...stepsOf(first.within), ...rest.map((part) => partOf(part.combine, part.within))];
  }
  return [
    partOf("add", area),
    ...(steps ?? []).map(({ combine, ...outline }) => partOf(combine, outline)),
  ];
}

const partOf = (combine: Combination = "add", within: Within): SelectionPart => ({
  combine,
  within,
  ...(within.path && within.path.length <= kMostCorners ? { corners: true } : {}),
});

/** Whether a request can contain these steps. */
export function fitsRequest(steps: readonly SelectionStep[]): boolean {
  const within = withinOf(steps);
  return steps.filter(isPart).length <= kMostParts && (!within || depthOf(within) <= kMostDepth);
}

const depthOf = ({ parts }: Within): number =>
  parts ? 1 + Math.max(...parts.map((part) => depthOf(part.within))) : 0;
