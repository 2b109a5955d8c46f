// Draws the parts of streamed frames into a canvas, in order, and says when a frame is whole.
// Decoding is the browser's own and does not block the page.

import type { FrameMessage } from "./frame-header";

export interface CanvasLike {
  width: number;
  height: number;
  getContext(
    kind: "2d",
    options?: { alpha: boolean },
  ): { drawImage(image: never, x: number, y: number): void } | null;
}

export interface BitmapLike {
  close(): void;
}

export interface FrameCanvasCallbacks {
  /** The last part of a frame is on the canvas. */
  drawn(part: FrameMessage): void;
  failed(reason: string): void;
}

const kMediaTypes = { jpeg: "image/jpeg", png: "image/png" } as const;

const decode_image = (part: FrameMessage): Promise<BitmapLike> =>
  createImageBitmap(new Blob([part.payload], { type: kMediaTypes[part.header.codec] }));

export class FrameCanvas {
  private queue_: Promise<void> = Promise.resolve();
  private generation_ = 0;

  constructor(
    private readonly canvas_: CanvasLike,
    private readonly callbacks_: FrameCanvasCallbacks,
    private readonly decode_: (part: FrameMessage) => Promise<BitmapLike> = decode_image,
  ) {}

  /**
   * Decoding starts at once; drawing keeps the order of calls. A part that cannot be decoded counts
   * as drawn, so that the server's credit never runs dry.
   */
  push(part: FrameMessage): void {
    const generation = this.generation_;
    const decoded = this.decode_(part);
    decoded.catch(() => {}); // reported where it is awaited, in order
    this.queue_ = this.queue_.then(async () => {
      try {
        const bitmap = await decoded;
        if (generation === this.generation_) this.draw(part, bitmap);
        bitmap.close();
      } catch (error) {
        if (generation === this.generation_) this.callbacks_.failed(String(error));
      }
      if (generation === this.generation_ && part.header.last) this.callbacks_.drawn(part);
    });
  }

  /** Forgets what is on its way: the connection it came over is gone. */
  reset(): void {
    this.generation_ += 1;
  }

  private draw(part: FrameMessage, bitmap: BitmapLike): void {
    const { full_width, full_height, x, y } = part.header;
    if (this.canvas_.width !== full_width || this.canvas_.height !== full_height) {
      this.canvas_.width = full_width;
      this.canvas_.height = full_height;
    }
    this.canvas_.getContext("2d", { alpha: false })?.drawImage(bitmap as never, x, y);
  }
}
