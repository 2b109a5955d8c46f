// What a user draws on an unrolled sheet: strokes of the brush, and areas. Points are in millimeters
// on the sheet, as in the contract: x to the right, y up.

import type { RolloutSheet, SheetPoint, Unrolled, Within } from "../../core/protocol.gen";

export type SheetTool = "move" | "brush" | "area";
/** A finished stroke or area. */
export type SheetPart = Pick<Unrolled, "polygons"> | Pick<Unrolled, "strokes">;

/** A finished part, and the color in which it is drawn. The color is null for parts that erase. */
export interface DrawnPart {
  part: SheetPart;
  color: string | null;
}

/** Where a picture of the sheet is on the sheet, in millimeters. */
export interface SheetBox {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface SheetDrawingHost {
  tool(): SheetTool;
  radiusMm(): number;
  /** Returns the distance below which a point counts as the first corner, and a drag as a click. */
  snapMm(): number;
  finished(part: SheetPart): void;
  changed(): void;
}

const kMostPoints = 4096; // of a stroke or an area, as in the contract
const kStep = 0.1; // the least distance between two points of a drag, as a share of snapMm()
const kDigits = 4;

const rounded = (mm: number): number => Number(mm.toFixed(kDigits));
const apart = ([ax, ay]: SheetPoint, [bx, by]: SheetPoint): number => Math.hypot(ax - bx, ay - by);

/** Returns the box of a picture with the given size. */
export function sheetBox(
  sheet: RolloutSheet,
  mmPerPixel: number,
  [columns, rows]: readonly [number, number],
): SheetBox {
  const mmPerUnit = sheet.mm_per_pixel / sheet.units_per_pixel;
  return {
    left: sheet.left * mmPerUnit,
    top: sheet.top * mmPerUnit,
    width: columns * mmPerPixel,
    height: rows * mmPerPixel,
  };
}

/** Whether two responses describe the same sheet, so that parts of one belong to the other. */
export const isSameSheet = (a: RolloutSheet, b: RolloutSheet): boolean =>
  JSON.stringify(a) === JSON.stringify(b);

/**
 * Returns the area of a part in the contract's format, on the sheet of a response. The fitted values
 * are fixed, so the sheet stays the same.
 */
export function withinSheet(sheet: RolloutSheet, part: SheetPart): Within {
  const { axis, shape, radius, side, from, to } = sheet;
  return {
    unrolled: {
      axis,
      // The server finds the same cross section again.
      ...(shape === "general_cylinder"
        ? { shape }
        : { radius, ...(shape === "cone" ? { half_angle: sheet.half_angle } : {}) }),
      side,
      // The middle of the gap, or the end of a wall that goes all around.
      cut: ((from + to) / 2 + 180) % 360,
      ...part,
    },
  };
}

export class SheetDrawing {
  /** The points of the unfinished part. */
  path: SheetPoint[] = [];
  private _isDown = false;
  private _from = 0; // the number of points before the pointer was pressed

  constructor(private readonly _host: SheetDrawingHost) {}

  /** Whether an area is begun whose corners the user sets one by one. */
  get hasCorners(): boolean {
    return this.path.length > 0 && this._host.tool() === "area";
  }

  down(at: SheetPoint): void {
    const tool = this._host.tool();
    if (tool === "move") return;
    const point = toStored(at);
    const { path } = this;
    if (tool === "area" && path.length > 2 && apart(path[0]!, point) <= this._host.snapMm())
      return this.finish();
    if (tool === "brush") this.path = [];
    this._isDown = true;
    this._from = this.path.length;
    this.add(point);
  }

  move(points: readonly SheetPoint[]): void {
    if (!this._isDown) return;
    const step = kStep * this._host.snapMm();
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
      .every((point) => apart(pressed, point) <= this._host.snapMm());
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
      isStroke ? { strokes: [{ path, radius_mm: this._host.radiusMm() }] } : { polygons: [path] },
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

  private add(point: SheetPoint): void {
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

const toStored = ([x, y]: SheetPoint): SheetPoint => [rounded(x), rounded(y)];
