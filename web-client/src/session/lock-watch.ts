// Whether the chosen layer may be changed with the tool in hand, and who tries to is told why not.

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
  /** What is being painted has come to nothing. */
  stop(): void;
}

export class LockWatch {
  // the layer of which the person knows that it is locked
  private _told: number | null = null;

  constructor(private readonly _host: LockWatchHost) {}

  /**
   * To this person: curators change locked layers, too, but for those that are as they were
   * computed.
   */
  isLocked(layer: Layer): boolean {
    return layer.locked && (!this._host.canCurate() || isAsComputed(layer));
  }

  /** The chosen layer, where a tool is in hand that would change its texels but may not. */
  get target(): Layer | null {
    const selected = this._host.selected();
    const tool = this._host.tool();
    const paints = kPaintingTools.includes(tool) && !kMarkingTools.includes(tool);
    return paints && selected && this.isLocked(selected) ? selected : null;
  }

  /** Who cannot paint any more is told so once, before they try. */
  lookAgain(): void {
    const { target } = this;
    const told = this._told;
    this._told = target?.id ?? null;
    if (!target || target.id === told) return;
    this._host.stop();
    this.tell(target);
  }

  /** Painting that was on its way when the layer was locked is refused: told in the same words. */
  explains({ status, field }: Pick<ProblemMessage, "status" | "field">): boolean {
    const selected = this._host.selected();
    if (status !== 403 || field !== "layer" || !selected || !this.isLocked(selected)) return false;
    this.tell(selected);
    return true;
  }

  /** In the words that the page has for it, whoever noticed: one notice stands for all. */
  private tell(layer: Layer): void {
    notices.show("problem", texts.layers.locked, whyLocked(layer));
  }
}
