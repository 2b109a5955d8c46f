import { describe, expect, it } from "vitest";
import type { Layer, Model } from "../../../src/core/types";
import { coverageAddress } from "../../../src/features/gis/gis-dialog";

describe("The address of a GeoTIFF", () => {
  const [model, layer] = [{ slug: "wall" } as Model, { slug: "salts" } as Layer];

  it("leaves the direction to the server", () => {
    expect(coverageAddress(model, layer, null)).toBe("/ogc/collections/wall.salts/coverage?f=tiff");
  });

  it("escapes the sign of a direction", () => {
    expect(coverageAddress(model, layer, "+y")).toBe(
      "/ogc/collections/wall.salts/coverage?f=tiff&along=%2By",
    );
  });
});
