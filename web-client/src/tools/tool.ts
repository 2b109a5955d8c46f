// A tool is what the left button, the pen or one finger does on the stage.

import type { PointerSample } from "../core/input";

export type ToolName = "orbit" | "pan" | "brush" | "eraser" | "pick";

export interface Tool {
  readonly name: ToolName;
  activate(): void;
  deactivate(): void;
  down(sample: PointerSample): void;
  move(samples: PointerSample[]): void;
  up(): void;
  /** Ends what `down` began without finishing it. */
  cancel(): void;
}
