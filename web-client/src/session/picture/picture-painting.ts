// The edits of a user on a picture. Each part is one edit, sent in the order of drawing. Strokes and
// areas are edits of a layer. Lines and points are edits of a record.

import type { EditResult } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import type { Api } from "../../net/api";
import type { DrawnPart, PicturePart } from "./picture-drawing";

/** A layer, and what an edit does in it. */
export interface PictureTarget {
  layer: Layer;
  paint: { value: number } | { erase: true };
}

export interface PicturePaintingHost {
  /** Whether the picture shows lines and points. Otherwise, those that are drawn stay over it. */
  showsMarks(): boolean;
  readonly api: Api;
  readonly modelId: string;
  /** Returns null if nothing can be painted, after showing the reason to the user. */
  target(erases: boolean): PictureTarget | null;
  showChange(texels: number | undefined, areaM2: number | undefined): void;
  failed(error: unknown): void;
  /** Returns whether the picture now shows all edits that were made before the call. */
  redraw(): Promise<boolean>;
  changed(): void;
}

export class PicturePainting {
  erases = false;
  /** The parts that the picture does not show yet. */
  waiting: readonly DrawnPart[] = [];
  private readonly _edits: (() => Promise<void>)[] = [];
  private readonly _made = new Set<PicturePart>();
  // The saved lines and points of this picture, if it does not show them itself.
  private _marks: DrawnPart[] = [];
  private _undoneMarks: DrawnPart[] = [];
  private _isSending = false;

  constructor(private readonly _host: PicturePaintingHost) {}

  /**
   * Paints or erases a part, which `send` does on the server. The part keeps its color while it is
   * waiting.
   */
  paint(
    { part, color }: DrawnPart,
    send: (target: PictureTarget) => Promise<EditResult | undefined>,
  ): void {
    const target = this._host.target(this.erases);
    if (!target) return;
    this.send({ part, color }, async () => {
      const edit = await send(target);
      this._host.showChange(edit?.texels_changed, edit?.area_m2);
    });
  }

  /** Draws a line or a point of a record. `send` returns whether it was saved. */
  mark(drawn: DrawnPart, send: () => Promise<boolean>): void {
    this._undoneMarks = [];
    this.send(drawn, async () => {
      if (!(await send())) this.forget([drawn.part]);
      else if (!this._host.showsMarks()) this._marks.push(drawn);
    });
  }

  /** Undoes or redoes this user's newest line or point, which `send` does on the server. */
  travelMarks(way: "undo" | "redo", send: () => Promise<void>): void {
    this.add(async () => {
      await send();
      const [from, to] =
        way === "undo" ? [this._marks, this._undoneMarks] : [this._undoneMarks, this._marks];
      const drawn = from.pop();
      if (!drawn) return;
      to.push(drawn);
      if (way === "undo") this.forget([drawn.part]);
      else this.waiting = [...this.waiting, drawn];
    });
  }

  /** Shows a part until it is in the picture. */
  private send(drawn: DrawnPart, send: () => Promise<void>): void {
    this.waiting = [...this.waiting, drawn];
    this.add(async () => {
      try {
        await send();
        this._made.add(drawn.part);
      } catch (error) {
        this.forget([drawn.part]);
        throw error;
      }
    });
  }

  /** Undoes or redoes this user's newest edit of the layer. */
  undo(layer: Layer): void {
    this.travel(layer, "undo");
  }
  redo(layer: Layer): void {
    this.travel(layer, "redo");
  }

  private travel(layer: Layer, op: "undo" | "redo"): void {
    const { api, modelId: model } = this._host;
    this.add(() =>
      api.send(`POST /models/{model}/layers/{layer}/${op}`, { path: { model, layer: layer.id } }),
    );
  }

  /** Forgets the parts of an earlier picture. They are still sent. */
  leavePicture(): void {
    this._marks = [];
    this._undoneMarks = [];
    this.forget(this.waiting.map(({ part }) => part));
  }

  /** Draws the picture again, and forgets the parts that it then shows. */
  async redraw(): Promise<void> {
    const kept = this._marks.map(({ part }) => part);
    const made = [...this._made].filter((part) => !kept.includes(part));
    if (await this._host.redraw()) this.forget(made);
    this._host.changed();
  }

  private forget(parts: readonly PicturePart[]): void {
    this.waiting = this.waiting.filter(({ part }) => !parts.includes(part));
    for (const part of parts) this._made.delete(part);
  }

  private add(edit: () => Promise<void>): void {
    this._edits.push(edit);
    this._host.changed();
    if (!this._isSending) void this.sendAll();
  }

  private async sendAll(): Promise<void> {
    this._isSending = true;
    for (let edit = this._edits.shift(); edit; edit = this._edits.shift()) {
      try {
        await edit();
      } catch (error) {
        this._host.failed(error);
      }
    }
    this._isSending = false;
    await this.redraw();
  }
}
