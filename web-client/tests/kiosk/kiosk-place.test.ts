// The name that a kiosk shows after a tap on the model.
import { describe, expect, it } from "vitest";
import type { Layer } from "../../src/core/types";
import { layerThere, wordsOfPlace } from "../../src/kiosk/place";

const layer = (change: Partial<Layer>): Layer =>
  ({
    id: 1,
    name: "Pieces",
    slug: "pieces",
    labels: { de: "Scherben" },
    unit: "",
    palette: {
      mode: "categorical",
      min: 1,
      max: 2,
      points: [{ at: 1, color: "#ff0000ff", label: "Sherd 1" }],
    },
    ...change,
  }) as Layer;
const pieces = layer({});
const moisture = layer({
  id: 2,
  name: "Moisture",
  slug: "moisture",
  labels: {},
  unit: "%",
  palette: { mode: "linear", min: 0, max: 100, points: [] },
});
const finds = layer({ id: 3, name: "Finds", slug: "finds", table: 4 });
const picked = (values: Record<string, number>) =>
  ({
    values: Object.fromEntries(
      Object.entries(values).map(([slug, value]) => [slug, { valid: true, value }]),
    ),
  }) as never;

describe("a tap in a kiosk", () => {
  it("finds the record before what lies over it, and otherwise the topmost layer", () => {
    expect(layerThere([moisture, finds], picked({ moisture: 3, finds: 7 }))).toEqual({
      layer: finds,
      value: 7,
    });
    expect(layerThere([moisture, pieces], picked({ moisture: 3, pieces: 1 }))).toEqual({
      layer: moisture,
      value: 3,
    });
    expect(layerThere([moisture, pieces], picked({ pieces: 1 }))).toEqual({
      layer: pieces,
      value: 1,
    });
    expect(layerThere([moisture, pieces], { values: { pieces: { valid: false } } })).toBeNull();
  });

  it("names the class, or the number with its unit, and the layer in the visitor's language", () => {
    expect(wordsOfPlace(pieces, 1, "de")).toEqual({ title: "Sherd 1", about: "Scherben" });
    expect(wordsOfPlace(pieces, 1, "es")).toEqual({ title: "Sherd 1", about: "Pieces" });
    expect(wordsOfPlace(pieces, 2, "en")).toEqual({ title: "Pieces", about: "" });
    expect(wordsOfPlace(moisture, 12.5, "en")).toEqual({ title: "12.5 %", about: "Moisture" });
  });
});
