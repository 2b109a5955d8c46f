// Brush, eraser, and the brush of the wand. The points of a drag are passed on as one batch for each
// animation frame. For brush and eraser, they become a stroke in the selected layer (net/stroke).

import type { Point } from "../../net/stroke";
import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";

/** What a drag draws. */
export interface Drawn {
  /** `widths` is the share of the brush's radius at each point. */
  extend(points: readonly Point[], widths: readonly number[]): void;
  end(): void;
}

export interface BrushHost {
  /**
   * Returns null if painting is not possible. In this case, the host has shown the reason to the
   * user.
   */
  beginStroke(at: PointerSample): Drawn | null;
  strokeEnded(): void;
  /**
   * Returns the radius in window pixels at the pointer. The tool omits points that are closer than
   * a tenth of this radius to the previous point.
   */
  radiusPx(): number;
  /** Returns the brush's radius at this pen pressure, as a share of the full radius. */
  widthOf(pressure: number): number;
  nextFrame(callback: () => void): void;
}

const kWidthStep = 0.1; // as a share of the radius

export class BrushTool implements Tool {
  private _stroke: Drawn | null = null;
  private _waiting: Point[] = [];
  private _widths: number[] = []; // the widths of the waiting points
  private _last: Point | null = null; // the last point of the stroke
  private _newest: Point | null = null; // the pointer's position
  private _newestWidth = 1;
  private _lastWidth = 1;
  private _scheduled = false;

  constructor(
    readonly name: "brush" | "eraser" | "wand",
    private readonly _host: BrushHost,
  ) {}

  activate(): void {}
  deactivate(): void {
    this.finish();
  }

  down(sample: PointerSample): void {
    this.finish();
    this._stroke = this._host.beginStroke(sample);
    if (!this._stroke) return;
    this._waiting = [];
    this._widths = [];
    this.see(sample);
    this.take();
    this.flush();
  }

  move(samples: PointerSample[]): void {
    if (!this._stroke || !this._last) return;
    const spacing = Math.max(0.5, this._host.radiusPx() * 0.1);
    for (const sample of samples) {
      this.see(sample);
      // a change of pressure adds a point even without a movement
      const pressed = Math.abs(this._newestWidth - this._lastWidth) >= kWidthStep;
      if (pressed || Math.hypot(sample.x - this._last[0], sample.y - this._last[1]) >= spacing)
        this.take();
    }
    this.schedule();
  }

  private see({ x, y, pressure }: PointerSample): void {
    this._newest = [x, y];
    this._newestWidth = pressure === undefined ? 1 : this._host.widthOf(pressure);
  }
  private take(): void {
    if (!this._newest) return;
    this._last = this._newest;
    this._waiting.push(this._last);
    this._widths.push(this._newestWidth);
    this._lastWidth = this._newestWidth;
  }

  up(): void {
    this.finish();
  }

  /** Ends the stroke. The painted part remains, and the user can undo it. */
  cancel(): void {
    this.finish();
  }

  private schedule(): void {
    if (this._scheduled || this._waiting.length === 0) return;
    this._scheduled = true;
    this._host.nextFrame(() => {
      this._scheduled = false;
      this.flush();
    });
  }

  private flush(): void {
    if (this._waiting.length === 0) return;
    this._stroke?.extend(this._waiting, this._widths);
    this._waiting = [];
    this._widths = [];
  }

  private finish(): void {
    if (!this._stroke) return;
    if (this._newest !== this._last) this.take();
    this.flush();
    this._stroke.end();
    this._stroke = null;
    this._last = this._newest = null;
    this._host.strokeEnded();
  }
}
