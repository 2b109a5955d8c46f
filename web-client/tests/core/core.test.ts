import { describe, expect, it } from "vitest";

import { Api } from "../../src/net/api";
import { ApiError, problemOfText } from "../../src/net/api-error";
import { nameOfFile } from "../../src/domain/file-names";
import { newId } from "../../src/core/ids";
import { changeLayer, createLayer } from "../../src/net/layers";
import {
  detailChoices,
  formatArea,
  formatLength,
  formatNumber,
  formatSize,
  likelyScale,
  scaleBar,
  ticks,
} from "../../src/domain/measure";
import {
  classPalette,
  colorOf,
  cssGradient,
  measurementPalette,
  presencePalette,
  purposeOf,
  samePalette,
} from "../../src/domain/palette";
import type { Camera } from "../../src/core/protocol.gen";
import { completePalette } from "../../src/core/types";

describe("numbers as people write them", () => {
  it("lengths take the unit that suits them", () => {
    const lengths = [0.0000021, 0.0002, 0.0008, 0.0123, 0.5, 3.14159, 1234].map(formatLength);
    expect(lengths).toEqual([
      "2.1 µm",
      "0.2 mm",
      "0.8 mm",
      "1.23 cm",
      "50 cm",
      "3.14 m",
      "1.23 km",
    ]);
  });
  it("areas do, too", () => {
    expect([0, 2.5e-6, 0.0123, 2.5].map(formatArea)).toEqual([
      "0 mm²",
      "2.5 mm²",
      "123 cm²",
      "2.5 m²",
    ]);
  });
  it("a size is three numbers and one unit", () => {
    expect(formatSize([0.1052, 0.099, 0.0908])).toBe("105 × 99 × 90.8 mm");
    expect(formatSize([4.2, 1.05, 0.3])).toBe("420 × 105 × 30 cm");
    expect(formatSize([105, 99, 91])).toBe("105 × 99 × 91 m");
  });
  it("numbers have three digits and no exponent for everyday sizes", () => {
    expect([0, 0.012345, 1234.5, -7.006, Number.NaN].map((n) => formatNumber(n))).toEqual([
      "0",
      "0.0123",
      "1,235",
      "-7.01",
      "–",
    ]);
  });
  it("a scale bar is round and not longer than asked", () => {
    for (const metresPerPx of [3.3e-7, 0.00042, 0.013, 7.7]) {
      const bar = scaleBar(metresPerPx, 150);
      expect(bar.px).toBeLessThanOrEqual(150);
      expect(bar.px).toBeGreaterThan(59);
      expect(bar.px * metresPerPx).toBeCloseTo(bar.metres, 9);
      expect(bar.metres.toExponential(6)).toMatch(/^[125]\.0+e/);
    }
  });
  it("ticks are round numbers within the limits", () => {
    expect(ticks(0, 40)).toEqual([0, 10, 20, 30, 40]);
    expect(ticks(-0.3, 0.9)).toEqual([0, 0.5]);
    expect(ticks(5, 5)).toEqual([5]);
  });
  it("a question about the size begins with what is proposed, unless somebody has said otherwise", () => {
    const proposal = {
      unit: "mm",
      unit_reason: "size",
      unit_confidence: 0.8,
      up: "y",
      up_reason: "shape",
      up_confidence: 0.7,
    } as const;
    const model = {
      unit: "m",
      unit_assumed: true,
      scale_verified: false,
      up: "z",
      proposal,
    } as const;
    expect(likelyScale(model)).toEqual({ unit: "mm", up: "y" });
    expect(likelyScale({ ...model, unit: "cm", unit_assumed: false })).toEqual({
      unit: "cm",
      up: "y",
    });
    expect(likelyScale({ ...model, up: "-x" })).toEqual({ unit: "mm", up: "-x" });
    expect(likelyScale({ ...model, scale_verified: true })).toEqual({ unit: "m", up: "z" });
    expect(likelyScale({ ...model, proposal: undefined })).toEqual({ unit: "m", up: "z" });
  });
  it("the smallest detail halves with each doubling of the layer", () => {
    const choices = detailChoices({ lowest_resolution: 2048, texel_area_max_m2: 6.4e-7 });
    expect(choices.map((choice) => choice.resolution)).toEqual([2048, 4096, 8192]);
    expect(choices.map((choice) => formatLength(choice.detailM))).toEqual([
      "0.8 mm",
      "0.4 mm",
      "0.2 mm",
    ]);
  });
  it("the smallest detail is what was measured at that resolution, where it was", () => {
    const texelSizes = [{ resolution: 4096, area_mean_m2: 1e-7, area_max_m2: 2.5e-7 }];
    const choices = detailChoices({
      lowest_resolution: 2048,
      texel_area_max_m2: 6.4e-7,
      texel_sizes: texelSizes,
    });
    expect(choices.map((choice) => formatLength(choice.detailM))).toEqual([
      "0.8 mm",
      "0.5 mm",
      "0.2 mm",
    ]);
  });
});

const classesWithoutPoints = completePalette({ mode: "categorical" });

describe("palettes", () => {
  it("a linear palette blends, a stepped one holds the point below, both keep to their limits", () => {
    const linear = completePalette({
      mode: "linear",
      points: [
        { at: 0, color: "#000000ff" },
        { at: 10, color: "#ff800000" },
      ],
    });
    expect(colorOf(linear, 5)).toBe("#80400080");
    expect(colorOf(linear, -3)).toBe("#000000ff");
    expect(colorOf(linear, 99)).toBe("#ff800000");
    expect(colorOf({ ...linear, mode: "step" }, 9.9)).toBe("#000000ff");
  });
  it("a class that the palette does not list has the colour that the server makes", () => {
    const classes = classPalette([
      { at: 2, label: "b", color: "#0000ffff" },
      { at: 1, label: "a", color: "#ff0000ff" },
    ]);
    expect(classes.points.map((point) => point.at)).toEqual([1, 2]);
    expect(colorOf(classes, 2)).toBe("#0000ffff");
    const colors = [0, 1, 2, 7, 300, 70_000, 4_294_967_295].map((key) =>
      colorOf(classesWithoutPoints, key),
    );
    // the same values as in generatedColor() in server/core/palette.cpp
    expect(colors).toEqual([
      "#d96262ff",
      "#3c6ad9ff",
      "#9ed94dff",
      "#3bd934ff",
      "#4bd98cff",
      "#4ad971ff",
      "#51d978ff",
    ]);
  });
  it("the purpose of a layer is read from its palette", () => {
    const purpose = (palette: Parameters<typeof completePalette>[0]) =>
      purposeOf({ kind: "numeric", palette: completePalette(palette) });
    expect(purpose(presencePalette("Cracks", "#d55e00ff"))).toBe("presence");
    expect(purpose(measurementPalette(0, 1))).toBe("measurement");
    expect(purpose(measurementPalette(0, 1, "step"))).toBe("measurement");
    expect(purpose({ mode: "categorical" })).toBe("classes");
  });
  it("palettes are the same when they show and call every value alike", () => {
    const one = classPalette([{ at: 1, label: "", color: "#ff0000ff" }]);
    expect(samePalette(one, { ...one, points: [{ at: 1, color: "#ff0000ff" }] })).toBe(true);
    expect(samePalette(one, { ...one, points: [{ at: 1, color: "#ff0000fe" }] })).toBe(false);
    expect(samePalette(one, { ...one, points: [] })).toBe(false);
    expect(samePalette(one, { ...one, max: 2 })).toBe(false);
  });
  it("a stepped gradient has hard edges", () => {
    const palette = completePalette({
      mode: "step",
      min: 0,
      max: 2,
      points: [
        { at: 0, color: "#000000" },
        { at: 1, color: "#ffffff" },
      ],
    });
    expect(cssGradient(palette)).toBe(
      "linear-gradient(to right, rgb(0 0 0 / 1.000) 0.00%, rgb(0 0 0 / 1.000) 50.00%, rgb(255 255 255 / 1.000) 50.00%)",
    );
  });
});

describe("HTTP", () => {
  const answer = (status: number, body: string, headers = {}): Response =>
    new Response(status === 204 ? null : body, { status, headers });

  it("a problem keeps its words and its field", async () => {
    const problem = {
      status: 422,
      title: "Value out of range",
      detail: "Give 0 to 255.",
      field: "value",
    };
    const api = new Api(async () => answer(422, JSON.stringify(problem)));
    await expect(api.json("GET /me")).rejects.toEqual(new ApiError(problem));
  });
  it("an answer that is no problem object is told in plain words", () => {
    expect(problemOfText(503, "<html>").title).toBe("The server is not ready");
    expect(problemOfText(418, "null").title).toBe("The server answered 418");
  });
  it("a lost network is an ApiError of status 0", async () => {
    const api = new Api(() => Promise.reject(new TypeError("failed")));
    await expect(api.all("GET /models", "models")).rejects.toMatchObject({ status: 0 });
  });
  it("a picture that nobody waits for any more is asked for no longer", async () => {
    const givenUp: string[] = [];
    const api = new Api(
      (path, init) =>
        new Promise((_, reject) =>
          init!.signal!.addEventListener("abort", () => {
            givenUp.push(path);
            reject(new DOMException("stopped", "AbortError"));
          }),
        ),
    );
    const stop = new AbortController();
    const camera = {} as Camera;
    const pictures = [
      api.blob("POST /models/{model}/frame", {
        path: { model: 1 },
        body: { camera, format: "jpeg" },
        signal: stop.signal,
      }),
      api.blob("GET /models/{model}/views/{view}/picture", {
        path: { model: 1, view: 2 },
        query: { thumbnail: 256 },
        signal: stop.signal,
      }),
    ];
    stop.abort();
    for (const picture of pictures) await expect(picture).rejects.toMatchObject({ status: 499 });
    expect(givenUp).toEqual([
      "/api/v1/models/1/frame",
      "/api/v1/models/1/views/2/picture?thumbnail=256",
    ]);
  });
  it("a layer is changed with the version that was read", async () => {
    const calls: [string, string, unknown][] = [];
    const api = new Api(async (path, init) => {
      calls.push([init!.method!, path, (init!.headers as Record<string, string>)["If-Match"]]);
      return answer(200, '{"id":7,"palette":{"mode":"categorical"}}', { ETag: '"3"' });
    });
    const changed = await changeLayer(api, 1, 7, { name: "x" });
    expect(calls).toEqual([
      ["GET", "/api/v1/models/1/layers/7", undefined],
      ["PATCH", "/api/v1/models/1/layers/7", '"3"'],
    ]);
    expect(changed.palette.points).toEqual([]);
    calls.length = 0;
    // the request has the given version, even if that is outdated
    await changeLayer(api, 1, 7, { name: "y" }, '"2"');
    expect(calls).toEqual([["PATCH", "/api/v1/models/1/layers/7", '"2"']]);
  });
  it("every POST that changes something has a key of its own", async () => {
    const keys = new Set<string>();
    const api = new Api(async (_path, init) => {
      keys.add((init!.headers as Record<string, string>)["Idempotency-Key"]!);
      return answer(201, '{"palette":{"mode":"categorical"}}');
    });
    for (let i = 0; i < 3; ++i) await createLayer(api, 1, { name: "a" });
    expect(keys.size).toBe(3);
    expect(keys.has(undefined as unknown as string)).toBe(false);
  });
  it("ids are version 4 UUIDs", () => {
    for (let i = 0; i < 50; ++i)
      expect(newId()).toMatch(
        /^[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$/,
      );
  });
  it("a model's name comes from its file", () => {
    expect(["statue_nefertiti_70k.ply", "a.b.OBJ", ".ply"].map(nameOfFile)).toEqual([
      "statue nefertiti 70k",
      "a.b",
      ".ply",
    ]);
  });
});
