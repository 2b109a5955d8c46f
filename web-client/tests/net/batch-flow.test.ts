// When points wait for a server with much work.

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import {
  BatchFlow,
  kLongestRoundTripMs,
  kMostUnanswered,
  kUsualDelayMs,
} from "../../src/net/batch-flow";

let flow: BatchFlow;
const send = (n: number, stroke = "s"): void =>
  flow.sent({ op: "stroke.extend", id: `${stroke}${n}`, stroke, n, path: [[0, 0]] });
/** The server paints one batch after this time, so the quickest reply is known. */
function replyAfter(ms: number): void {
  send(0, "first");
  vi.advanceTimersByTime(ms);
  flow.painted("first", 0);
}

beforeEach(() => {
  vi.useFakeTimers();
  flow = new BatchFlow();
});
afterEach(() => {
  vi.useRealTimers();
});

describe("the flow of batches", () => {
  it.each([5, 40, 150, kLongestRoundTripMs])(
    "does not wait for a round trip of %d ms",
    (roundTripMs) => {
      replyAfter(roundTripMs);
      const replies: { n: number; atMs: number }[] = [];
      for (let n = 0; n < 100; ++n) {
        while (replies[0] && replies[0].atMs <= performance.now())
          flow.painted("s", replies.shift()!.n);
        expect(flow.isBehind).toBe(false);
        send(n);
        replies.push({ n, atMs: performance.now() + roundTripMs });
        vi.advanceTimersByTime(7); // a frame of a fast screen
      }
    },
  );

  it("is behind if several batches wait longer than usual", () => {
    replyAfter(20);
    for (let n = 0; n < kMostUnanswered - 1; ++n) send(n);
    vi.advanceTimersByTime(1000);
    expect(flow.isBehind).toBe(false);
    send(kMostUnanswered - 1);
    expect(flow.isBehind).toBe(true);
    flow.painted("s", 0);
    expect(flow.isBehind).toBe(false);
  });

  it("is not behind before the usual time has passed", () => {
    replyAfter(20);
    for (let n = 0; n < 10; ++n) send(n);
    vi.advanceTimersByTime(20 + kUsualDelayMs);
    expect(flow.isBehind).toBe(false);
    vi.advanceTimersByTime(1);
    expect(flow.isBehind).toBe(true);
  });

  it("counts the batches of all strokes", () => {
    replyAfter(20);
    for (let n = 0; n < kMostUnanswered; ++n) send(0, `stroke${n}`);
    vi.advanceTimersByTime(1000);
    expect(flow.isBehind).toBe(true);
    flow.painted("another", 7);
    expect(flow.isBehind).toBe(true);
    flow.painted("stroke2", 0);
    expect(flow.isBehind).toBe(false);
  });

  it("takes earlier batches of the stroke for painted", () => {
    replyAfter(20);
    for (let n = 0; n < 8; ++n) send(n);
    vi.advanceTimersByTime(1000);
    flow.painted("s", 4);
    expect(flow.isBehind).toBe(false);
  });

  it("does not wait for refused batches", () => {
    replyAfter(20);
    for (let n = 0; n < kMostUnanswered; ++n) send(n);
    vi.advanceTimersByTime(1000);
    flow.refused("s1");
    expect(flow.isBehind).toBe(false);
  });

  it("knows nothing of a new connection", () => {
    replyAfter(1);
    for (let n = 0; n < 8; ++n) send(n);
    vi.advanceTimersByTime(1000);
    flow.restart();
    for (let n = 0; n < 8; ++n) send(n, "next");
    vi.advanceTimersByTime(kLongestRoundTripMs + kUsualDelayMs);
    expect(flow.isBehind).toBe(false);
    vi.advanceTimersByTime(1);
    expect(flow.isBehind).toBe(true);
  });
});
