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
  /** Returns null if new points stay where they are set, with straight segments between them. */
  edges?(): EdgeSnapping | null;
  /** The selection of finished outlines, if they are not used immediately. */
  readonly selection?: FinishedOutlines;
}

/** Moves points to edges in the picture, and follows edges from point to point. */
export interface EdgeSnapping {
  /**
   * Returns the place of the strongest edge near a position. `from` is the previous point. Returns
   * the position itself if no edge is near, or if edges cannot be followed as far as there.
   */
  placeAt(at: Point, from: Point | null): Point;
  /** Returns the points of the edge between two points. Returns none for a straight segment. */
  between(from: Point, to: Point): Point[];
  /** Returns an outline on edges near a closed outline that was drawn freely. */
  around(outline: readonly Point[]): Point[];
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
    const { points: path, setsCorners } = this;
    this.giveUp();
    if (path.length >= this._least) this.host.finishOutline(this.fitted(path), setsCorners);
  }

  /** Returns the outline to use for a drawn one. */
  protected fitted(drawn: Point[]): Point[] {
    return drawn;
  }

  protected get setsCorners(): boolean {
    return false;
  }

  protected isAt(at: Point, [x, y]: Point): boolean {
    return Math.hypot(at[0] - x, at[1] - y) <= kSnapPx * this.host.scale();
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

  protected override fitted(drawn: Point[]): Point[] {
    const around = this.host.edges?.()?.around(drawn) ?? drawn;
    return around.length <= this.most ? around : drawn;
  }
}

/** A point that was set by a click. */
interface Corner {
  at: Point;
  /** The point before the segment that leads to the corner. Null for the first corner. */
  after: Point | null;
}

/**
 * A tool for outlines that are set click by click, with a segment to the pointer. The segments are
 * straight, or follow edges of the picture.
 */
export abstract class PlacesTool extends OutlineTool {
  protected pointer: Point | null = null;
  private _corners: Corner[] = [];

  protected get corners(): Point[] {
    return this._corners.map(({ at }) => at);
  }

  hover(sample: PointerSample | null): void {
    this.pointer = sample ? [sample.x, sample.y] : null;
    if (this.points.length > 0) this.host.outlineChanged();
  }

  key(key: string): boolean {
    if (this.points.length === 0) return this.host.selection?.key(key) ?? false;
    if (key === "Escape") this.giveUp();
    else if (key === "Backspace" || key === "Delete") this.takeBackLast();
    else if (key === "Enter") this.enter();
    else return false;
    return true;
  }

  protected enter(): void {
    this.finish();
  }

  protected override begin(sample: PointerSample): boolean {
    const [x, y] = this.snapped([sample.x, sample.y]);
    if (!super.begin({ ...sample, x, y })) return false;
    this._corners = [{ at: this.points[0]!, after: null }];
    return true;
  }

  /** Adds a corner, and before it the points of the edge that leads to it. */
  protected addCorner(at: Point): void {
    const after = this.points[this.points.length - 1]!;
    this.points.push(...this.edgeTo(at), at);
    this._corners.push({ at, after });
    this.host.outlineChanged();
  }

  /** Returns the place of a corner that is set at this position. */
  protected snapped(at: Point): Point {
    const last = this.points[this.points.length - 1];
    return this.host.edges?.()?.placeAt(at, last ?? null) ?? at;
  }

  /** Returns the points between the last point and this one. */
  protected edgeTo(at: Point): Point[] {
    const last = this.points[this.points.length - 1];
    const edge = (last && this.host.edges?.()?.between(last, at)) ?? [];
    return this.points.length + edge.length < this.most ? edge : [];
  }

  /** Removes the last corner with the segment that leads to it, or a point that was drawn. */
  private takeBackLast(): void {
    const last = this._corners[this._corners.length - 1];
    const isCorner = last?.at === this.points[this.points.length - 1];
    const after = isCorner && last?.after ? this.points.lastIndexOf(last.after) : -1;
    this.takeBack(after >= 0 ? after + 1 : this.points.length - 1);
  }

  /** Keeps only the first `points` points. */
  protected takeBack(points: number): void {
    if (points < 1) {
      this.giveUp();
      return;
    }
    this.points.length = Math.min(points, this.points.length);
    const left = new Set(this.points);
    this._corners = this._corners.filter(({ at }) => left.has(at));
    this.host.outlineChanged();
  }

  protected override giveUp(): void {
    this._corners = [];
    super.giveUp();
  }
}

/**
 * The polygon tool. A click sets a corner. A click on the first corner, a second click on the last
 * corner, or Enter closes the polygon.
 */
export class PolygonTool extends PlacesTool implements Tool {
  readonly name = "polygon";
  private _before: number | null = null; // points before the corner of the current press

  override get outline(): Outline | null {
    const { points, corners } = this;
    if (points.length === 0) return null;
    const pointer = this.pointer && this.target(this.pointer);
    return {
      points,
      corners,
      edge: pointer ? this.edgeTo(pointer) : [],
      pointer,
      closable: corners.length >= 3,
      area: true,
    };
  }

  /** Whether all points were set one by one, so none of them belong to an edge. */
  protected override get setsCorners(): boolean {
    return this.points.length === this.corners.length;
  }

  /** Returns the place of a corner at this position. The first corner closes the polygon. */
  private target(at: Point): Point {
    const first = this.points[0]!;
    return this.corners.length >= 3 && this.isAt(at, first) ? first : this.snapped(at);
  }

  down(sample: PointerSample): void {
    this._before = null;
    if (this.grab(sample)) return;
    const at: Point = (this.pointer = [sample.x, sample.y]);
    const before = this.points.length;
    if (before === 0) {
      if (this.begin(sample)) this._before = before;
      return;
    }
    if (this.isAt(at, this.points[0]!) || this.isAt(at, this.points[before - 1]!)) {
      this.enter();
      return;
    }
    if (before === this.most) return;
    this.addCorner(this.snapped(at));
    this._before = before;
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
    if (this._before !== null) this.takeBack(this._before);
    this._before = null;
  }

  /** Closes the polygon, if it has enough corners. */
  protected override enter(): void {
    if (this.corners.length < 3) return;
    this.points.push(...this.edgeTo(this.points[0]!));
    this.finish();
  }
}
