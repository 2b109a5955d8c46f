// A tap selects the surface that looks like the surface there. A drag rotates the model, because
// the selection may continue on its far side. With the brush, a drag selects the similar surface
// that the brush passes.

import { DragTool, type Navigator } from "../../tools/navigate";
import type { Tool } from "../../tools/tool";
import type { PointerSample } from "../../ui/input";
import { type BrushHost, BrushTool } from "./brush-tool";

export interface WandToolHost extends Pick<Navigator, "orbit" | "pan"> {
  selectAt(sample: PointerSample): void;
  /** The tool becomes active, or another tool does. */
  active(isActive: boolean): void;
  /** Whether a drag selects with the brush. */
  brushes(): boolean;
  readonly brush: BrushHost;
  /** Returns the middle of the view. */
  middle(): PointerSample;
  /** Handles a key of the selection. Returns false if nothing is selected. */
  selectionKey(key: string): boolean;
}

export class WandTool extends DragTool implements Tool {
  readonly name = "wand";

  private readonly _brush: BrushTool;

  constructor(private readonly _host: WandToolHost) {
    super({ ..._host, tap: (sample) => _host.selectAt(sample) });
    this._brush = new BrushTool(this.name, _host.brush);
  }

  override activate(): void {
    this._host.active(true);
  }
  override deactivate(): void {
    this._brush.deactivate();
    this._host.active(false);
  }
  override down(sample: PointerSample): void {
    if (this._host.brushes()) this._brush.down(sample);
    else super.down(sample);
  }
  override move(samples: PointerSample[]): void {
    this._brush.move(samples);
    super.move(samples);
  }
  override up(): void {
    this._brush.up();
    super.up();
  }
  override cancel(): void {
    this._brush.cancel();
    super.cancel();
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
