import { describe, expect, it, vi } from "vitest";

import { FrameCanvas, type BitmapLike } from "../../src/net/frame-canvas";
import type { FrameHeader, FrameMessage } from "../../src/net/frame-header";

const part = (header: Partial<FrameHeader>): FrameMessage => ({
  header: {
    codec: "jpeg",
    keyframe: true,
    still: false,
    last: true,
    view_id: 0,
    frame: 1,
    camera_seq: 1,
    scene_sequence: 0,
    x: 0,
    y: 0,
    width: 8,
    height: 8,
    full_width: 64,
    full_height: 48,
    render_us: 0,
    encode_us: 0,
    payload_bytes: 1,
    ...header,
  },
  payload: new Uint8Array([1]),
});

function setup() {
  const drawn: string[] = [];
  const waiting = new Map<
    FrameMessage,
    { resolve: (bitmap: BitmapLike) => void; reject: (error: Error) => void }
  >();
  const canvas = {
    width: 2,
    height: 2,
    getContext: () => ({
      drawImage: (_: never, x: number, y: number) => void drawn.push(`draw ${x},${y}`),
    }),
  };
  const callbacks = {
    drawn: (message: FrameMessage) => void drawn.push(`frame ${message.header.frame}`),
    failed: vi.fn(),
  };
  const frames = new FrameCanvas(
    canvas,
    callbacks,
    (message) => new Promise((resolve, reject) => void waiting.set(message, { resolve, reject })),
  );
  return { drawn, waiting, canvas, callbacks, frames };
}
const settle = async (): Promise<void> => {
  for (let i = 0; i < 10; ++i) await Promise.resolve();
};

describe("frames on the canvas", () => {
  it("rectangles are drawn in their order, whichever is decoded first, and a frame is whole after its last", async () => {
    const { drawn, waiting, frames } = setup();
    const [first, second] = [part({ last: false, x: 16 }), part({ x: 32, y: 16 })];
    frames.push(first);
    frames.push(second);
    const close = vi.fn();
    waiting.get(second)!.resolve({ close });
    await settle();
    expect(drawn).toEqual([]);
    waiting.get(first)!.resolve({ close });
    await settle();
    expect(drawn).toEqual(["draw 16,0", "draw 32,16", "frame 1"]);
    expect(close).toHaveBeenCalledTimes(2);
  });

  it("the last complete frame is known", async () => {
    const { waiting, frames } = setup();
    const [first, second] = [part({ frame: 1 }), part({ frame: 2, last: false })];
    const third = part({ frame: 2, x: 8 });
    expect(frames.shown).toBeNull();
    for (const each of [first, second, third]) frames.push(each);
    waiting.get(first)!.resolve({ close: () => {} });
    waiting.get(second)!.resolve({ close: () => {} });
    await settle();
    expect(frames.shown?.frame).toBe(1);
    waiting.get(third)!.resolve({ close: () => {} });
    await settle();
    expect(frames.shown).toBe(third.header);
  });

  it("the canvas takes the size of the picture", async () => {
    const { waiting, canvas, frames } = setup();
    const whole = part({});
    frames.push(whole);
    waiting.get(whole)!.resolve({ close: () => {} });
    await settle();
    expect([canvas.width, canvas.height]).toEqual([64, 48]);
  });

  it("a picture that cannot be decoded is told and still counts, so that credit never runs dry", async () => {
    const { drawn, waiting, callbacks, frames } = setup();
    const broken = part({ frame: 4 });
    frames.push(broken);
    waiting.get(broken)!.reject(new Error("not a picture"));
    await settle();
    expect(callbacks.failed).toHaveBeenCalledTimes(1);
    expect(drawn).toEqual(["frame 4"]);
  });

  it("what came over a lost connection is neither drawn nor acknowledged", async () => {
    const { drawn, waiting, frames } = setup();
    const old = part({});
    frames.push(old);
    frames.reset();
    waiting.get(old)!.resolve({ close: () => {} });
    await settle();
    expect(drawn).toEqual([]);
  });
});
