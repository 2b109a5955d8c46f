import { describe, expect, it } from "vitest";

import {
  exportRequest,
  kTextureSizes,
  kUsualExport,
  triangleCounts,
} from "../../../src/domain/exports";
import { ModelExports } from "../../../src/features/exports/exports";
import { Api } from "../../../src/net/api";
import { FileJobs } from "../../../src/session/file-jobs";
import { LayerJobs } from "../../../src/session/layer-jobs";
import { texts } from "../../../src/texts";

describe("The request for a 3D model", () => {
  it("shows the chosen layers as the user sees them, and leaves the size to the server", () => {
    const shown = {
      layers: [
        { layer: 5, visible: false, opacity: 0.5 },
        { layer: 4, visible: true },
      ],
      looks: [{ look: "infrared" }],
    };
    expect(exportRequest(kUsualExport, [3, 4, 5], [3, 5], shown)).toEqual({
      layers: [
        { layer: 3, visible: true },
        { layer: 4, visible: false },
        { layer: 5, visible: true, opacity: 0.5 },
      ],
      looks: [{ look: "infrared" }],
      format: "glb",
      texture_format: "jpeg",
      unlit: false,
    });
  });

  it("has the chosen features, part, triangles, size, format and light", () => {
    const input = {
      file: "glb",
      layers: [5],
      features: 7,
      part: 3,
      triangles: 50_000,
      size: 4096,
      format: "png",
      unlit: true,
    } as const;
    expect(exportRequest(input, [5], [5], {})).toEqual({
      layers: [{ layer: 5, visible: true }],
      format: "glb",
      features: 7,
      within: { selection: 3 },
      max_triangles: 50_000,
      texture_size: 4096,
      texture_format: "png",
      unlit: true,
    });
  });

  it("has no features in an OBJ file, but keeps the choice for a GLB file", () => {
    const input = { ...kUsualExport, file: "obj", features: 7 } as const;
    expect(exportRequest(input, [], [], {})).toEqual({
      layers: [],
      format: "obj",
      texture_format: "jpeg",
      unlit: false,
    });
    expect(exportRequest({ ...input, file: "glb" }, [], [], {}).features).toBe(7);
  });

  it("has fewer triangles than the model, in steps that the server accepts", () => {
    expect(triangleCounts(10_000)).toEqual([]);
    expect(triangleCounts(120_000)).toEqual([100_000, 50_000, 10_000]);
    const all = triangleCounts(Infinity);
    expect(Math.min(...all)).toBeGreaterThanOrEqual(100);
    expect(Math.max(...all)).toBeLessThan(2 ** 32);
  });

  it("has a size that the server accepts", () => {
    for (const size of kTextureSizes) {
      expect(Number.isInteger(Math.log2(size)) && size >= 512 && size <= 8192).toBe(true);
      expect(texts.export_dialog.side(size)).toContain(String(size));
    }
  });
});

describe("The 3D models of the open model", () => {
  it("are jobs of the server, in the language of the page", async () => {
    const calls: { path: string; body: unknown; prefer: string | undefined }[] = [];
    const api = new Api(async (path, init) => {
      const headers = init!.headers as Record<string, string>;
      const body: unknown = init!.body ? JSON.parse(init!.body as string) : undefined;
      calls.push({ path, body, prefer: headers["Prefer"] });
      return new Response(JSON.stringify({ id: 5, state: "cancelled", progress: 0, message: "" }), {
        status: 202,
      });
    });
    const files = new FileJobs(api, new LayerJobs(api, "9", () => {}));
    const exports = new ModelExports(api, "9", files);
    const key = await exports.make(
      "3D model: Pot",
      "Ready",
      exportRequest(kUsualExport, [], [], {}),
      "es",
    );
    expect(files.awaited).toBe(key);
    expect(calls[0]).toMatchObject({
      path: "/api/v1/models/9/exports?lang=es",
      body: { layers: [], texture_format: "jpeg" },
      prefer: "respond-async",
    });
  });

  it("have a draft only while the model is open", () => {
    const api = new Api(async () => new Response("{}", { status: 500 }));
    const files = new FileJobs(api, new LayerJobs(api, "9", () => {}));
    const exports = new ModelExports(api, "9", files);
    exports.draft = { ...exports.draft, size: 1024 };
    expect(new ModelExports(api, "10", files).draft).toEqual(kUsualExport);
  });
});
