import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { isBusy, LayerJobs } from "../../../src/session/layer-jobs";
import {
  kShapeGroups,
  otherModels,
  recipeOf,
  type ShapeInput,
} from "../../../src/features/layers/shape-kinds";
import { texts } from "../../../src/texts";
import { likelyToleranceMm } from "../../../src/domain/survey-changes";
import { shareText } from "../../../src/domain/measure";
import { Api } from "../../../src/net/api";
import type { Job, Model } from "../../../src/core/types";

const input: ShapeInput = {
  kind: "roughness",
  radius: "",
  distance: "",
  normal: "",
  projection: "",
  registration: "",
  latitude: "",
  north: "",
  months: { from: 1, to: 12 },
  wind_shares: "",
  wind_speed_m_s: "",
  rain_mm: "",
  rain_mm_per_hour: "",
  rays: "",
  absolute: false,
  model: "",
  property: "",
  look: "",
};

describe("a recipe from what was filled in", () => {
  it("leaves out what is empty or not of its kind", () => {
    expect(recipeOf({ ...input, distance: "5", absolute: true, model: "7" })).toEqual({
      kind: "roughness",
    });
    expect(recipeOf({ ...input, radius: " 2.5 " })).toEqual({ kind: "roughness", radius_mm: 2.5 });
    expect(recipeOf({ ...input, kind: "height", absolute: true })).toEqual({
      kind: "height",
      absolute: true,
    });
    expect(recipeOf({ ...input, kind: "model_distance", model: "7", distance: "30" })).toEqual({
      kind: "model_distance",
      model: "7",
      distance_mm: 30,
    });
    expect(
      recipeOf({
        ...input,
        kind: "significant_change",
        model: "7",
        radius: "1",
        registration: "0",
        projection: "12.5",
      }),
    ).toEqual({
      kind: "significant_change",
      model: "7",
      registration_mm: 0,
      projection_scale_mm: 12.5,
    });
    expect(recipeOf({ ...input, kind: "vertex_property", property: "pot.ply/a/b" })).toEqual({
      kind: "vertex_property",
      source: "pot.ply",
      property: "a/b",
    });
  });
  it("takes a surface image for the lightness alone", () => {
    expect(recipeOf({ ...input, look: "4" })).toEqual({ kind: "roughness" });
    const lightness = { ...input, kind: "lightness" as const };
    expect(recipeOf(lightness)).toEqual({ kind: "lightness" });
    expect(recipeOf({ ...lightness, look: "4" })).toEqual({ kind: "lightness", look: "4" });
  });
  it("takes a number of rays for openness alone, within the server's bounds", () => {
    const openness = { ...input, kind: "ambient_occlusion" as const };
    expect(recipeOf({ ...openness, rays: "256" })).toEqual({
      kind: "ambient_occlusion",
      rays: 256,
    });
    expect(recipeOf({ ...input, rays: "256" })).toEqual({ kind: "roughness" });
    for (const rays of ["15", "1025", "20.5", "many"])
      expect(recipeOf({ ...openness, rays })).toMatchObject({ field: "rays" });
  });
  it("takes latitude, north and whole months for the sun alone", () => {
    const sun = { ...input, kind: "sun_energy" as const, latitude: "-33.5" };
    expect(recipeOf(sun)).toEqual({
      kind: "sun_energy",
      latitude_deg: -33.5,
      from: "01-01",
      to: "12-31",
    });
    expect(recipeOf({ ...sun, north: "0", months: { from: 11, to: 2 } })).toEqual({
      kind: "sun_energy",
      latitude_deg: -33.5,
      north_deg: 0,
      from: "11-01",
      to: "02-28",
    });
    expect(recipeOf({ ...input, latitude: "50", north: "3" })).toEqual({ kind: "roughness" });
    for (const latitude of ["", "91", "-90.1", "Athens"])
      expect(recipeOf({ ...sun, latitude })).toMatchObject({ field: "latitude" });
    for (const north of ["361", "up"])
      expect(recipeOf({ ...sun, north })).toMatchObject({ field: "north" });
  });
  it("takes the wind rose and the rain for driving rain alone", () => {
    const climate = { wind_shares: "10 8 6 8; 14 28.5\t18 8", wind_speed_m_s: "4", rain_mm: "760" };
    const rain = { ...input, kind: "driving_rain" as const, ...climate };
    const recipe = {
      kind: "driving_rain",
      wind_shares: [10, 8, 6, 8, 14, 28.5, 18, 8],
      wind_speed_m_s: 4,
      rain_mm: 760,
    };
    expect(recipeOf(rain)).toEqual(recipe);
    expect(recipeOf({ ...rain, north: "20", rain_mm_per_hour: "1.5" })).toEqual({
      ...recipe,
      north_deg: 20,
      rain_mm_per_hour: 1.5,
    });
    expect(recipeOf({ ...input, ...climate })).toEqual({ kind: "roughness" });
    for (const shares of ["", "1 2 3", "0 0 0 0 0 0 0 0", "1 1 1 1 1 1 1 -1", "W W W W W W W W"])
      expect(recipeOf({ ...rain, wind_shares: shares })).toMatchObject({ field: "wind_shares" });
    expect(recipeOf({ ...rain, wind_speed_m_s: "" })).toMatchObject({ field: "wind_speed_m_s" });
    expect(recipeOf({ ...rain, rain_mm: "0" })).toMatchObject({ field: "rain_mm" });
    expect(recipeOf({ ...rain, rain_mm_per_hour: "0" })).toMatchObject({
      field: "rain_mm_per_hour",
    });
  });
  it("names the field that is wrong", () => {
    for (const radius of ["0", "-3", "wide"])
      expect(recipeOf({ ...input, radius })).toEqual({
        problem: texts.shape.bad_length,
        field: "radius",
      });
    expect(recipeOf({ ...input, kind: "model_distance" })).toMatchObject({ field: "model" });
    expect(recipeOf({ ...input, kind: "change" })).toMatchObject({ field: "model" });
    const change = { ...input, kind: "change" as const, model: "7" };
    expect(recipeOf({ ...change, registration: "-1" })).toMatchObject({ field: "registration" });
    expect(recipeOf({ ...change, normal: "0" })).toMatchObject({ field: "normal" });
    expect(recipeOf({ ...input, kind: "vertex_property" })).toMatchObject({ field: "property" });
  });
  it("has words for every kind that the server knows", () => {
    const kinds = kShapeGroups.flatMap((group) => group.kinds.map(({ kind }) => kind));
    expect(new Set(kinds).size).toBe(20);
    for (const group of kShapeGroups)
      for (const { title, lead } of group.kinds) expect(title && lead).toBeTruthy();
  });
});

describe("the other model", () => {
  const model = (id: number, project: string): Model => ({ id, project }) as unknown as Model;
  it("is never the same, and those of the project come first", () => {
    const all = [model(1, "b"), model(2, "a"), model(3, "a")];
    expect(otherModels(all, all[1]!).map(({ id }) => id)).toEqual([3, 1]);
  });
  it("is at first the survey before this one", () => {
    const survey = (id: number, date: string): Model =>
      ({ id, project: "a", object: 7, survey_date: date }) as unknown as Model;
    const all = [
      model(1, "a"),
      survey(2, "2019"),
      survey(3, "2021-05"),
      survey(4, "2023"),
      survey(5, "2020"),
    ];
    expect(otherModels(all, all[2]!).map(({ id }) => id)).toEqual([5, 2, 4, 1]);
  });
  it("is first thought to differ by a 500th of the size", () => {
    const bounds: Model["bounds"] = { min: [0, 0, 0], max: [3, 4, 0] };
    expect(likelyToleranceMm({ bounds, unit: "m" })).toBe(10);
    expect(likelyToleranceMm({ bounds, unit: "mm" })).toBe(0.01);
  });
  it("a share of nothing is no share", () => {
    expect(shareText(0, 0)).toBe("–");
    expect(shareText(0.982, 1)).toBe("98.2 %");
  });
});

describe("work that makes layers", () => {
  let answers: Job[];
  let asked: [method: string, path: string][];
  let jobs: LayerJobs;
  const job = (state: Job["state"], more: Partial<Job> = {}): Job => ({
    id: 5,
    state,
    progress: 0.5,
    message: "Painting",
    ...more,
  });

  beforeEach(() => {
    vi.useFakeTimers();
    [answers, asked] = [[], []];
    const api = new Api((path, init) => {
      asked.push([init?.method ?? "GET", path.replace("/api/v1", "")]);
      const body = answers.length > 1 ? answers.shift() : answers[0];
      return Promise.resolve(new Response(JSON.stringify(body)));
    });
    jobs = new LayerJobs(api, "3", () => {});
  });
  afterEach(() => vi.useRealTimers());

  it("is shown until it is done, and tells what it made", async () => {
    answers = [job("queued"), job("running"), job("done", { layers: [9] })];
    const { done } = await jobs.compute({ name: "Marks", compute: { kind: "roughness" } });
    expect(asked[0]).toEqual(["POST", "/models/3/layers"]);
    expect(jobs.entries.map((entry) => [entry.name, isBusy(entry)])).toEqual([["Marks", true]]);
    await vi.advanceTimersByTimeAsync(400);
    expect(jobs.entries[0]!.job.state).toBe("running");
    await vi.advanceTimersByTimeAsync(400);
    expect(await done).toEqual([9]);
    expect(jobs.entries).toEqual([]);
  });
  it("stays with the reason when it fails, until it is dismissed", async () => {
    answers = [
      job("queued"),
      job("failed", { problem: { title: "No boundary", status: 422, detail: "It is closed." } }),
    ];
    const { done } = await jobs.compute({ name: "Rim" });
    await vi.advanceTimersByTimeAsync(400);
    expect(await done).toEqual([]);
    expect(jobs.entries[0]!.problem?.title).toBe("No boundary");
    expect(isBusy(jobs.entries[0]!)).toBe(false);
    jobs.dismiss(jobs.entries[0]!.key);
    expect(jobs.entries).toEqual([]);
  });
  it("is cancelled on the server", async () => {
    answers = [job("running")];
    const { done } = await jobs.transfer("Layers", { from: "1", tolerance_mm: 1 });
    expect(asked[0]).toEqual(["POST", "/models/3/transfer"]);
    await jobs.cancel(jobs.entries[0]!.key);
    expect(asked).toContainEqual(["DELETE", "/jobs/5"]);
    answers = [job("cancelled")];
    await vi.advanceTimersByTimeAsync(400);
    expect(await done).toEqual([]);
    expect(jobs.entries).toEqual([]);
  });
  it("keeps the report of a transfer in view", async () => {
    const report = { from: 1, area_m2: 1, matched_m2: 0.9, layers: [] };
    answers = [job("queued"), job("done", { layers: [4, 5], report })];
    const { done } = await jobs.transfer("Layers", { from: "1", tolerance_mm: 1 });
    await vi.advanceTimersByTimeAsync(400);
    expect(await done).toEqual([4, 5]);
    expect(jobs.entries[0]!.report).toEqual(report);
  });
});
