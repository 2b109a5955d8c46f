// A tap takes the face of the surface that lies there. A drag turns the model: what is looked for
// may lie on its other side.

import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";

export interface FaceHost extends Navigator {
  take_in_middle(): void;
  give_up(): void;
}

export class FaceTool extends DragTool implements Tool {
  readonly name = "face";

  constructor(private readonly host_: FaceHost) {
    super(host_);
  }

  override deactivate(): void {
    this.host_.give_up();
  }

  key(key: string): boolean {
    if (key === "Enter")
      this.host_.take_in_middle(); // without a pointer
    else if (key === "Escape") this.host_.give_up();
    else return false;
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this.host_.orbit(dx, dy);
  }
}
