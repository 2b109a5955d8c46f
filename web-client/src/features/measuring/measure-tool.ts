// Taps set places that are measured between. A drag turns the model, as with comments: the far end
// of what is measured may lie on its other side.

import type { PointerSample } from "../../ui/input";
import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";

export interface MeasureHost extends Navigator {
  /** Where the next place would be; null: the pointer left. */
  point_at(sample: PointerSample | null): void;
  set_in_middle(): void;
  end(): void;
  take_back(): void;
  clear(): void;
  /** There are places, or one is on its way. */
  begun(): boolean;
}

export class MeasureTool extends DragTool implements Tool {
  readonly name = "measure";

  constructor(private readonly host_: MeasureHost) {
    super(host_);
  }

  override deactivate(): void {
    this.host_.clear();
  }

  hover(sample: PointerSample | null): void {
    this.host_.point_at(sample);
  }

  key(key: string): boolean {
    if (key === "m" || key === "M")
      this.host_.set_in_middle(); // without a pointer
    else if (!this.host_.begun()) return false;
    else if (key === "Enter") this.host_.end();
    else if (key === "Backspace" || key === "Delete") this.host_.take_back();
    else if (key === "Escape") this.host_.clear();
    else return false;
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this.host_.orbit(dx, dy);
  }
}
