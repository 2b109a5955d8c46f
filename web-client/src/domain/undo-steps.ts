// The user's own steps that undo and redo change, as a list in which the user can move back and
// forward.

import type { UndoStep, UndoSteps } from "../core/protocol.gen";

export interface ListedStep extends UndoStep {
  /** The step was undone. Redo restores it. */
  isUndone: boolean;
}

/** Returns all steps as one list, the newest first. */
export function listOf({ done, undone }: UndoSteps): ListedStep[] {
  return [
    ...done.map((step) => ({ ...step, isUndone: false })),
    ...undone.map((step) => ({ ...step, isUndone: true })),
  ].sort((a, b) => b.last - a.last);
}

/** Returns the steps on layers that the user can change. */
export function onLayers(steps: UndoSteps, may: (layer: number) => boolean): UndoSteps {
  const fits = ({ layer }: UndoStep): boolean => may(layer);
  return { ...steps, done: steps.done.filter(fits), undone: steps.undone.filter(fits) };
}

/** Returns the newest step that is not undone, or null. */
export const currentOf = (steps: readonly ListedStep[]): ListedStep | null =>
  steps.find(({ isUndone }) => !isUndone) ?? null;

export interface Turn {
  op: "undo" | "redo";
  step: UndoStep;
}

/**
 * Returns the undos and redos, in order, after which `target` is the newest step that is not
 * undone. If `target` is null, all steps are undone. A layer gets either undos or redos, because a
 * redo after an undo on the same layer would only restore the undone step.
 */
export function turnsTo({ done, undone }: UndoSteps, target: UndoStep | null): Turn[] {
  const last = target?.last ?? 0;
  const undos = done.filter((step) => step.last > last);
  const closed = new Set(undos.map(({ layer }) => layer));
  const redos = undone.filter((step) => {
    if (step.last > last) closed.add(step.layer);
    return !closed.has(step.layer);
  });
  return [
    ...undos.map((step): Turn => ({ op: "undo", step })),
    ...redos.map((step): Turn => ({ op: "redo", step })),
  ];
}
