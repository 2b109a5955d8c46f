import { beforeEach, describe, expect, it } from "vitest";
import type { PhotographsSeeing } from "../../../src/core/protocol.gen";
import { Photographs } from "../../../src/features/photographs/photographs";
import type { CameraMessage } from "../../../src/math/camera";
import { ApiError, cancelled } from "../../../src/net/api-error";
import { fakeApi } from "../../fake-api";

const camera = { width: 800, height: 600 } as unknown as CameraMessage;
const found = (total: number): PhotographsSeeing => ({
  position: [total, 0, 0],
  photographs: [],
  total,
  unknown_size: 0,
});
const flush = (): Promise<void> => new Promise((done) => setTimeout(done));

let photographs: Photographs;
let asked: unknown[];
let waiting: { answer: (found: PhotographsSeeing) => void; fail: (error: Error) => void }[];
let counted: number;

beforeEach(() => {
  asked = [];
  waiting = [];
  counted = 0;
  photographs = new Photographs(
    fakeApi({
      "GET /models/{model}/photographs": () => {
        counted += 1;
        return { photographs: [], total: 7, with_picture: 5 };
      },
      "POST /models/{model}/photographs/seeing": ({ body, signal }) => {
        asked.push(body.at);
        return new Promise((answer, fail) => {
          signal?.addEventListener("abort", () => fail(cancelled()));
          waiting.push({ answer, fail });
        });
      },
    }),
    "pot",
    { camera: () => camera, changed: () => {} },
  );
});

describe("the photographs of a place", () => {
  it("are at first those of the middle of the view, and then those of a clicked place", async () => {
    photographs.lookAt([1, 2, 3]); // the list is closed
    photographs.open();
    expect(asked).toEqual([{ camera, x: 400, y: 300 }]);
    expect(photographs.isSearching).toBe(true);
    waiting[0]!.answer(found(3));
    await flush();
    expect([photographs.isSearching, photographs.found?.total]).toEqual([false, 3]);
    expect([photographs.counts, photographs.place]).toEqual([{ total: 7, pictures: 5 }, [3, 0, 0]]);
    photographs.lookAt([1, 2, 3]);
    expect(asked[1]).toEqual({ point: [1, 2, 3] });
    expect(photographs.found?.total).toBe(3); // until the new ones are known
  });

  it("are those of the newest question", async () => {
    photographs.open();
    photographs.lookAt([1, 2, 3]);
    waiting[1]!.answer(found(2));
    await flush();
    expect([photographs.found?.total, photographs.problem]).toEqual([2, ""]);
  });

  it("are asked again for the same place after a change, and when the list opens again", async () => {
    photographs.open();
    photographs.lookAt([1, 2, 3]);
    photographs.readAgain();
    photographs.close();
    expect([photographs.found, photographs.place, photographs.isSearching]).toEqual([
      null,
      null,
      false,
    ]);
    photographs.open();
    await flush();
    expect(asked.slice(1)).toEqual(Array(3).fill({ point: [1, 2, 3] }));
    expect(counted).toBe(3);
  });

  it("give way to the problem of the server", async () => {
    photographs.open();
    waiting[0]!.fail(new ApiError({ title: "Busy", detail: "Try again.", status: 503 }));
    await flush();
    expect([photographs.isSearching, photographs.found]).toEqual([false, null]);
    expect(photographs.problem).toContain("Try again.");
  });
});
