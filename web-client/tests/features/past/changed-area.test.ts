import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ChangedArea } from "../../../src/features/past/changed-area";
import { ApiError } from "../../../src/net/api-error";
import type { LitRequest } from "../../../src/session/lit-area";
import type { SelectResponse } from "../../../src/core/protocol.gen";

const kLayers = [
  { slug: "cracks", sequence: 4 },
  { slug: "salts", sequence: 7 },
];
const answer: SelectResponse = { resolution: 2048, texels: 9, area_m2: 2, share: 0.1, layers: {} };

describe("the changed area", () => {
  let asked: LitRequest[];
  let cleared: number;
  let show: (request: LitRequest) => Promise<SelectResponse>;
  let area: ChangedArea;
  let told: unknown[]; // the measured area at each change
  beforeEach(() => {
    vi.useFakeTimers();
    asked = [];
    cleared = 0;
    told = [];
    show = () => Promise.resolve(answer);
    area = new ChangedArea(
      {
        show: (request) => {
          asked.push(request);
          return show(request);
        },
        clear: () => void (cleared += 1),
      },
      () => told.push(area.measured),
    );
  });
  afterEach(() => vi.useRealTimers());
  const wait = (): Promise<unknown> => vi.advanceTimersByTimeAsync(1000);

  it("is lit and measured once the state rests", async () => {
    for (const from of [9, 8, 3]) area.follow(from, kLayers);
    expect(area.measured).toBeNull();
    await wait();
    expect(asked).toEqual([{ changed: { from: 3, layers: ["cracks", "salts"] } }]);
    expect(area.measured).toBe(answer);
    area.follow(3, kLayers);
    await wait();
    expect(asked).toHaveLength(1);
  });

  it("is measured again after another edit, and cleared at the end", async () => {
    area.follow(3, kLayers);
    await wait();
    area.follow(3, [{ slug: "cracks", sequence: 12 }]);
    await wait();
    expect(asked).toHaveLength(2);
    area.stop();
    expect(cleared).toBe(1);
    expect(area.measured).toBeNull();
  });

  it("is empty without a visible layer", async () => {
    area.follow(3, []);
    await wait();
    expect(asked).toEqual([]);
    expect(told).toEqual([{ texels: 0, area_m2: 0, share: 0 }]);
    area.follow(3, kLayers);
    expect(told.at(-1)).toBeNull(); // the area of another state is discarded
  });

  it("tells a refusal, but not that a later request replaced it", async () => {
    const refuse = (status: number) => (): Promise<never> =>
      Promise.reject(new ApiError({ status, title: "Refused", detail: "Not now." }));
    show = refuse(499);
    area.follow(3, kLayers);
    await wait();
    expect(area.problem).toBe("");
    show = refuse(503);
    area.follow(4, kLayers);
    await wait();
    expect(area.problem).toContain("Not now.");
  });
});
