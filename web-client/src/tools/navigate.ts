// Orbit and pan with the tool's button.

import type { PointerSample } from "../ui/input";
import type { Tool } from "./tool";

/** What moves the camera and tells the server. */
export interface Navigator {
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  /** Pressed and let go in one place. */
  tap(sample: PointerSample): void;
}

const kTapReach = 7; // window pixels that a hand with a mouse or pen trembles

export abstract class DragTool {
  private last_: PointerSample | null = null;
  private start_: PointerSample | null = null; // null: it was dragged away from there

  constructor(
    protected readonly navigator_: Navigator,
    /** Window pixels from where it was pressed that are still a tap. */
    private readonly tap_reach_: () => number = () => kTapReach,
  ) {}

  activate(): void {}
  deactivate(): void {}
  down(sample: PointerSample): void {
    this.last_ = this.start_ = sample;
  }
  move(samples: PointerSample[]): void {
    const now = samples[samples.length - 1];
    if (!now || !this.last_) return;
    if (this.start_ && Math.hypot(now.x - this.start_.x, now.y - this.start_.y) > this.tap_reach_())
      this.start_ = null;
    this.dragged(now.x - this.last_.x, now.y - this.last_.y);
    this.last_ = now;
  }
  up(): void {
    if (this.start_) this.navigator_.tap(this.start_);
    this.cancel();
  }
  cancel(): void {
    this.last_ = this.start_ = null;
  }

  protected abstract dragged(dx: number, dy: number): void;
}

export class OrbitTool extends DragTool implements Tool {
  readonly name = "orbit";
  protected dragged(dx: number, dy: number): void {
    this.navigator_.orbit(dx, dy);
  }
}

export class PanTool extends DragTool implements Tool {
  readonly name = "pan";
  protected dragged(dx: number, dy: number): void {
    this.navigator_.pan(dx, dy);
  }
}
