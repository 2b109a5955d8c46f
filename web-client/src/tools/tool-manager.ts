// Manages the active tool, and sends the drags on the stage to it.

import type { PointerSample } from "../ui/input";
import type { Outline } from "./tool";
import type { Tool, ToolName } from "./tool";

export class ToolManager {
  private readonly _tools = new Map<ToolName, Tool>();
  private _active: Tool;
  private _before: Tool | null = null; // the chosen tool while another tool is temporarily active
  private _dragging = false;

  constructor(
    tools: readonly Tool[],
    first: ToolName,
    private readonly _changed: (name: ToolName) => void = () => {},
  ) {
    for (const tool of tools) this._tools.set(tool.name, tool);
    this._active = this.find(first);
    this._active.activate();
  }

  get active(): ToolName {
    return this._active.name;
  }

  choose(name: ToolName): void {
    this.giveBack();
    const tool = this.find(name);
    if (tool === this._active) return;
    this.cancel();
    this._active.deactivate();
    this._active = tool;
    tool.activate();
    this._changed(name);
  }

  /** Activates another tool temporarily, until giveBack(). */
  borrow(name: ToolName): void {
    if (this._before) return;
    this.cancel();
    this._before = this._active;
    this._active = this.find(name);
    this._active.activate();
    this._changed(name);
  }

  /** Returns to the chosen tool. */
  giveBack(): void {
    const { _before: before, _active: borrowed } = this;
    if (!before) return;
    this.cancel();
    this._before = null;
    this._active = before;
    borrowed.deactivate();
    this._changed(before.name);
  }

  get outline(): Outline | null {
    return this._active.outline ?? null;
  }

  hover(sample: PointerSample | null): void {
    if (!this._dragging) this._active.hover?.(sample);
  }

  key(key: string, shift = false): boolean {
    return this._active.key?.(key, shift) ?? false;
  }

  /** Cancels the current action. */
  stop(): void {
    this.cancel();
    this.giveBack();
    this._active.deactivate();
  }

  down(sample: PointerSample): void {
    this._dragging = true;
    this._active.down(sample);
  }
  move(samples: PointerSample[]): void {
    if (this._dragging) this._active.move(samples);
  }
  up(): void {
    if (!this._dragging) return;
    this._dragging = false;
    this._active.up();
  }
  cancel(): void {
    if (!this._dragging) return;
    this._dragging = false;
    this._active.cancel();
  }

  private find(name: ToolName): Tool {
    const tool = this._tools.get(name);
    if (!tool) throw new Error(`no tool named ${name}`);
    return tool;
  }
}
