import { beforeEach, describe, expect, it } from "vitest";
import type { LayerPreview } from "../../../src/core/protocol.gen";
import { StrataLayerPreview } from "../../../src/features/layers/layer-preview";
import { ApiError, cancelled } from "../../../src/net/api-error";
import type { ModelSession } from "../../../src/session/model-session";
import { fakeApi } from "../../fake-api";

interface Inside {
  _shown: LayerPreview | null;
  _running: AbortController | null;
}
const layer = { name: "Preview", expression: "distance(cracks)" };
const answer = (resolution: number): LayerPreview => ({ resolution }) as unknown as LayerPreview;

let preview: StrataLayerPreview;
let inside: Inside;
let waiting: { answer: (made: LayerPreview) => void; fail: (error: Error) => void }[];
let grids: unknown[];

beforeEach(() => {
  waiting = [];
  grids = [];
  preview = new StrataLayerPreview();
  inside = preview as unknown as Inside;
  preview.session = {
    modelId: "pot",
    model: { default_resolution: 4096 },
    view: { camera: { width: 1280, height: 800, message: () => ({}) } },
    api: fakeApi({
      "POST /models/{model}/layer-preview": ({ body, signal }) => {
        grids.push([body.picture.width, body.picture.height]);
        return new Promise((given, fail) => {
          signal?.addEventListener("abort", () => fail(cancelled()));
          waiting.push({ answer: given, fail });
        });
      },
    }),
  } as unknown as ModelSession;
  // Without a page, the element is not rendered.
  Object.defineProperties(preview, {
    scheduleUpdate: { value: () => {} },
    updateComplete: { value: Promise.resolve() },
    scrollIntoView: { value: () => {} },
  });
});

describe("the preview of a layer", () => {
  it("is shown when it is computed, in the shape of the view", async () => {
    const shown = preview.show(layer);
    expect(inside._running).not.toBeNull();
    waiting[0]!.answer(answer(2048));
    await shown;
    expect([inside._running, inside._shown?.resolution]).toEqual([null, 2048]);
    expect(grids).toEqual([[640, 400]]);
  });

  it("is replaced by a newer one, which ends its computation", async () => {
    const first = preview.show(layer);
    const second = preview.show(layer);
    await first; // ends without a problem
    waiting[1]!.answer(answer(1024));
    await second;
    expect(inside._shown?.resolution).toBe(1024);
  });

  it("can be cancelled", async () => {
    const shown = preview.show(layer);
    preview.clear();
    await shown;
    expect([inside._running, inside._shown]).toEqual([null, null]);
  });

  it("leaves the problems of the server to the dialog", async () => {
    const shown = preview.show(layer);
    const problem = new ApiError({ title: "No", status: 422, field: "layer.expression" });
    waiting[0]!.fail(problem);
    await expect(shown).rejects.toBe(problem);
    expect([inside._running, inside._shown]).toEqual([null, null]);
  });
});
