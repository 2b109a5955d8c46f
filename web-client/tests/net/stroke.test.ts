// Batches of a stroke, on a server that needs more time than the hand.

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { StrokeExtend } from "../../src/core/protocol.gen";
import type { ChangeMessage } from "../../src/net/outbox";
import { kLongestWaitMs, StrokeHandle } from "../../src/net/stroke";

let messages: ChangeMessage[];
let flow: { isBehind: boolean };
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
  flow = { isBehind: false };
  stroke = new StrokeHandle("s", 6, flow, (message) => void messages.push(message));
});
afterEach(() => {
  vi.useRealTimers();
});

describe("a stroke", () => {
  it("sends every point at once while the server keeps up", () => {
    draw(0, 19);
    expect(xs()).toEqual(Array.from({ length: 20 }, (_, n) => [n]));
  });

  it("collects points while the server is behind", () => {
    draw(0, 1);
    flow.isBehind = true;
    draw(2, 4);
    stroke.proceed();
    expect(xs()).toEqual([[0], [1]]);
    flow.isBehind = false;
    stroke.proceed();
    expect(xs()).toEqual([[0], [1], [2, 3, 4]]);
    stroke.proceed();
    expect(batches().map(({ n }) => n)).toEqual([0, 1, 2]);
  });

  it("sends waiting points after a time without an answer", () => {
    flow.isBehind = true;
    draw(0, 1);
    vi.advanceTimersByTime(kLongestWaitMs - 1);
    draw(2, 2);
    expect(batches()).toEqual([]);
    vi.advanceTimersByTime(1);
    expect(xs()).toEqual([[0, 1, 2]]);
    vi.advanceTimersByTime(10 * kLongestWaitMs);
    expect(batches()).toHaveLength(1);
  });

  it("sends waiting points before its end", () => {
    flow.isBehind = true;
    draw(0, 1);
    stroke.end();
    expect(xs()).toEqual([[0, 1]]);
    expect(messages[messages.length - 1]?.op).toBe("stroke.end");
    draw(2, 5);
    flow.isBehind = false;
    stroke.proceed();
    stroke.end();
    vi.advanceTimersByTime(10 * kLongestWaitMs);
    expect(messages).toHaveLength(2);
  });

  it("keeps the widths of points that waited together", () => {
    draw(0, 0);
    flow.isBehind = true;
    stroke.extend([[1, 0]], [0.5]);
    stroke.extend([[2, 0]]);
    stroke.end();
    expect(batches().map(({ widths }) => widths)).toEqual([undefined, [0.5, 1]]);
  });

  it("splits more points than a batch may have", () => {
    flow.isBehind = true;
    draw(0, 13);
    stroke.end();
    expect(xs()).toEqual([
      [0, 1, 2, 3, 4, 5],
      [6, 7, 8, 9, 10, 11],
      [12, 13],
    ]);
  });
});
