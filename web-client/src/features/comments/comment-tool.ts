// A tap starts a comment at its place. A drag rotates the model, so that the user can reach the
// place first.

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

  /** Keyboard use: starts a comment in the middle of the picture. */
  key(key: string): boolean {
    if (key !== "Enter") return false;
    this._navigator.tap(this._middle());
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this._navigator.orbit(dx, dy);
  }
}
