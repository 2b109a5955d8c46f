// A line on the surface: drawn freehand, or set point by point. The camera does not move during
// drawing.

import type { Point } from "../../net/stroke";
import type { PointerSample } from "../../ui/input";
import { PlacesTool, type OutlineHost } from "../../tools/outline";
import type { Outline } from "../../tools/tool";
import type { Tool } from "../../tools/tool";

const kMostPoints = 1000; // the server's limit on the points of a line
const kDragReachPx = 6; // in CSS pixels; a longer movement is a drag

/**
 * A drag draws a line. Clicks set its points. A second click on the last point, or Enter, ends it.
 */
export class LineTool extends PlacesTool implements Tool {
  readonly name = "line";
  // the current press, with the number of points before it
  private _press: { at: Point; first: boolean; dragged: boolean; points: number } | null = null;

  constructor(host: OutlineHost) {
    super(host, 2, kMostPoints);
  }

  override get outline(): Outline | null {
    if (this.points.length === 0) return null;
    const leadsOn = !this._press && this.points.length < this.most;
    const pointer = leadsOn && this.pointer ? this.snapped(this.pointer) : null;
    return {
      points: this.points,
      corners: this.corners,
      edge: pointer ? this.edgeTo(pointer) : [],
      pointer,
      closable: false,
      area: false,
    };
  }

  down(sample: PointerSample): void {
    const at: Point = [sample.x, sample.y];
    const last = this.points[this.points.length - 1];
    if (last && this.isAt(at, last)) {
      if (this.points.length > 1) this.finish();
      return;
    }
    const points = this.points.length;
    if (points === 0 ? !this.begin(sample) : points >= this.most) return;
    if (points > 0) this.addCorner(this.snapped(at));
    this._press = { at, first: points === 0, dragged: false, points };
    this.host.outlineChanged();
  }

  move(samples: PointerSample[]): void {
    const press = this._press;
    if (!press) return;
    const reach = kDragReachPx * this.host.scale();
    press.dragged ||= samples.some(
      ({ x, y }) => Math.hypot(x - press.at[0], y - press.at[1]) > reach,
    );
    if (press.dragged) this.follow(samples);
  }

  up(): void {
    const press = this._press;
    this._press = null;
    if (press?.first && press.dragged) this.finish();
  }

  /** A second finger on the screen undoes the press of the first finger. */
  cancel(): void {
    const press = this._press;
    this._press = null;
    if (press) this.takeBack(press.points);
  }

  protected override giveUp(): void {
    this._press = null;
    super.giveUp();
  }
}
