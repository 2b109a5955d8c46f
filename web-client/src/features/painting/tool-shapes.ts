// Brush shapes from pictures. All users share the tools of the site.

import { kAsItIs, type Api } from "../../net/api";
import { compareWords } from "../../core/locale";
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
  list: Tool[] = []; // sorted by name
  private _wanted = false;

  constructor(
    private readonly _api: Api,
    private readonly _host: ToolShapesHost,
  ) {}

  /** Loads the shapes at the first use, and keeps them up to date afterwards. */
  want(): void {
    if (this._wanted) return;
    this._wanted = true;
    this.refresh();
  }

  /** Call this after a reconnection, because events may have been lost. */
  refresh(): void {
    if (!this._wanted) return;
    this._api.all("GET /tools", "tools").then(
      (tools) => this.take(tools),
      (error: unknown) => notices.error(error),
    );
  }

  find(shape: ToolShape): Tool | undefined {
    return this.list.find((tool) => tool.id === shape);
  }

  async add(file: Blob, name: string, part: ShapePart): Promise<void> {
    const tool = await this._api.json("POST /tools", {
      query: { name, part },
      body: file,
      type: file.type,
    });
    this.put(tool);
    this._host.choose(tool.id);
  }

  async rename(tool: Tool, name: string): Promise<void> {
    this.put(
      await this._api.json("PATCH /tools/{tool}", {
        path: { tool: tool.id },
        body: { name },
        header: kAsItIs,
      }),
    );
  }

  async remove(tool: Tool): Promise<void> {
    if (this._host.chosen() === tool.id) this._host.choose("disc");
    await this._api.send("DELETE /tools/{tool}", { path: { tool: tool.id }, header: kAsItIs });
    this.take(this.list.filter(({ id }) => id !== tool.id));
  }

  onEvent({ event, tool_id: toolId, tool }: ToolEvent): void {
    if (event === "deleted") this.take(this.list.filter(({ id }) => id !== toolId));
    else if (tool) this.put(tool);
  }

  private put(tool: Tool): void {
    this.take([...this.list.filter(({ id }) => id !== tool.id), tool]);
  }

  private take(tools: Tool[]): void {
    const before = this.find(this._host.chosen());
    this.list = tools.sort((a, b) => compareWords(a.name, b.name));
    if (before && !this.find(before.id)) {
      this._host.choose("disc");
      notices.show("info", texts.shapes.gone(before.name));
    }
    this._host.changed();
  }
}

export const shapePicture = (tool: number): string => `/api/v1/tools/${tool}/picture`;
