import { describe, expect, it } from "vitest";

import { currentOf, listOf, onLayers, turnsTo } from "../../src/domain/undo-steps";
import type { UndoStep, UndoSteps } from "../../src/core/protocol.gen";

const step = (last: number, layer = 1): UndoStep => ({
  first: last,
  last,
  stroke: `${last}`,
  layer,
  op: "stroke",
  time: "2026-05-04T12:00:00Z",
  texels_changed: 1,
  area_m2: 1,
});
const lasts = (steps: readonly UndoStep[]): number[] => steps.map(({ last }) => last);

// Strokes 1, 3 and 5 are on layer 1, strokes 2 and 4 on layer 2. Stroke 5 and then stroke 3 were
// undone.
const steps: UndoSteps = {
  done: [step(4, 2), step(2, 2), step(1)],
  undone: [step(3), step(5)],
  more: false,
};
const told = (target: UndoStep | null, given = steps): string[] =>
  turnsTo(given, target).map(({ op, step: { last, layer } }) => `${op} ${last} on ${layer}`);

describe("undo steps", () => {
  it("lists the steps of all layers with the newest first", () => {
    const list = listOf(steps);
    expect(lasts(list)).toEqual([5, 4, 3, 2, 1]);
    expect(list.map(({ isUndone }) => isUndone)).toEqual([true, false, true, false, false]);
    expect(currentOf(list)?.last).toBe(4);
    expect(currentOf([])).toBeNull();
  });

  it("goes back with the undos of each layer, newest first", () => {
    expect(told(step(1))).toEqual(["undo 4 on 2", "undo 2 on 2"]);
    expect(told(null)).toEqual(["undo 4 on 2", "undo 2 on 2", "undo 1 on 1"]);
  });

  it("goes forward with the redos in the order that the server redoes them", () => {
    expect(told(step(5))).toEqual(["redo 3 on 1", "redo 5 on 1"]);
    expect(told(step(4, 2))).toEqual(["redo 3 on 1"]);
  });

  it("redoes nothing on a layer that it undoes, or behind a step that stays undone", () => {
    const mixed: UndoSteps = {
      done: [step(9), step(6, 2)],
      undone: [step(7, 2), step(3), step(8, 2), step(4, 3)],
      more: false,
    };
    expect(told(step(7, 2), mixed)).toEqual(["undo 9 on 1", "redo 7 on 2", "redo 4 on 3"]);
    const behind: UndoSteps = { done: [], undone: [step(6), step(2)], more: false };
    expect(told(step(3, 2), behind)).toEqual([]);
  });

  it("leaves out layers that the person cannot change", () => {
    expect(lasts(listOf(onLayers(steps, (layer) => layer === 2)))).toEqual([4, 2]);
  });
});
