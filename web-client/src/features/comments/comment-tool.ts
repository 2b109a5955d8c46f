// A tap starts a comment at its position. A drag rotates the model, so the user can bring the
// position into view first.

import type { PointerSample } from "../../ui/input";
import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";

export class CommentTool extends DragTool implements Tool {
  readonly name = "comment";

  constructor(
    navigator: Navigator,
    private readonly _middle: () => PointerSample,
  ) {
    super(navigator);
  }

  /** From the keyboard, starts a comment in the middle of the 3D view. */
  key(key: string): boolean {
    if (key !== "Enter") return false;
    this._navigator.tap(this._middle());
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this._navigator.orbit(dx, dy);
  }
}
