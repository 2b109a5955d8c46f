// A click sets a point on the surface.

import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";

export class PointTool implements Tool {
  readonly name = "point";

  constructor(private readonly _setAt: (sample: PointerSample) => void) {}

  activate(): void {}
  deactivate(): void {}
  down(sample: PointerSample): void {
    this._setAt(sample);
  }
  move(): void {}
  up(): void {}
  cancel(): void {}
}
