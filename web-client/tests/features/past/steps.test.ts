import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { UndoStep, UndoSteps } from "../../../src/core/protocol.gen";
import { Steps } from "../../../src/features/past/steps";
import { Api } from "../../../src/net/api";

/** A fake server with steps of one layer. As on the real server, undo takes the newest step. */
class FakeSteps {
  done: UndoStep[];
  undone: UndoStep[] = [];
  reads = 0;
  posted: string[] = [];
  /** Called before each response. */
  meanwhile: () => void = () => {};

  constructor(count: number) {
    this.done = Array.from({ length: count }, (_, i) => ({
      layer: 1,
      first: count - i,
      last: count - i,
      op: "stroke",
      time: "2026-05-04T12:00:00Z",
      texels_changed: 1,
      area_m2: 0,
      erase: false,
      stroke: `00000000-0000-4000-8000-00000000000${count - i}`,
    }));
  }

  readonly fetch = async (url: string, init?: RequestInit): Promise<Response> => {
    await Promise.resolve();
    this.meanwhile();
    if (init?.method === "POST") {
      this.posted.push(url.endsWith("/undo") ? "undo" : "redo");
      const [from, to] = url.endsWith("/undo")
        ? [this.done, this.undone]
        : [this.undone, this.done];
      to.unshift(from.shift()!);
      return new Response("{}");
    }
    this.reads += 1;
    const steps: UndoSteps = { done: [...this.done], undone: [...this.undone], more: false };
    return new Response(JSON.stringify(steps));
  };
}

describe("A person's own steps", () => {
  let server: FakeSteps;
  let steps: Steps;
  beforeEach(() => {
    vi.useFakeTimers();
    server = new FakeSteps(5);
    const api = new Api((input, init) => server.fetch(String(input), init));
    steps = new Steps(api, "1", { mayChange: () => true, changed: () => {} });
  });
  afterEach(() => vi.useRealTimers());

  it("are undone and redone until one is the newest in force", async () => {
    await steps.load();
    expect(await steps.goTo(server.done[2]!)).toEqual({ ended: "there", done: 2 });
    expect(server.posted).toEqual(["undo", "undo"]);
    expect(steps.current?.last).toBe(3);
    expect(await steps.goTo(server.undone[1]!)).toEqual({ ended: "there", done: 2 });
    expect(await steps.goTo(null)).toEqual({ ended: "there", done: 5 });
  });

  it("are gone to once, also by a double click", async () => {
    await steps.load();
    const target = server.done[2]!;
    const [first, second] = await Promise.all([steps.goTo(target), steps.goTo(target)]);
    expect(first).toEqual({ ended: "there", done: 2 });
    expect(second).toBeUndefined();
    expect(server.posted).toEqual(["undo", "undo"]);
  });

  it("are not read in between, so that the way ends where it leads", async () => {
    await steps.load();
    server.meanwhile = () => void steps.load();
    expect((await steps.goTo(server.done[3]!))?.ended).toBe("there");
    expect(server.reads).toBe(3); // once at the start, and before and after the undos
  });

  it("stop where the list was closed, also before the first undo", async () => {
    await steps.load();
    const going = steps.goTo(server.done[3]!);
    steps.stop();
    expect(await going).toEqual({ ended: "stopped", done: 0 });
    expect(server.posted).toEqual([]);
  });

  it("are read once after several edits", async () => {
    for (let i = 0; i < 9; ++i) steps.loadSoon();
    await vi.advanceTimersByTimeAsync(1000);
    expect(server.reads).toBe(1);
    steps.loadSoon();
    steps.stop();
    await vi.advanceTimersByTimeAsync(1000);
    expect(server.reads).toBe(1);
  });
});
