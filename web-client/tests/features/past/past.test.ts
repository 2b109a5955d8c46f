import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { fakeApi } from "../../fake-api";
import { Past, type PastHost } from "../../../src/features/past/past";
import type { FrameMessage } from "../../../src/net/frame-header";
import type { Timeline, TimelineStep } from "../../../src/core/protocol.gen";
import { notices } from "../../../src/ui/notices";

const iso = (minute: number): string => new Date(Date.UTC(2026, 4, 4, 12, minute)).toISOString();
const kEnds = [2, 3, 7, 8, 12]; // the last edits of strokes with several batches
const steps: TimelineStep[] = kEnds.map((last, index) => ({
  first: (kEnds[index - 1] ?? 0) + 1,
  last,
  stroke: `${last}`,
  layer: 1,
  user: "ada",
  op: "stroke",
  time: iso(last),
  texels_changed: 1,
  area_m2: 1,
}));

function make(more: Partial<PastHost> = {}): {
  past: Past;
  shown: [number | null, boolean][];
  asked: Record<string, unknown>[];
} {
  const shown: [number | null, boolean][] = [];
  const asked: Record<string, unknown>[] = [];
  const api = fakeApi({
    "GET /models/{model}/timeline": ({ query }): Timeline => {
      const to = query?.to ?? iso(60);
      const seen = steps.filter(({ time }) => time <= to);
      const one = (query as { intervals: number }).intervals === 1;
      const intervals = seen.map((step, number) => ({
        number,
        edits: step.last - step.first + 1,
        first: step.first,
        last: step.last,
        begun: step.time,
        ended: step.time,
        people: [{ user: "ada", edits: 1 }],
        others: 0,
        layers: [1],
      }));
      return {
        newest: 12,
        edits: 12,
        from: iso(2),
        to: iso(12),
        intervals: one ? intervals.slice(-1) : intervals,
      };
    },
    "GET /models/{model}/timeline/steps": ({ query }) => {
      const { before, after, limit } = query as { before?: number; after?: number; limit: number };
      const found =
        after === undefined
          ? steps.filter(({ last }) => last <= before!).slice(-limit)
          : steps.filter(({ last }) => last > after).slice(0, limit);
      return { steps: found, more: false };
    },
    "POST /models/{model}/layers/{layer}/difference": ({ body }) => {
      asked.push(body);
      return { from: 1, to: 2, texels: 5, area_m2: 0.5, share: 0.1 };
    },
    "POST /models/{model}/layers/{layer}/restore": ({ body }) => {
      asked.push(body);
      return { sequence: 13, texels_changed: 5, area_m2: 0.5 };
    },
  });
  const past = new Past(api, "1", {
    show: (at, beside) => shown.push([at, beside]),
    whenFree: (action) => action(),
    unsaved: () => 0,
    camera: () => ({ view: [], projection: [], width: 2, height: 2 }),
    stopPainting: () => {},
    beginPart: () => {},
    endPart: () => {},
    changed: () => {},
    ...more,
  });
  return { past, shown, asked };
}

const frameOf = (sequence: number): FrameMessage =>
  ({ header: { scene_sequence: sequence } }) as FrameMessage;

describe("the past of a model", () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it("steps from edit to edit, to the beginning and back to now", async () => {
    const { past, shown } = make();
    await past.open();
    expect(past.isActive).toBe(false);
    for (let i = 0; i < 5; ++i) await past.goBy(false);
    expect(shown.map(([at]) => at)).toEqual([8, 7, 3, 2, 0]);
    await past.goBy(false);
    expect(past.at).toBe(0);
    expect(past.time).toBeNull();
    expect(past.place).toBe(0);
    for (let i = 0; i < 5; ++i) await past.goBy(true);
    // the state after the newest edit is the current one
    expect(shown.slice(-5).map(([at]) => at)).toEqual([2, 3, 7, 8, null]);
    await past.goBy(true);
    expect(past.at).toBeNull();
  });

  it("shows the state of a time", async () => {
    const { past } = make();
    await past.open(iso(7));
    expect(past.at).toBe(7);
    await past.open(iso(1));
    expect(past.at).toBe(0);
  });

  it("does not leave unsaved changes", async () => {
    const { past, shown } = make({ unsaved: () => 1 });
    const told = vi.spyOn(notices, "show");
    await past.open();
    past.goTo(3);
    expect(shown).toEqual([]);
    expect(told).toHaveBeenCalledOnce();
    told.mockRestore();
  });

  it("plays on only after the picture of the last state", async () => {
    const { past, shown } = make();
    await past.open();
    past.togglePlay();
    expect(shown).toEqual([[0, false]]);
    await vi.advanceTimersByTimeAsync(5000);
    expect(shown).toHaveLength(1);
    for (const sequence of [0, 2, 3, 7, 8]) {
      past.frameDrawn(frameOf(sequence));
      await vi.advanceTimersByTimeAsync(1500);
    }
    expect(shown.map(([at]) => at)).toEqual([0, 2, 3, 7, 8, null]);
    expect(past.playing).toBe(false);
  });

  it("restores what it counted, and goes back to now", async () => {
    const { past, asked, shown } = make();
    await past.open();
    past.goTo(3);
    past.drawPart();
    past.setPart([
      [0, 0],
      [1, 0],
      [1, 1],
    ]);
    expect(await past.count(1)).toMatchObject({ texels: 5 });
    await past.restore(1);
    expect(asked[0]).toMatchObject({
      from: 3,
      within: {
        path: [
          [0, 0],
          [1, 0],
          [1, 1],
        ],
      },
    });
    expect(asked[1]).toMatchObject({
      sequence: 3,
      within: {
        path: [
          [0, 0],
          [1, 0],
          [1, 1],
        ],
      },
    });
    expect(shown.at(-1)).toEqual([null, false]);
    expect(past.part).toBeNull();
  });

  it("compares in a second view, and closes to now", async () => {
    const { past, shown } = make();
    await past.compareWith(7);
    expect(shown.at(-1)).toEqual([7, true]);
    past.setDivider(2);
    expect(past.divider).toBeLessThan(1);
    past.close();
    expect(shown.at(-1)).toEqual([null, true]);
    expect([past.isOpen, past.compares, past.at]).toEqual([false, false, null]);
  });
});
