import { describe, expect, it } from "vitest";

import {
  colorKeys,
  colorRows,
  fileKind,
  pictureModes,
  tableKind,
  unknownFile,
  worldNumbers,
} from "../../../src/features/layers/map-file";
import { formatsOf, planOf, rasterFormat } from "../../../src/features/layers/raster-files";
import type { Layer, MapColor } from "../../../src/core/types";

describe("raster files", () => {
  it.each([
    ["cracks.tif", "tif"],
    ["Cracks 2.TIFF", "tif"],
    ["a.b.png", "png"],
    ["x.npy", "npy"],
    ["x.jpg", null],
    ["png", null],
    ["", null],
  ])("%s", (name, format) => expect(rasterFormat(name)).toBe(format));

  it("PNG is offered for what it can hold", () => {
    expect(formatsOf({ type: "u16" } as Layer)).toEqual(["tif", "png", "npy"]);
    expect(formatsOf({ type: "f32" } as Layer)).toEqual(["tif", "npy"]);
  });

  it("outlines are laid on the ground, whichever axis is up", () => {
    expect((["x", "y", "z", "-x", "-y", "-z"] as const).map(planOf)).toEqual([
      "-x",
      "-y",
      "-z",
      "-x",
      "-y",
      "-z",
    ]);
  });
});

describe("files that are painted over a layer", () => {
  it.each([
    [["a.CSV"], "table"],
    [["b.geojson"], "map"],
    [["c.x.jpeg", "c.x.jgw"], "map"],
    [["d.shp", "d.dbf", "d.prj"], "map"],
    [["d.zip"], "map"],
    [["a.csv", "b.csv"], null],
    [["d.shp", "notes.doc"], null],
    [[], null],
  ])("%s", (names, kind) => expect(fileKind(names)).toBe(kind));

  it("the one that is not taken is named", () =>
    expect(unknownFile(["d.shp", "notes.doc"])).toBe("notes.doc"));

  it.each([
    ["x,y,z,value\n1,2,3,4", "readings"],
    ['\n"Value";X ; y;z;name\n', "readings"],
    ["0.5\n0.7\n", "vertices"],
    ["quality\n0.5\n", "vertices"],
    ["", "vertices"],
  ])("%s", (text, kind) => expect(tableKind(text)).toBe(kind));

  it("a world file is six numbers", () => {
    expect(worldNumbers("0.5\r\n0\r\n0\r\n-0.5\r\n100\r\n2e2\r\n")).toBe("0.5,0,0,-0.5,100,2e2");
    for (const wrong of ["", "1 2 3 4 5", "1 2 3 4 5 x", "1 2 3 4 5 6 7"])
      expect(worldNumbers(wrong)).toBe(null);
  });
});

describe("what a picture's places get", () => {
  const color = (name: string, background = false): MapColor => ({
    color: name,
    share: 0.3,
    background,
  });

  it("is what the picture holds", () => {
    const picture = { kind: "picture", format: "tiff" } as const;
    expect(pictureModes({ ...picture, bands: 2, has_colors: false })).toEqual(["band"]);
    expect(pictureModes({ ...picture, bands: 1, has_colors: true, is_rgb: false })).toEqual([
      "band",
      "luminance",
    ]);
    const colors = [color("#ffffff", true), color("#ff0000")];
    expect(pictureModes({ ...picture, bands: 3, has_colors: true, is_rgb: true, colors })).toEqual([
      "colors",
      "luminance",
      "band",
    ]);
  });

  it("by colour: the classes of the layer first, then new numbers; not the paper", () => {
    const rows = colorRows(
      [color("#fff000", true), color("#ff0000"), color("#00ff00"), color("#0000ff")],
      [3, 4],
    );
    expect(rows.map(({ used, value }) => [used, value])).toEqual([
      [false, ""],
      [true, "3"],
      [true, "4"],
      [true, "5"],
    ]);
    expect(colorKeys(rows)).toBe('{"#ff0000":3,"#00ff00":4,"#0000ff":5}');
    expect(colorKeys(rows.map((row) => ({ ...row, used: false })))).toBe(null);
    expect(colorKeys(rows.map((row) => ({ ...row, value: "" })))).toBe(null);
    expect(colorRows([color("#ff0000")], [])[0]!.value).toBe("1");
  });
});
