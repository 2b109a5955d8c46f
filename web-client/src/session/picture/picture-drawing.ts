// What a user draws on a picture: strokes of the brush, areas, lines and points. Points are in the unit of the
// picture, such as millimeters on an unrolled sheet or pixels of a photograph: x to the right, y up.

import type { MarkKind } from "../../domain/marks";

export type PicturePoint = [number, number];
/** Tools that paint a layer. */
export type PaintTool = "brush" | "area";
export type DrawingTool = PaintTool | MarkKind;
export type PictureTool = "move" | DrawingTool;
/** A finished stroke or area. */
export type PaintPart =
  { polygon: PicturePoint[] } | { stroke: { path: PicturePoint[]; radius: number } };
export type PicturePart = PaintPart | { line: PicturePoint[] } | { point: PicturePoint };

export const isPaint = (part: PicturePart): part is PaintPart =>
  "polygon" in part || "stroke" in part;

/** A finished part, and the color in which it is drawn. The color is null for parts that erase. */
export interface DrawnPart {
  part: PicturePart;
  color: string | null;
}

/** Where a picture is, in its unit. */
export interface PictureBox {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface PictureDrawingHost {
  tool(): PictureTool;
  radius(): number;
  /** Returns the distance below which a point counts as the first corner, and a drag as a click. */
  snap(): number;
  finished(part: PicturePart): void;
  changed(): void;
}

const kMostPoints = 4096; // of a stroke or an area, as in the contract
const kMostLinePoints = 1000;
const kLeastPoints: Record<DrawingTool, number> = { brush: 1, area: 3, line: 2, point: 1 };
const kStep = 0.1; // the least distance between two points of a drag, as a share of snap()
const kDigits = 4;

const rounded = (value: number): number => Number(value.toFixed(kDigits));
const apart = ([ax, ay]: PicturePoint, [bx, by]: PicturePoint): number =>
  Math.hypot(ax - bx, ay - by);

export class PictureDrawing {
  /** The points of the unfinished part. */
  path: PicturePoint[] = [];
  private _isDown = false;
  private _from = 0; // the number of points before the pointer was pressed

  constructor(private readonly _host: PictureDrawingHost) {}

  /** Whether an area or a line is begun whose corners the user sets one by one. */
  get hasCorners(): boolean {
    const tool = this._host.tool();
    return this.path.length > 0 && (tool === "area" || tool === "line");
  }

  down(at: PicturePoint): void {
    const tool = this._host.tool();
    if (tool === "move") return;
    const point = toStored(at);
    const { path } = this;
    const isAt = (end: PicturePoint | undefined): boolean =>
      end !== undefined && apart(end, point) <= this._host.snap();
    // The last point of a line is never set twice.
    if (tool === "line" && isAt(path[path.length - 1])) return this.finish();
    if (tool === "area" && path.length >= kLeastPoints.area && isAt(path[0])) return this.finish();
    if (tool === "brush" || tool === "point") this.path = [];
    this._isDown = true;
    this._from = this.path.length;
    this.add(point);
  }

  move(points: readonly PicturePoint[]): void {
    if (!this._isDown) return;
    const step = kStep * this._host.snap();
    for (const at of points) {
      const point = toStored(at);
      if (this._host.tool() === "point") this.path = [point];
      else if (apart(this.path[this.path.length - 1]!, point) >= step) this.add(point);
    }
  }

  up(): void {
    if (!this._isDown) return;
    this._isDown = false;
    const tool = this._host.tool();
    if (tool === "brush" || tool === "point") return this.finish();
    const pressed = this.path[this._from]!;
    const isClick = this.path
      .slice(this._from)
      .every((point) => apart(pressed, point) <= this._host.snap());
    if (isClick) this.path = this.path.slice(0, this._from + 1);
    // An outline that was drawn in one go closes itself, and such a line ends.
    else if (this._from === 0) this.finish();
    this._host.changed();
  }

  /** Finishes the stroke, the point, or the area or line if it has enough corners. */
  finish(): void {
    const { path } = this;
    const tool = this._host.tool();
    if (tool === "move" || path.length < kLeastPoints[tool]) return;
    this.discard();
    this._host.finished(this.partOf(tool, path));
  }

  private partOf(tool: DrawingTool, path: PicturePoint[]): PicturePart {
    switch (tool) {
      case "brush":
        return { stroke: { path, radius: this._host.radius() } };
      case "area":
        return { polygon: path };
      case "line":
        return { line: path };
      case "point":
        return { point: path[0]! };
    }
  }

  /** Removes the last corner, unless the pointer is drawing. */
  removeCorner(): void {
    if (this._isDown) return;
    this.path = this.path.slice(0, -1);
    this._host.changed();
  }

  /** Discards what was drawn since the pointer was pressed. Earlier corners stay. */
  cancelPress(): void {
    if (!this._isDown) return;
    this._isDown = false;
    this.path = this.path.slice(0, this._from);
    this._host.changed();
  }

  /** Discards the unfinished part. Returns whether there was one. */
  discard(): boolean {
    const isOpen = this.path.length > 0;
    this.path = [];
    this._isDown = false;
    this._host.changed();
    return isOpen;
  }

  private add(point: PicturePoint): void {
    const tool = this._host.tool();
    if (this.path.length === (tool === "line" ? kMostLinePoints : kMostPoints)) {
      if (tool !== "brush") return;
      // A longer stroke continues as another one.
      const last = this.path[kMostPoints - 1]!;
      this.finish();
      this._isDown = true;
      this.path = [last];
    }
    this.path = [...this.path, point];
    this._host.changed();
  }
}

const toStored = ([x, y]: PicturePoint): PicturePoint => [rounded(x), rounded(y)];
