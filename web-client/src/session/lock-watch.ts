// Decides whether the active tool may change the selected layer, and explains a refusal.

import type { ProblemMessage } from "../core/protocol.gen";
import { isAsComputed, type Layer } from "../core/types";
import { texts } from "../texts";
import { kMarkingTools, kPaintingTools, type ToolName } from "../tools/tool";
import { notices } from "../ui/notices";
import { whyLocked } from "./layer-lock";

export interface LockWatchHost {
  selected(): Layer | null;
  tool(): ToolName;
  canCurate(): boolean;
  /** Cancels the current stroke. */
  stop(): void;
}

export class LockWatch {
  // The id of the layer in the last notice.
  private _told: number | null = null;

  constructor(private readonly _host: LockWatchHost) {}

  /**
   * Whether the layer is locked for this user. Curators may change locked layers, except layers
   * that still have their computed values.
   */
  isLocked(layer: Layer): boolean {
    return layer.locked && (!this._host.canCurate() || isAsComputed(layer));
  }

  /** The selected layer, if the active tool would change its texels but may not. */
  get target(): Layer | null {
    const selected = this._host.selected();
    const tool = this._host.tool();
    const paints = kPaintingTools.includes(tool) && !kMarkingTools.includes(tool);
    return paints && selected && this.isLocked(selected) ? selected : null;
  }

  /** Shows one notice for each locked layer, before the user tries to paint. */
  lookAgain(): void {
    const { target } = this;
    const told = this._told;
    this._told = target?.id ?? null;
    if (!target || target.id === told) return;
    this._host.stop();
    this.tell(target);
  }

  /**
   * Shows the notice about the lock if the server refused a stroke for this reason. Returns whether
   * it showed the notice.
   */
  explains({ status, field }: Pick<ProblemMessage, "status" | "field">): boolean {
    const selected = this._host.selected();
    if (status !== 403 || field !== "layer" || !selected || !this.isLocked(selected)) return false;
    this.tell(selected);
    return true;
  }

  /** Shows the notice. Its text is always the same, so repeated notices are merged. */
  private tell(layer: Layer): void {
    notices.show("problem", texts.layers.locked, whyLocked(layer));
  }
}
