// Draws the parts of streamed frames into a canvas, in order, and reports complete frames. The
// browser decodes the parts without blocking the page.

import type { FrameHeader, FrameMessage } from "./frame-header";

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

const decodeImage = (part: FrameMessage): Promise<BitmapLike> =>
  createImageBitmap(new Blob([part.payload], { type: kMediaTypes[part.header.codec] }));

export class FrameCanvas {
  private _queue: Promise<void> = Promise.resolve();
  private _generation = 0;
  private _shown: FrameHeader | null = null;

  constructor(
    private readonly _canvas: CanvasLike,
    private readonly _callbacks: FrameCanvasCallbacks,
    private readonly _decode: (part: FrameMessage) => Promise<BitmapLike> = decodeImage,
  ) {}

  /**
   * Decodes a part immediately and draws it in the order of the calls. A part that cannot be
   * decoded is also reported as drawn, so the server's credit does not run out.
   */
  push(part: FrameMessage): void {
    const generation = this._generation;
    const decoded = this._decode(part);
    decoded.catch(() => {}); // the await below reports failures, in order
    this._queue = this._queue.then(async () => {
      try {
        const bitmap = await decoded;
        if (generation === this._generation) {
          this.draw(part, bitmap);
          if (part.header.last) this._shown = part.header;
        }
        bitmap.close();
      } catch (error) {
        if (generation === this._generation) this._callbacks.failed(String(error));
      }
      if (generation === this._generation && part.header.last) this._callbacks.drawn(part);
    });
  }

  /** The header of the last complete frame on the canvas. */
  get shown(): FrameHeader | null {
    return this._shown;
  }

  /** Discards pending parts, because their connection was lost. */
  reset(): void {
    this._generation += 1;
  }

  private draw(part: FrameMessage, bitmap: BitmapLike): void {
    const { full_width: fullWidth, full_height: fullHeight, x, y } = part.header;
    if (this._canvas.width !== fullWidth || this._canvas.height !== fullHeight) {
      this._canvas.width = fullWidth;
      this._canvas.height = fullHeight;
    }
    this._canvas.getContext("2d", { alpha: false })?.drawImage(bitmap as never, x, y);
  }
}
