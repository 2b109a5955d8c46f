import { beforeEach, describe, expect, it, vi } from "vitest";

import { kSteps, nearestStep, stepsFor } from "../../../src/features/onboarding/onboarding-steps";
import { besideBar, type Box } from "../../../src/ui/beside";

describe("the steps of the tour", () => {
  it("are six at most, and those that paint are for who may paint", () => {
    expect(stepsFor(true)).toEqual([...kSteps]);
    expect(kSteps.length).toBeLessThanOrEqual(6);
    expect(stepsFor(false)).toEqual(["turn", "layers", "values", "share"]);
  });

  it("leave out what is not there: the next one that is comes in its place, or else the last before", () => {
    expect(nearestStep("brush", kSteps)).toBe("brush");
    expect(nearestStep("brush", ["turn", "values", "share"])).toBe("values");
    expect(nearestStep("share", ["turn", "values"])).toBe("values");
    expect(nearestStep("turn", [])).toBeNull();
  });
});

describe("the card of the tour", () => {
  const card = { width: 330, height: 160 };
  const gap = 12;
  const box = (left: number, top: number, width: number, height: number): Box => ({
    left,
    top,
    width,
    height,
  });

  it("stands on that side of the bar that has room, at the height of the thing", () => {
    const desktop = { width: 1280, height: 800 };
    const rail = box(0, 54, 58, 746);
    expect(besideBar(box(8, 400, 42, 42), rail, card, desktop, gap)).toMatchObject({
      left: 70,
      top: 341,
    });
    const panel = box(950, 54, 330, 746);
    expect(besideBar(panel, panel, card, desktop, gap)).toMatchObject({ left: 608, top: 347 });
    const head = box(0, 0, 1280, 54);
    expect(besideBar(box(1140, 9, 36, 36), head, card, desktop, gap)).toMatchObject({
      left: 938,
      top: 66,
    });
    const phone = { width: 390, height: 844 };
    const foot = box(0, 788, 390, 56);
    expect(besideBar(box(80, 794, 40, 44), foot, card, phone, gap)).toMatchObject({
      left: 12,
      top: 616,
    });
  });

  it("never covers the bar, and is lower rather than outside of the window", () => {
    for (const frame of [
      { width: 390, height: 844 },
      { width: 844, height: 390 },
      { width: 390, height: 240 },
      { width: 1280, height: 800 },
    ]) {
      const bars = [
        box(0, 0, frame.width, 54),
        box(0, frame.height - 56, frame.width, 56),
        box(0, 0, frame.width, frame.height * 0.44),
      ];
      if (frame.width > 820)
        bars.push(
          box(0, 54, 58, frame.height - 54),
          box(frame.width - 330, 54, 330, frame.height - 54),
        );
      for (const bar of bars) {
        const size = { width: Math.min(card.width, frame.width - 24), height: card.height };
        const { left, top, mostHeight } = besideBar(bar, bar, size, frame, gap);
        const height = Math.min(size.height, mostHeight);
        const beside =
          left >= bar.left + bar.width ||
          left + size.width <= bar.left ||
          top >= bar.top + bar.height ||
          top + height <= bar.top;
        expect(beside, JSON.stringify({ frame, bar, left, top, mostHeight })).toBe(true);
        expect(height).toBeGreaterThan(60);
        expect(left).toBeGreaterThanOrEqual(0);
        expect(top).toBeGreaterThanOrEqual(0);
        expect(left + size.width).toBeLessThanOrEqual(frame.width);
        expect(top + height).toBeLessThanOrEqual(frame.height);
      }
    }
  });
});

describe("that the tour is over", () => {
  let kept: Map<string, string>;
  const storage = (): Pick<Storage, "getItem" | "setItem"> => ({
    getItem: (name) => kept.get(name) ?? null,
    setItem: (name, value) => void kept.set(name, value),
  });
  /** Loads the module as another page of the same browser does. */
  const page = async (): Promise<typeof import("../../../src/ui/preferences")> => {
    vi.resetModules();
    return import("../../../src/ui/preferences");
  };

  beforeEach(() => {
    kept = new Map();
    vi.stubGlobal("localStorage", storage());
    return () => vi.unstubAllGlobals();
  });

  it("is kept by the browser, for pages that are open, too", async () => {
    const [one, other] = [await page(), await page()];
    expect(one.tourIsOver()).toBe(false);
    one.keepTourOver();
    expect(other.tourIsOver()).toBe(true);
    expect((await page()).tourIsOver()).toBe(true);
  });

  it("holds for the page where the browser keeps nothing", async () => {
    vi.stubGlobal("localStorage", {
      getItem: () => {
        throw new Error("refused");
      },
      setItem: () => {
        throw new Error("refused");
      },
    });
    const one = await page();
    expect(one.tourIsOver()).toBe(false);
    one.keepTourOver();
    expect(one.tourIsOver()).toBe(true);
  });
});
