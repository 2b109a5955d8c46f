// A tap selects the surface that looks like the surface there. A drag rotates the model, because
// the selection may continue on its far side.

import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";
import type { PointerSample } from "../../ui/input";

export interface WandToolHost extends Pick<Navigator, "orbit" | "pan"> {
  selectAt(sample: PointerSample): void;
  /** Returns the middle of the view. */
  middle(): PointerSample;
  /** Handles a key of the selection. Returns false if nothing is selected. */
  selectionKey(key: string): boolean;
}

export class WandTool extends DragTool implements Tool {
  readonly name = "wand";

  constructor(private readonly _host: WandToolHost) {
    super({ ..._host, tap: (sample) => _host.selectAt(sample) });
  }

  key(key: string, shift = false): boolean {
    if (key !== "Enter") return this._host.selectionKey(key);
    if (shift) this._host.selectAt({ ...this._host.middle(), shift });
    else if (!this._host.selectionKey(key)) this._host.selectAt(this._host.middle());
    return true;
  }

  protected dragged(dx: number, dy: number): void {
    this._host.orbit(dx, dy);
  }
}
