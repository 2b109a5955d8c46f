import { afterEach, beforeEach, describe, expect, it } from "vitest";

import { setLocale } from "../../src/core/locale";
import type { SurveyedObject } from "../../src/core/protocol.gen";
import type { Model } from "../../src/core/types";
import {
  cardsOf,
  isSurveyDate,
  placeInUnit,
  seenAlike,
  standAlike,
  toldSurveyDate,
} from "../../src/domain/surveys";
import { OrbitCamera, placeOf } from "../../src/math/camera";

const object = (id: number): SurveyedObject => ({ id, name: `Object ${id}`, surveys: [] });
const survey = (id: number, of: number, date: string): Model =>
  ({ id, object: of, survey_date: date }) as Model;
const single = (id: number): Model => ({ id }) as Model;

describe("the date of a survey", () => {
  beforeEach(() => setLocale("en", true, ["en-GB"]));
  afterEach(() => setLocale("en", false, []));

  it("is told as precisely as it is known", () => {
    expect(toldSurveyDate("2019")).toBe("2019");
    expect(toldSurveyDate("2019-05")).toBe("May 2019");
    expect(toldSurveyDate("2019-05-01")).toBe("1 May 2019");
    expect(toldSurveyDate("2022-12-31")).toBe("31 Dec 2022");
  });

  it("does not move to the next century or day", () => {
    expect(toldSurveyDate("0050-01")).toMatch(/Jan (00)?50/);
    expect(toldSurveyDate("2024-02-29")).toBe("29 Feb 2024");
  });

  it("is an existing year, month or day", () => {
    for (const date of ["2019", "0800", "0800-02-28", "2019-12", "2019-05-01", "2024-02-29"])
      expect(isSurveyDate(date), date).toBe(true);
    for (const date of [
      "",
      "19",
      "2019-13",
      "2019-00",
      "2023-02-29",
      "2019-5",
      "May 2019",
      "2019-05-",
    ])
      expect(isSurveyDate(date), date).toBe(false);
  });

  it("is told in the language of the page", () => {
    setLocale("de", true, ["de-DE"]);
    expect(toldSurveyDate("2019-05")).toBe("Mai 2019");
  });
});

describe("the cards of the model list", () => {
  const told = (models: Model[], objects: SurveyedObject[]): unknown[] =>
    cardsOf(models, objects).map((card) =>
      "object" in card ? [card.object.id, ...card.models.map(({ id }) => id)] : card.model.id,
    );

  it("hold the surveys of an object, sorted by date, at the place of the first model", () => {
    const models = [
      single(1),
      survey(2, 7, "2022-06"),
      single(3),
      survey(4, 7, "2019-05-01"),
      survey(5, 8, "2025"),
      survey(6, 7, "2022"),
    ];
    expect(told(models, [object(7), object(8)])).toEqual([1, [7, 4, 6, 2], 3, [8, 5]]);
  });

  it("of unknown objects are those of the single models", () => {
    expect(told([survey(2, 7, "2019"), survey(3, 7, "2022")], [])).toEqual([2, 3]);
  });
});

describe("two surveys", () => {
  it("show layers with the same names alike, and leave the others as they are", () => {
    const seen = new Map([
      ["Cracks", { visible: false, opacity: 0.5 }],
      ["Salts", { visible: true, opacity: 1 }],
    ]);
    const layers = [
      { id: 31, name: "Cracks" },
      { id: 32, name: "Moss" },
    ];
    expect(seenAlike(seen, layers)).toEqual([{ layer: 31, visible: false, opacity: 0.5 }]);
  });

  it("have the same camera in the units of each", () => {
    const own = new OrbitCamera();
    own.setModel({ min: [0, 0, 0], max: [100, 100, 100] }, "z");
    own.resize(800, 600);
    own.firstView();
    own.section = [[1, 0, 0, -50]];
    const other = new OrbitCamera();
    other.setModel({ min: [0, 0, 0], max: [0.1, 0.1, 0.12] }, "z");
    standAlike(other, own, "mm", "m");
    for (const [x, y, z] of [
      [0, 0, 0],
      [100, 20, 70],
      [33, 100, 5],
    ] as const) {
      const [here, there] = [
        own.project([x, y, z])!,
        other.project([x / 1000, y / 1000, z / 1000])!,
      ];
      expect(there.x).toBeCloseTo(here.x, 6);
      expect(there.y).toBeCloseTo(here.y, 6);
      expect(other.cutsAway([x / 1000, y / 1000, z / 1000])).toBe(own.cutsAway([x, y, z]));
    }
  });

  it("return to the same place from another unit", () => {
    const place = placeOf(new OrbitCamera());
    const there = placeInUnit({ ...place, target: [1, 2, 3], distance: 4 }, "cm", "mm");
    expect(there.target).toEqual([10, 20, 30]);
    expect(placeInUnit(there, "mm", "cm")).toEqual({ ...place, target: [1, 2, 3], distance: 4 });
  });
});
