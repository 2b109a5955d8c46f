// Batches of a stroke, on a server that needs more time than the hand.

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { StrokeExtend } from "../../src/core/protocol.gen";
import { kLongestWait_ms, kMostUnanswered, StrokeHandle } from "../../src/net/stroke";
import type { ChangeMessage } from "../../src/net/outbox";

let messages: ChangeMessage[];
let stroke: StrokeHandle;
const batches = (): StrokeExtend[] =>
  messages.filter((message): message is StrokeExtend => message.op === "stroke.extend");
const xs = (): number[][] => batches().map(({ path }) => path.map(([x]) => x));
/** Extends the stroke by one point at a time. */
function draw(first: number, last: number): void {
  for (let x = first; x <= last; ++x) stroke.extend([[x, 0]]);
}

beforeEach(() => {
  vi.useFakeTimers();
  messages = [];
  stroke = new StrokeHandle("s", 6, (message) => void messages.push(message));
});
afterEach(() => {
  vi.useRealTimers();
});

describe("a stroke", () => {
  it("sends every point at once while the server keeps up", () => {
    for (let n = 0; n < 20; ++n) {
      stroke.extend([[n, 0]]);
      stroke.painted(n);
    }
    expect(xs()).toEqual(Array.from({ length: 20 }, (_, n) => [n]));
  });

  it("collects points while too many batches are not painted", () => {
    draw(0, kMostUnanswered + 2);
    expect(xs()).toEqual([[0], [1], [2], [3]]);
    stroke.painted(0);
    expect(xs().slice(kMostUnanswered)).toEqual([[4, 5, 6]]);
    draw(7, 8);
    stroke.painted(2); // and so the batch 1
    expect(xs().slice(kMostUnanswered + 1)).toEqual([[7, 8]]);
    expect(batches().map(({ n }) => n)).toEqual([0, 1, 2, 3, 4, 5]);
  });

  it("sends waiting points after a time without an answer", () => {
    draw(0, 5);
    vi.advanceTimersByTime(kLongestWait_ms - 1);
    draw(6, 6);
    expect(batches()).toHaveLength(kMostUnanswered);
    vi.advanceTimersByTime(1);
    expect(xs().slice(kMostUnanswered)).toEqual([[4, 5, 6]]);
    vi.advanceTimersByTime(10 * kLongestWait_ms);
    expect(batches()).toHaveLength(kMostUnanswered + 1);
  });

  it("sends waiting points before its end", () => {
    draw(0, 5);
    stroke.end();
    expect(xs().slice(kMostUnanswered)).toEqual([[4, 5]]);
    expect(messages[messages.length - 1]?.op).toBe("stroke.end");
    const sent = messages.length;
    draw(6, 9);
    stroke.painted(kMostUnanswered);
    stroke.end();
    vi.advanceTimersByTime(10 * kLongestWait_ms);
    expect(messages).toHaveLength(sent);
  });

  it("keeps the widths of points that waited together", () => {
    draw(0, kMostUnanswered - 1);
    stroke.extend([[4, 0]], [0.5]);
    stroke.extend([[5, 0]]);
    stroke.painted(0);
    expect(batches().map(({ widths }) => widths)).toEqual([
      undefined,
      undefined,
      undefined,
      undefined,
      [0.5, 1],
    ]);
  });

  it("splits more points than a batch may have", () => {
    draw(0, 17);
    stroke.end();
    expect(xs().slice(kMostUnanswered)).toEqual([
      [4, 5, 6, 7, 8, 9],
      [10, 11, 12, 13, 14, 15],
      [16, 17],
    ]);
  });
});
