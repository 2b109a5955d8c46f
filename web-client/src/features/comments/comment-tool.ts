// A tap begins a comment at its place. A drag turns the model, as to the place that is meant one
// has to come first.

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

  /** Without a pointer, in the middle of what is seen. */
  key(key: string): boolean {
    if (key !== "Enter") return false;
    this._navigator.tap(this._middle());
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this._navigator.orbit(dx, dy);
  }
}
