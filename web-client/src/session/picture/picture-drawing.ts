// What a user draws on a picture: strokes of the brush, and areas. Points are in the unit of the
// picture, such as millimeters on an unrolled sheet or pixels of a photograph: x to the right, y up.

export type PicturePoint = [number, number];
export type PictureTool = "move" | "brush" | "area";
/** A finished stroke or area. */
export type PicturePart =
  { polygon: PicturePoint[] } | { stroke: { path: PicturePoint[]; radius: number } };

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

  /** Whether an area is begun whose corners the user sets one by one. */
  get hasCorners(): boolean {
    return this.path.length > 0 && this._host.tool() === "area";
  }

  down(at: PicturePoint): void {
    const tool = this._host.tool();
    if (tool === "move") return;
    const point = toStored(at);
    const { path } = this;
    if (tool === "area" && path.length > 2 && apart(path[0]!, point) <= this._host.snap())
      return this.finish();
    if (tool === "brush") this.path = [];
    this._isDown = true;
    this._from = this.path.length;
    this.add(point);
  }

  move(points: readonly PicturePoint[]): void {
    if (!this._isDown) return;
    const step = kStep * this._host.snap();
    for (const at of points) {
      const point = toStored(at);
      if (apart(this.path[this.path.length - 1]!, point) >= step) this.add(point);
    }
  }

  up(): void {
    if (!this._isDown) return;
    this._isDown = false;
    if (this._host.tool() === "brush") return this.finish();
    const pressed = this.path[this._from]!;
    const isClick = this.path
      .slice(this._from)
      .every((point) => apart(pressed, point) <= this._host.snap());
    if (isClick) this.path = this.path.slice(0, this._from + 1);
    // An outline that was drawn in one go closes itself.
    else if (this._from === 0 && this.path.length > 2) return this.finish();
    this._host.changed();
  }

  /** Finishes the stroke, or closes the area if it has three corners. */
  finish(): void {
    const { path } = this;
    const isStroke = this._host.tool() === "brush";
    if (path.length < (isStroke ? 1 : 3)) return;
    this.discard();
    this._host.finished(
      isStroke ? { stroke: { path, radius: this._host.radius() } } : { polygon: path },
    );
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
    if (this.path.length === kMostPoints) {
      if (this._host.tool() !== "brush") return;
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
