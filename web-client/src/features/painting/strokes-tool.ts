// Short strokes inside and outside of the area to select. The tool is loaded before the strokes.

import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";
import type { Strokes } from "./strokes";

export interface StrokesToolHost {
  /** Returns null until the strokes are loaded. */
  strokes(): Strokes | null;
}

export class StrokesTool implements Tool {
  readonly name = "strokes";

  constructor(private readonly _host: StrokesToolHost) {}

  activate(): void {}
  deactivate(): void {
    this._host.strokes()?.leave();
  }
  down(sample: PointerSample): void {
    this._host.strokes()?.down(sample);
  }
  move(samples: PointerSample[]): void {
    this._host.strokes()?.move(samples);
  }
  up(): void {
    this._host.strokes()?.up();
  }
  cancel(): void {
    this._host.strokes()?.cancel();
  }
  key(key: string): boolean {
    return this._host.strokes()?.key(key) ?? false;
  }
}
