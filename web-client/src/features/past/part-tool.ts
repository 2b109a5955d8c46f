// A drag around the part of the surface to restore.

import { OutlineTool, type OutlineHost } from "../../tools/outline";
import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";

export interface PartHost extends OutlineHost {
  /** Runs when the user stops drawing without a part. */
  giveUp(): void;
}

export class PartTool extends OutlineTool implements Tool {
  readonly name = "part";

  constructor(private readonly _part: PartHost) {
    super(_part);
  }

  down(sample: PointerSample): void {
    this.begin(sample);
  }
  move(samples: PointerSample[]): void {
    if (this.points.length > 0) this.follow(samples);
  }
  up(): void {
    this.finish();
  }
  cancel(): void {
    this.giveUp();
  }
  key(key: string): boolean {
    if (key !== "Escape") return false;
    this.giveUp();
    this._part.giveUp();
    return true;
  }
}
