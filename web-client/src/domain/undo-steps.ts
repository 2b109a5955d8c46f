// The person's own steps that undo and redo would change, as a list to go back and forward in.

import type { UndoStep, UndoSteps } from "../core/protocol.gen";

export interface ListedStep extends UndoStep {
  /** Undo took it back; redo brings it back. */
  isUndone: boolean;
}

/** Newest first. */
export function listOf({ done, undone }: UndoSteps): ListedStep[] {
  return [
    ...done.map((step) => ({ ...step, isUndone: false })),
    ...undone.map((step) => ({ ...step, isUndone: true })),
  ].sort((a, b) => b.last - a.last);
}

/** The steps of layers that the person can change. */
export function onLayers(steps: UndoSteps, may: (layer: number) => boolean): UndoSteps {
  const fits = ({ layer }: UndoStep): boolean => may(layer);
  return { ...steps, done: steps.done.filter(fits), undone: steps.undone.filter(fits) };
}

/** The newest step in force; null: none. */
export const currentOf = (steps: readonly ListedStep[]): ListedStep | null =>
  steps.find(({ isUndone }) => !isUndone) ?? null;

export interface Turn {
  op: "undo" | "redo";
  step: UndoStep;
}

/**
 * The undos and redos, in their order, after which `target` is the newest step in force; null: none
 * of the steps is. Undo and redo have an order for each layer: a redo after an undo of the same
 * layer would only bring back what that undo took.
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
