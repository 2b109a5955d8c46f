// Taps set the points of a measurement. A drag rotates the model, because the other end may be on
// its far side.

import type { PointerSample } from "../../ui/input";
import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";

export interface MeasureHost extends Navigator {
  /** Sets the pointer's position, or null after the pointer has left. */
  pointAt(sample: PointerSample | null): void;
  setInMiddle(): void;
  end(): void;
  takeBack(): void;
  clear(): void;
  /** Returns whether there are points, or a tap that is still being processed. */
  begun(): boolean;
}

export class MeasureTool extends DragTool implements Tool {
  readonly name = "measure";

  constructor(private readonly _host: MeasureHost) {
    super(_host);
  }

  override deactivate(): void {
    this._host.clear();
  }

  hover(sample: PointerSample | null): void {
    this._host.pointAt(sample);
  }

  key(key: string): boolean {
    if (key === "m" || key === "M")
      this._host.setInMiddle(); // the keyboard command
    else if (!this._host.begun()) return false;
    else if (key === "Enter") this._host.end();
    else if (key === "Backspace" || key === "Delete") this._host.takeBack();
    else if (key === "Escape") this._host.clear();
    else return false;
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this._host.orbit(dx, dy);
  }
}
