// A press fills the connected area under the pointer.

import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";

export class BucketTool implements Tool {
  readonly name = "bucket";

  constructor(private readonly _fillAt: (sample: PointerSample) => void) {}

  activate(): void {}
  deactivate(): void {}
  down(sample: PointerSample): void {
    this._fillAt(sample);
  }
  move(): void {}
  up(): void {}
  cancel(): void {}
}
