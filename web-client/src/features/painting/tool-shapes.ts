// The shapes that the brush can have beside round and square: tools of the site, made of pictures.
// All people share them.

import type { Api } from "../../net/api";
import { compare_words } from "../../core/locale";
import type { Tool, ToolEvent, ToolShape } from "../../core/protocol.gen";
import type { ShapePart } from "../../domain/shape";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";

export interface ToolShapesHost {
  chosen(): ToolShape;
  choose(shape: ToolShape): void;
  changed(): void;
}

export class ToolShapes {
  list: Tool[] = []; // by name
  private wanted_ = false;

  constructor(
    private readonly api_: Api,
    private readonly host_: ToolShapesHost,
  ) {}

  /** Somebody looks at them: from now on they are kept up to date. */
  want(): void {
    if (this.wanted_) return;
    this.wanted_ = true;
    this.refresh();
  }

  /** After a connection that was lost: what happened meanwhile was not told. */
  refresh(): void {
    if (!this.wanted_) return;
    this.api_.tools().then(
      (tools) => this.take(tools),
      (error: unknown) => notices.error(error),
    );
  }

  find(shape: ToolShape): Tool | undefined {
    return this.list.find((tool) => tool.id === shape);
  }

  async add(file: Blob, name: string, part: ShapePart): Promise<void> {
    const tool = await this.api_.create_tool(file, name, part);
    this.put(tool);
    this.host_.choose(tool.id);
  }

  async rename(tool: Tool, name: string): Promise<void> {
    this.put(await this.api_.rename_tool(tool.id, name));
  }

  async remove(tool: Tool): Promise<void> {
    if (this.host_.chosen() === tool.id) this.host_.choose("disc");
    await this.api_.delete_tool(tool.id);
    this.take(this.list.filter(({ id }) => id !== tool.id));
  }

  on_event({ event, tool_id, tool }: ToolEvent): void {
    if (event === "deleted") this.take(this.list.filter(({ id }) => id !== tool_id));
    else if (tool) this.put(tool);
  }

  private put(tool: Tool): void {
    this.take([...this.list.filter(({ id }) => id !== tool.id), tool]);
  }

  private take(tools: Tool[]): void {
    const before = this.find(this.host_.chosen());
    this.list = tools.sort((a, b) => compare_words(a.name, b.name));
    if (before && !this.find(before.id)) {
      this.host_.choose("disc");
      notices.show("info", texts.shapes.gone(before.name));
    }
    this.host_.changed();
  }
}

export const shape_picture = (tool: number): string => `/api/v1/tools/${tool}/picture`;
