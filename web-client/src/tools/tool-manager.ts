// Keeps one tool active, and sends it the stage's drags.

import type { PointerSample } from "../ui/input";
import type { Outline } from "./tool";
import type { Tool, ToolName } from "./tool";

export class ToolManager {
  private readonly tools_ = new Map<ToolName, Tool>();
  private active_: Tool;
  private before_: Tool | null = null; // that another one is borrowed in place of
  private dragging_ = false;

  constructor(
    tools: readonly Tool[],
    first: ToolName,
    private readonly changed_: (name: ToolName) => void = () => {},
  ) {
    for (const tool of tools) this.tools_.set(tool.name, tool);
    this.active_ = this.find(first);
    this.active_.activate();
  }

  get active(): ToolName {
    return this.active_.name;
  }

  choose(name: ToolName): void {
    this.give_back();
    const tool = this.find(name);
    if (tool === this.active_) return;
    this.cancel();
    this.active_.deactivate();
    this.active_ = tool;
    tool.activate();
    this.changed_(name);
  }

  /** For one thing in between: the chosen tool stays as it is meanwhile. */
  borrow(name: ToolName): void {
    if (this.before_) return;
    this.cancel();
    this.before_ = this.active_;
    this.active_ = this.find(name);
    this.active_.activate();
    this.changed_(name);
  }

  /** The chosen tool is in hand again. */
  give_back(): void {
    const { before_: before, active_: borrowed } = this;
    if (!before) return;
    this.cancel();
    this.before_ = null;
    this.active_ = before;
    borrowed.deactivate();
    this.changed_(before.name);
  }

  get outline(): Outline | null {
    return this.active_.outline ?? null;
  }

  hover(sample: PointerSample | null): void {
    if (!this.dragging_) this.active_.hover?.(sample);
  }

  key(key: string): boolean {
    return this.active_.key?.(key) ?? false;
  }

  /** Ends what is under way. */
  stop(): void {
    this.cancel();
    this.give_back();
    this.active_.deactivate();
  }

  down(sample: PointerSample): void {
    this.dragging_ = true;
    this.active_.down(sample);
  }
  move(samples: PointerSample[]): void {
    if (this.dragging_) this.active_.move(samples);
  }
  up(): void {
    if (!this.dragging_) return;
    this.dragging_ = false;
    this.active_.up();
  }
  cancel(): void {
    if (!this.dragging_) return;
    this.dragging_ = false;
    this.active_.cancel();
  }

  private find(name: ToolName): Tool {
    const tool = this.tools_.get(name);
    if (!tool) throw new Error(`no tool named ${name}`);
    return tool;
  }
}
