import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { fakeApi } from "../../fake-api";
import { Visits } from "../../../src/features/past/visits";
import type { TimelineStep } from "../../../src/core/protocol.gen";

const step = (last: number, user: string): TimelineStep => ({
  first: last,
  last,
  stroke: `${last}`,
  layer: 1,
  user,
  op: "stroke",
  time: "2026-05-04T12:00:00.000Z",
  texels_changed: 1,
  area_m2: 1,
});
const all = [step(3, "ada"), step(4, "ben"), step(5, "ben"), step(6, "cleo")];
const visit = (): Visits =>
  new Visits(
    fakeApi({
      "GET /models/{model}/timeline/steps": ({ query }) => ({
        steps: all.filter(({ last }) => last > (query as { after: number }).after),
        more: false,
      }),
    }),
    "wall",
    () => {},
  );

describe("visits", () => {
  beforeEach(() => {
    const kept = new Map<string, string>();
    vi.stubGlobal("localStorage", {
      getItem: (key: string) => kept.get(key) ?? null,
      setItem: (key: string, value: string) => void kept.set(key, value),
    });
  });
  afterEach(() => void vi.unstubAllGlobals());

  it("tell what others changed since the last one", async () => {
    const first = visit();
    await first.welcome("ada", 2);
    expect(first.news).toBeNull();
    first.saw(3);
    first.close();

    const second = visit();
    await second.welcome("ada", 6);
    expect(second.news?.edits).toBe(3);
    expect(second.news?.since.sequence).toBe(3);
    expect(second.news?.people.map(({ user }) => user)).toEqual(["ben", "cleo"]);
    second.dismiss();
    expect(second.news).toBeNull();
    second.close();

    const third = visit();
    await third.welcome("ada", 6);
    expect(third.news).toBeNull();
    third.close();
  });

  it("are of one person and one model, and own edits are no news", async () => {
    const ben = visit();
    await ben.welcome("ben", 3);
    ben.close();
    const ada = visit();
    await ada.welcome("ada", 6);
    expect(ada.news).toBeNull(); // this is her first visit
    ada.close();
    const again = visit();
    await again.welcome("ben", 6);
    expect(again.news?.people.map(({ user }) => user)).toEqual(["cleo"]);
    again.close();
  });

  it("survive a storage with something else", async () => {
    localStorage.setItem("strata.visits", "{");
    const visits = visit();
    await visits.welcome("ada", 6);
    expect(visits.news).toBeNull();
    visits.close();
  });
});
