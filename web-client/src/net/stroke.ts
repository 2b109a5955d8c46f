// A stroke during drawing: its beginning, and the segments of its path that are sent to the server.

import { newId } from "../core/ids";
import type { CameraMessage } from "../math/camera";
import type { StrokeBegin, ToolShape } from "../core/protocol.gen";
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
 * A stroke during drawing. The server moves the brush from the last point of the previous batch.
 */
export class StrokeHandle {
  private _n = 0;
  private _ended = false;

  constructor(
    readonly stroke: string,
    private readonly _pathPoints: number,
    private readonly _change: (message: ChangeMessage) => void,
  ) {}

  /**
   * Adds points to the path. `widths` is the fraction of the brush radius at each point. Without
   * `widths`, the whole radius applies.
   */
  extend(points: readonly Point[], widths?: readonly number[]): void {
    if (this._ended || points.length === 0) return;
    for (let start = 0; start < points.length; start += this._pathPoints) {
      const path = points.slice(start, start + this._pathPoints);
      this._change({
        op: "stroke.extend",
        id: newId(),
        stroke: this.stroke,
        n: this._n++,
        path,
        ...(widths ? { widths: widths.slice(start, start + this._pathPoints) } : {}),
      });
    }
  }

  end(): void {
    if (this._ended) return;
    this._ended = true;
    this._change({ op: "stroke.end", id: newId(), stroke: this.stroke });
  }
}
