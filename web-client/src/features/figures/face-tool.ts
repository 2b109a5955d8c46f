// A tap picks the face at the pointer. A drag rotates the model, because the face may be on its
// other side.

import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";

export interface FaceHost extends Navigator {
  takeInMiddle(): void;
  giveUp(): void;
}

export class FaceTool extends DragTool implements Tool {
  readonly name = "face";

  constructor(private readonly _host: FaceHost) {
    super(_host);
  }

  override deactivate(): void {
    this._host.giveUp();
  }

  key(key: string): boolean {
    if (key === "Enter")
      this._host.takeInMiddle(); // the keyboard command
    else if (key === "Escape") this._host.giveUp();
    else return false;
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this._host.orbit(dx, dy);
  }
}
