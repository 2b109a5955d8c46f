import { describe, expect, it } from "vitest";

import { map_kind, number_attributes, world_numbers } from "../src/app/map-file";
import { formats_of, raster_format } from "../src/app/raster-files";
import { name_in_text } from "../src/app/where-dialog";
import type { Layer } from "../src/core/types";

describe("raster files", () => {
  it.each([
    ["cracks.tif", "tif"],
    ["Cracks 2.TIFF", "tif"],
    ["a.b.png", "png"],
    ["x.npy", "npy"],
    ["x.jpg", null],
    ["png", null],
    ["", null],
  ])("%s", (name, format) => expect(raster_format(name)).toBe(format));

  it("PNG is offered for what it can hold", () => {
    expect(formats_of({ type: "u16" } as Layer)).toEqual(["tif", "png", "npy"]);
    expect(formats_of({ type: "f32" } as Layer)).toEqual(["tif", "npy"]);
  });
});

describe("a layer's name in an expression", () => {
  it.each([
    ["roof-height", "roof-height"],
    ["3d-cracks", '"3d-cracks"'],
    ["max", '"max"'],
  ])("%s is %s", (slug, text) => expect(name_in_text(slug)).toBe(text));
});

describe("files that are painted over a layer", () => {
  it.each([
    ["a.CSV", "readings"],
    ["b.geojson", "polygons"],
    ["c.x.jpeg", "picture"],
    ["d.shp", null],
  ])("%s", (name, kind) => expect(map_kind(name)).toBe(kind));

  it("numbers that every feature has are offered", () => {
    const text = JSON.stringify({ features: [{ properties: { a: 1, b: 2, c: "x" } }, { properties: { a: 3, c: 4 } }] });
    expect(number_attributes(text)).toEqual(["a"]);
    for (const broken of ["", "{", "[]", "{}", '{"features":[{"properties":null}]}']) expect(number_attributes(broken)).toEqual([]);
  });

  it("a world file is six numbers", () => {
    expect(world_numbers("0.5\r\n0\r\n0\r\n-0.5\r\n100\r\n2e2\r\n")).toBe("0.5,0,0,-0.5,100,2e2");
    for (const wrong of ["", "1 2 3 4 5", "1 2 3 4 5 x", "1 2 3 4 5 6 7"]) expect(world_numbers(wrong)).toBe(null);
  });
});
