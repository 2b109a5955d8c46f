import { describe, expect, it } from "vitest";

import type { Agreement, ClassAgreement } from "../../../src/core/protocol.gen";
import type { Layer } from "../../../src/core/types";
import { agreementSummary, kMostClasses } from "../../../src/features/layers/agreement-summary";
import type { RecordLabels } from "../../../src/session/layer-values";

const records: RecordLabels = { label: () => null, term: () => null };
const layer = (name: string, labels: Record<number, string>): Layer =>
  ({
    name,
    slug: name.toLowerCase(),
    labels: {},
    kind: "numeric",
    palette: {
      mode: "categorical",
      points: Object.entries(labels).map(([at, label]) => ({ at: Number(at), label })),
    },
  }) as unknown as Layer;
const anna = layer("Anna", { 1: "Crack", 2: "" });
const bo = layer("Bo", { 1: "crack", 2: "Loss" });

// areas in cm²
const of = (key: number | null, both: number, first: number, second: number): ClassAgreement => ({
  key,
  area_both_m2: both / 1e4,
  area_first_m2: first / 1e4,
  area_second_m2: second / 1e4,
  iou: both / (first + second - both),
  f1: (2 * both) / (first + second),
});
const agreement = (more: Partial<Agreement> = {}): Agreement => ({
  area_m2: 0.005,
  observed: 0.7,
  expected: 0.5,
  kappa: 0.4,
  observed_painted: 20 / 35,
  classes: [of(1, 20, 25, 30), of(null, 15, 25, 20)],
  ...more,
});
const summary = (more: Partial<Agreement> = {}): ReturnType<typeof agreementSummary> =>
  agreementSummary(agreement(more), anna, bo, records);

describe("the summary of the agreement of two layers", () => {
  it("says in words what kappa means, and how much of the surface agrees", () => {
    expect(summary().sentences).toEqual([
      "Cohen’s κ is 0.40: fair agreement (scale of Landis and Koch 1977).",
      "The layers agree on 70 % of the surface. By chance, they would agree on 50 %.",
      "Where at least one layer is painted, they agree on 57.1 %.",
      "“Not painted” counts as a class.",
    ]);
  });

  it("shows the areas of each class, and those in only one layer", () => {
    expect(summary().rows).toEqual([
      ["Class", "IoU", "F1", "In both", "Only in Anna", "Only in Bo"],
      ["Crack", "57.1 %", "72.7 %", "20 cm²", "5 cm²", "10 cm²"],
      ["Not painted", "50 %", "66.7 %", "15 cm²", "10 cm²", "5 cm²"],
    ]);
  });

  it("takes the name of a class from the layer that has one", () => {
    const { rows } = summary({ classes: [of(2, 1, 1, 1), of(5, 1, 1, 1)] });
    expect(rows.slice(1).map(([name]) => name)).toEqual(["Loss", "Class 5"]);
  });

  it("has the largest classes first, and those that are not painted last", () => {
    const classes = [1, 2, 3].map((key) => of(key, key, key, key + 1));
    const { rows, isCut } = summary({ classes: [...classes, of(null, 90, 90, 90)] });
    expect(rows.slice(1).map(([name]) => name)).toEqual([
      "Class 3",
      "Loss",
      "Crack",
      "Not painted",
    ]);
    expect(isCut).toBe(false);
  });

  it("is cut if there are many classes", () => {
    const classes = Array.from({ length: 100 }, (_, i) => of(i + 1, i + 1, i + 1, i + 1));
    const { rows, isCut } = summary({ classes: [...classes, of(null, 1, 1, 1)] });
    expect(isCut).toBe(true);
    expect(rows).toHaveLength(1 + kMostClasses);
    expect(rows[1]![0]).toBe("Class 100");
    expect(rows.at(-1)![0]).toBe("Not painted");
  });

  it("says why there is no kappa, and shows no negative zero", () => {
    const { sentences } = summary({
      kappa: null,
      observed: 1,
      expected: 1,
      observed_painted: null,
    });
    expect(sentences).toHaveLength(3);
    expect(sentences[0]).toMatch(/undefined/);
    expect(summary({ kappa: -0.001 }).sentences[0]).toMatch(/κ is 0\.00: slight/);
    expect(summary({ kappa: -0.25 }).sentences[0]).toMatch(/κ is -0\.25: poor/);
  });
});
