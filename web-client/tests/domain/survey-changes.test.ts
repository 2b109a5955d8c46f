import { describe, expect, it } from "vitest";

import type {
  LayerChanges,
  Survey,
  SurveyLayerStatistics,
  SurveyStatistics,
} from "../../src/core/protocol.gen";
import {
  changeTable,
  classArea,
  classesOf,
  datedPlot,
  inOrder,
  sumOf,
  timeOf,
} from "../../src/domain/survey-changes";

const none = { pieces: [], total: 0, area_m2: 0 };
const changes = (more: Partial<LayerChanges>): LayerChanges => ({
  since: 1,
  layer: 2,
  area_m2: 10,
  matched_m2: 9,
  table: { rows: [], columns: [], area_m2: [], texels: [] },
  unmatched_now: [],
  unmatched_then: [],
  appeared: none,
  vanished: none,
  ...more,
});
const table = {
  rows: [1, null],
  columns: [1, 2, null],
  area_m2: [
    [3, 1, 0.5],
    [0, 0.25, 0],
  ],
  texels: [
    [3, 1, 1],
    [0, 1, 0],
  ],
};

describe("the table of the changes", () => {
  it("is the table of the server if everything has a counterpart", () => {
    expect(changeTable(changes({ table }))).toEqual({
      rows: [1, null],
      columns: [1, 2, null],
      areaM2: table.area_m2,
    });
  });
  it("has a row and a column for what has no counterpart", () => {
    const { rows, columns, areaM2 } = changeTable(
      changes({
        table,
        unmatched_now: [{ value: 5, area_m2: 0.1 }],
        unmatched_then: [
          { value: 0, area_m2: 0.2 },
          { value: 1, area_m2: 0.3 },
        ],
      }),
    );
    expect(rows).toEqual([0, 1, null, "unmatched"]);
    expect(columns).toEqual([1, 2, 5, null, "unmatched"]);
    expect(areaM2).toEqual([
      [0, 0, 0, 0, 0.2],
      [3, 1, 0, 0.5, 0.3],
      [0, 0.25, 0, 0, 0],
      [0, 0, 0.1, 0, 0],
    ]);
    expect(sumOf(areaM2.map(sumOf))).toBeCloseTo(3 + 1 + 0.5 + 0.25 + 0.1 + 0.2 + 0.3);
  });
  it("is empty if nothing is painted", () => {
    expect(changeTable(changes({})).rows).toEqual([]);
  });
});

const survey = (model: number, date: string): Survey => ({ model, date, slug: "s", name: "S" });

describe("surveys", () => {
  it("are put in the order of the object", () => {
    const [a, b] = [survey(5, "2019"), survey(3, "2022")];
    expect(inOrder([a, b], b, a)).toEqual([a, b]);
    expect(inOrder([a, b], a, b)).toEqual([a, b]);
  });
  it("have a time", () => {
    expect(timeOf("2019")).toBe(Date.UTC(2019, 0, 1));
    expect(timeOf("2019-05")).toBe(Date.UTC(2019, 4, 1));
    expect(timeOf("2019-05-17")).toBe(Date.UTC(2019, 4, 17));
  });
});

describe("the statistics of all surveys", () => {
  const statistics = (areas: readonly [number, string, number][]): SurveyLayerStatistics =>
    ({
      classes: areas.map(([key, name, area]) => ({ key, class: name, area_m2: area })),
    }) as SurveyLayerStatistics;
  const surveyed = (model: number, date: string, of: SurveyLayerStatistics | null) => ({
    ...survey(model, date),
    statistics: of,
  });
  const all: SurveyStatistics[] = [
    surveyed(
      1,
      "2019",
      statistics([
        [1, "Crack", 3],
        [2, "Salt", 1],
      ]),
    ),
    surveyed(2, "2021", null),
    surveyed(
      3,
      "2022",
      statistics([
        [3, "Salt", 2],
        [4, "Loss", 2.5],
        [5, "Salt", 2],
      ]),
    ),
  ];
  it("name the classes of any survey, the largest first, with the same name as one class", () => {
    const [crack, salt, loss] = [
      { name: "Crack", key: 1 },
      { name: "Salt", key: 2 },
      { name: "Loss", key: 4 },
    ];
    expect(classesOf(all, 10)).toEqual([salt, crack, loss]);
    expect(classesOf(all, 2)).toEqual([salt, crack]);
    expect(classArea(all[2]!.statistics!, "Salt")).toBe(4);
    expect(classArea(all[2]!.statistics!, "Crack")).toBe(0);
  });
  it("have no areas of classes if the server lists none", () => {
    const of = { area_m2: 1 } as SurveyLayerStatistics;
    expect(classArea(of, "Crack")).toBeUndefined();
    expect(classesOf([surveyed(1, "2019", of)], 10)).toEqual([]);
  });
  it("are a curve over the dates, with a gap where a survey has no such layer", () => {
    const { paths, least, most } = datedPlot(
      ["2019", "2020", "2021", "2023"],
      [{ color: "red", values: [2, 4, null, 1] }],
      400,
      100,
    );
    expect([least, most]).toEqual([0, 4]);
    const [{ d, points }] = paths as [(typeof paths)[0]];
    expect(points.map(([x]) => Math.round(x))).toEqual([0, 100, 400]);
    expect(points.map(([, y]) => y)).toEqual([50, 0, 75]);
    expect(d).toMatch(/^M0\.0 50\.0L[\d.]+ 0\.0M400\.0 75\.0$/);
  });
  it("also show values below 0, and a single date", () => {
    const { paths, least, most } = datedPlot(["2019"], [{ color: "red", values: [-2] }], 400, 100);
    expect(paths[0]!.points).toEqual([[200, 100]]);
    expect([least, most]).toEqual([-2, 0]);
  });
});
