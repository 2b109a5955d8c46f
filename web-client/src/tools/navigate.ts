// Tools that rotate and pan with the tool button.

import type { PointerSample } from "../ui/input";
import type { Tool } from "./tool";

/** Moves the camera and sends it to the server. */
export interface Navigator {
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  /** Handles a press and release at the same position. */
  tap(sample: PointerSample): void;
}

const kTapReach = 7; // window pixels; a mouse or pen may move by this distance in a tap

export abstract class DragTool {
  private _last: PointerSample | null = null;
  private _start: PointerSample | null = null; // null: dragged too far for a tap

  constructor(
    protected readonly _navigator: Navigator,
    /** The distance in window pixels from the press within which a release is a tap. */
    private readonly _tapReach: () => number = () => kTapReach,
  ) {}

  activate(): void {}
  deactivate(): void {}
  down(sample: PointerSample): void {
    this._last = this._start = sample;
  }
  move(samples: PointerSample[]): void {
    const now = samples[samples.length - 1];
    if (!now || !this._last) return;
    if (this._start && Math.hypot(now.x - this._start.x, now.y - this._start.y) > this._tapReach())
      this._start = null;
    this.dragged(now.x - this._last.x, now.y - this._last.y);
    this._last = now;
  }
  up(): void {
    if (this._start) this._navigator.tap(this._start);
    this.cancel();
  }
  cancel(): void {
    this._last = this._start = null;
  }

  protected abstract dragged(dx: number, dy: number): void;
}

export class OrbitTool extends DragTool implements Tool {
  readonly name = "orbit";
  protected dragged(dx: number, dy: number): void {
    this._navigator.orbit(dx, dy);
  }
}

export class PanTool extends DragTool implements Tool {
  readonly name = "pan";
  protected dragged(dx: number, dy: number): void {
    this._navigator.pan(dx, dy);
  }
}
