// Polygon and lasso: an outline on the frame. Its inside is selected, to be painted or measured.
// The camera does not move during drawing, because the points are pixels of the camera at the
// start. Lines are drawn in the same way.

import type { Point } from "../net/stroke";
import type { PointerSample } from "../ui/input";
import type { Outline, Tool } from "./tool";

export interface OutlineHost {
  /** Returns false if painting is not possible. In this case, the host has shown the reason. */
  beginOutline(at: PointerSample): boolean;
  /**
   * An area has at least three points, and a line has at least two points. `corners` is true if the
   * points were set one by one, so the user can change them.
   */
  finishOutline(path: Point[], corners: boolean): void;
  /** Called when an outline for which `beginOutline` returned true is finished or canceled. */
  outlineEnded(): void;
  /** The number of window pixels per CSS pixel. */
  scale(): number;
  outlineChanged(): void;
  /** The selection of finished outlines, if they are not used immediately. */
  readonly selection?: FinishedOutlines;
}

/** Finished outlines whose corners can be moved. */
export interface FinishedOutlines {
  /** Returns true if a corner that can be moved is at this position. */
  grab(at: PointerSample): boolean;
  drag(to: PointerSample): void;
  /** Ends the drag. If `keep` is false, the corner returns to its old position. */
  release(keep: boolean): void;
  key(key: string): boolean;
}

export const kMostPoints = 4096;
export const kSnapPx = 11; // in CSS pixels; a press within this distance of a point is on the point
const kSpacingPx = 2; // CSS pixels

export abstract class OutlineTool {
  protected points: Point[] = [];
  protected grabbed = false; // whether a corner of a finished outline is dragged
  private _spacing = kSpacingPx;

  constructor(
    protected readonly host: OutlineHost,
    private readonly _least = 3,
    protected readonly most = kMostPoints,
  ) {}

  get outline(): Outline | null {
    return this.points.length > 0
      ? { points: this.points, corners: [], pointer: null, closable: false, area: true }
      : null;
  }

  activate(): void {}
  deactivate(): void {
    this.giveUp();
  }

  /** Grabs a corner of a finished outline, if one is there. Otherwise a new outline can begin. */
  protected grab(at: PointerSample): boolean {
    this.grabbed = this.points.length === 0 && (this.host.selection?.grab(at) ?? false);
    return this.grabbed;
  }
  /** Drags a grabbed corner. Returns whether a corner is grabbed. */
  protected dragGrabbed(samples: PointerSample[]): boolean {
    const last = samples[samples.length - 1];
    if (this.grabbed && last) this.host.selection?.drag(last);
    return this.grabbed;
  }
  protected release(keep: boolean): boolean {
    const held = this.grabbed;
    this.grabbed = false;
    if (held) this.host.selection?.release(keep);
    return held;
  }

  protected begin(at: PointerSample): boolean {
    if (!this.host.beginOutline(at)) return false;
    this._spacing = kSpacingPx;
    this.points = [[at.x, at.y]];
    this.host.outlineChanged();
    return true;
  }

  /** Adds the points of the drag to the outline. */
  protected follow(samples: PointerSample[]): void {
    for (const { x, y } of samples) {
      const [lastX, lastY] = this.points[this.points.length - 1]!;
      if (Math.hypot(x - lastX, y - lastY) < this._spacing * this.host.scale()) continue;
      this.points.push([x, y]);
      if (this.points.length < this.most) continue;
      this.points = this.points.filter((_, index) => index % 2 === 0);
      this._spacing *= 2;
    }
    this.host.outlineChanged();
  }

  protected finish(): void {
    const path = this.points;
    this.giveUp();
    if (path.length >= this._least) this.host.finishOutline(path, this.setsCorners);
  }

  protected get setsCorners(): boolean {
    return false;
  }

  protected isAt(sample: PointerSample, [x, y]: Point): boolean {
    return Math.hypot(sample.x - x, sample.y - y) <= kSnapPx * this.host.scale();
  }

  protected giveUp(): void {
    if (this.points.length === 0) return;
    this.points = [];
    this.host.outlineEnded();
    this.host.outlineChanged();
  }
}

/** The lasso: a drag around the area to paint. */
export class LassoTool extends OutlineTool implements Tool {
  readonly name = "lasso";

  down(sample: PointerSample): void {
    if (!this.grab(sample)) this.begin(sample);
  }

  move(samples: PointerSample[]): void {
    if (!this.dragGrabbed(samples) && this.points.length > 0) this.follow(samples);
  }

  up(): void {
    if (!this.release(true)) this.finish();
  }
  cancel(): void {
    if (!this.release(false)) this.giveUp();
  }
  key(key: string): boolean {
    if (this.points.length === 0) return this.host.selection?.key(key) ?? false;
    if (key !== "Escape") return false;
    this.giveUp();
    return true;
  }
}

/** A tool for outlines that are set click by click, with a segment to the pointer. */
export abstract class PlacesTool extends OutlineTool {
  protected pointer: Point | null = null;

  hover(sample: PointerSample | null): void {
    this.pointer = sample ? [sample.x, sample.y] : null;
    if (this.points.length > 0) this.host.outlineChanged();
  }

  key(key: string): boolean {
    if (this.points.length === 0) return this.host.selection?.key(key) ?? false;
    if (key === "Escape") this.giveUp();
    else if (key === "Backspace" || key === "Delete") this.takeBack(this.points.length - 1);
    else if (key === "Enter") this.enter();
    else return false;
    return true;
  }

  protected enter(): void {
    this.finish();
  }
  /** Keeps only the first `points` points. */
  protected takeBack(points: number): void {
    if (points < 1) {
      this.giveUp();
      return;
    }
    this.points.length = Math.min(points, this.points.length);
    this.host.outlineChanged();
  }
}

/**
 * The polygon tool. A click sets a corner. A click on the first corner, a second click on the last
 * corner, or Enter closes the polygon.
 */
export class PolygonTool extends PlacesTool implements Tool {
  readonly name = "polygon";
  private _added = false; // whether the current press added a corner

  override get outline(): Outline | null {
    if (this.points.length === 0) return null;
    return {
      points: this.points,
      corners: this.points,
      pointer: this.pointer,
      closable: this.points.length >= 3,
      area: true,
    };
  }

  protected override get setsCorners(): boolean {
    return true;
  }

  down(sample: PointerSample): void {
    this._added = false;
    if (this.grab(sample)) return;
    this.pointer = [sample.x, sample.y];
    if (this.points.length === 0) {
      this._added = this.begin(sample);
      return;
    }
    const closes =
      this.isAt(sample, this.points[0]!) || this.isAt(sample, this.points[this.points.length - 1]!);
    if (closes) {
      if (this.points.length >= 3) this.finish();
      return;
    }
    if (this.points.length === this.most) return;
    this.points.push([sample.x, sample.y]);
    this._added = true;
    this.host.outlineChanged();
  }

  move(samples: PointerSample[]): void {
    if (this.dragGrabbed(samples)) return;
    const last = samples[samples.length - 1];
    if (last) this.hover(last);
  }
  up(): void {
    this.release(true);
  }

  /** Undoes the press of the first finger, because a second finger touched. */
  cancel(): void {
    this.release(false);
    if (this._added) this.takeBack(this.points.length - 1);
    this._added = false;
  }

  protected override enter(): void {
    if (this.points.length >= 3) this.finish();
  }
}
