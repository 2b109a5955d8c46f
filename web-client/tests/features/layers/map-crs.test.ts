import { describe, expect, it } from "vitest";
import { crsInDoubt, crsQuery, kNotAsked } from "../../../src/features/layers/map-crs";
import type { MapContents, Model } from "../../../src/core/types";

const map = (crs?: string): MapContents => ({
  kind: "polygons",
  format: "geojson",
  ...(crs ? { crs } : {}),
});
const model = (crs: string): Model => ({ crs }) as Model;

describe("the coordinate system of a map", () => {
  it("is in doubt only where the map names one and the model has none", () => {
    expect(crsInDoubt(map("EPSG:25830"), model(""))).toBe("EPSG:25830");
    expect(crsInDoubt(map("EPSG:25830"), model("EPSG:25830"))).toBeNull();
    expect(crsInDoubt(map(), model(""))).toBeNull();
    expect(crsInDoubt(null, model(""))).toBeNull();
    expect(crsInDoubt(map("EPSG:25830"), null)).toBeNull();
  });

  it("is sent once it was taken", () => {
    expect(crsQuery(kNotAsked)).toEqual({});
    expect(crsQuery({ asked: true, taken: null })).toEqual({});
    expect(crsQuery({ asked: true, taken: "EPSG:25830" })).toEqual({ crs: "EPSG:25830" });
  });
});
