// Orbit and pan with the tool's button.

import type { PointerSample } from "../core/input";
import type { Tool } from "./tool";

/** What moves the camera and tells the server. */
export interface Navigator {
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
}

abstract class DragTool {
  private last_: PointerSample | null = null;

  activate(): void {}
  deactivate(): void {}
  down(sample: PointerSample): void {
    this.last_ = sample;
  }
  move(samples: PointerSample[]): void {
    const now = samples[samples.length - 1];
    if (!now || !this.last_) return;
    this.dragged(now.x - this.last_.x, now.y - this.last_.y);
    this.last_ = now;
  }
  up(): void {
    this.last_ = null;
  }
  cancel(): void {
    this.last_ = null;
  }

  protected abstract dragged(dx: number, dy: number): void;
}

export class OrbitTool extends DragTool implements Tool {
  readonly name = "orbit";
  constructor(private readonly navigator_: Navigator) {
    super();
  }
  protected dragged(dx: number, dy: number): void {
    this.navigator_.orbit(dx, dy);
  }
}

export class PanTool extends DragTool implements Tool {
  readonly name = "pan";
  constructor(private readonly navigator_: Navigator) {
    super();
  }
  protected dragged(dx: number, dy: number): void {
    this.navigator_.pan(dx, dy);
  }
}
