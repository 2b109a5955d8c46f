import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { SilenceWatch } from "../../src/net/silence-watch";

describe("the silence of a server", () => {
  const done: string[] = [];
  const make = (): SilenceWatch =>
    new SilenceWatch({ ask: () => done.push("ask"), giveUp: () => done.push("give up") });

  beforeEach(() => {
    vi.useFakeTimers();
    done.length = 0;
  });
  afterEach(() => {
    vi.useRealTimers();
  });

  it("is broken by a question first, and ends the connection only then", () => {
    const silence = make();
    silence.expectAnswer();
    vi.advanceTimersByTime(6000);
    silence.expectAnswer(); // another expected response does not postpone the liveness check
    vi.advanceTimersByTime(4000);
    expect(done).toEqual(["ask"]);
    vi.advanceTimersByTime(10_000);
    expect(done).toEqual(["ask", "give up"]);
  });

  it("counts only while an answer is due", () => {
    const silence = make();
    vi.advanceTimersByTime(60_000);
    silence.expectAnswer();
    silence.heard();
    vi.advanceTimersByTime(60_000);
    expect(done).toEqual([]);
    silence.limit(5000);
    vi.advanceTimersByTime(5000);
    expect(done).toEqual(["give up"]);
  });
});
