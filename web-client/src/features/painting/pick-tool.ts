// Shows the values under a point. A click sets the brush to the selected layer's value.

import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";

export class PickTool implements Tool {
  readonly name = "pick";

  constructor(private readonly _picked: (sample: PointerSample) => void) {}

  activate(): void {}
  deactivate(): void {}
  down(sample: PointerSample): void {
    this._picked(sample);
  }
  move(samples: PointerSample[]): void {
    const last = samples[samples.length - 1];
    if (last) this._picked(last);
  }
  up(): void {}
  cancel(): void {}
}
