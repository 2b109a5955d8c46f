// A stroke during drawing: its beginning, and the segments of its path that are sent to the server.

import { newId } from "../core/ids";
import type { CameraMessage } from "../math/camera";
import type { StrokeBegin, ToolShape } from "../core/protocol.gen";
import type { BatchFlow } from "./batch-flow";
import type { ChangeMessage } from "./outbox";

export type Point = [number, number];

export interface StrokeOptions {
  layer: number | string;
  value: number;
  erase: boolean;
  camera: CameraMessage;
  radius: { px: number } | { mm: number };
  shape: ToolShape;
  through: boolean;
  max_angle_deg?: number;
}

export const beginOf = (options: StrokeOptions): StrokeBegin => ({
  op: "stroke.begin",
  id: newId(),
  stroke: newId(),
  layer: options.layer,
  ...(options.erase ? { erase: true } : { value: options.value }),
  camera: options.camera,
  ...("px" in options.radius ? { radius_px: options.radius.px } : { radius_mm: options.radius.mm }),
  shape: options.shape,
  ...(options.through ? { through: true } : {}),
  ...(options.max_angle_deg === undefined ? {} : { max_angle_deg: options.max_angle_deg }),
});

/**
 * After this time, waiting points are sent in any case. So the page also stores them, and continues
 * if a reply is lost.
 */
export const kLongestWaitMs = 250;

/**
 * A stroke during drawing. The server moves the brush from the last point of the previous batch.
 * While the server does not keep up, further points wait and become one batch. So painters see their
 * paint sooner on a busy server.
 */
export class StrokeHandle {
  private _n = 0;
  private _ended = false;
  private _points: Point[] = []; // not sent yet
  private _widths: number[] = []; // of these points
  private _timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    readonly stroke: string,
    private readonly _pathPoints: number,
    private readonly _flow: Pick<BatchFlow, "isBehind">,
    private readonly _change: (message: ChangeMessage) => void,
  ) {}

  /**
   * Adds points to the path, which may wait until the server keeps up. `widths` is the fraction of
   * the brush radius at each point. Without `widths`, the whole radius applies.
   */
  extend(points: readonly Point[], widths?: readonly number[]): void {
    if (this._ended || points.length === 0) return;
    this._points.push(...points);
    this._widths.push(...(widths ?? points.map(() => 1)));
    this.proceed();
  }

  /** Sends the waiting points if the server keeps up. */
  proceed(): void {
    if (this._points.length === 0) return;
    if (!this._flow.isBehind) this.send();
    else this._timer ??= setTimeout(() => this.send(), kLongestWaitMs);
  }

  end(): void {
    if (this._ended) return;
    this.send();
    this._ended = true;
    this._change({ op: "stroke.end", id: newId(), stroke: this.stroke });
  }

  private send(): void {
    clearTimeout(this._timer);
    this._timer = undefined;
    const [points, widths] = [this._points, this._widths];
    this._points = [];
    this._widths = [];
    for (let start = 0; start < points.length; start += this._pathPoints) {
      const part = widths.slice(start, start + this._pathPoints);
      this._change({
        op: "stroke.extend",
        id: newId(),
        stroke: this.stroke,
        n: this._n++,
        path: points.slice(start, start + this._pathPoints),
        ...(part.some((width) => width !== 1) ? { widths: part } : {}),
      });
    }
  }
}
