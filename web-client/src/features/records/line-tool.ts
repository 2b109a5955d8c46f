// A line on the surface: drawn in one go, or pressed place by place. While one is drawn the camera
// stays, as with areas.

import type { Point } from "../../net/connection";
import type { PointerSample } from "../../ui/input";
import { PlacesTool, type OutlineHost } from "../../tools/outline";
import type { Outline } from "../../tools/tool";
import type { Tool } from "../../tools/tool";

const kMostPoints = 1000; // that the server looks at
const kDragReach_px = 6; // CSS pixels that a hand trembles: farther, and a press is a drag

/** A drag is a line. Presses are its places: one more on the last of them, or Enter, ends it. */
export class LineTool extends PlacesTool implements Tool {
  readonly name = "line";
  private corners_: Point[] = [];
  // under way, with how many were before
  private press_: { at: Point; first: boolean; dragged: boolean; points: number } | null = null;

  constructor(host: OutlineHost) {
    super(host, 2, kMostPoints);
  }

  override get outline(): Outline | null {
    if (this.points.length === 0) return null;
    const leads_on = !this.press_ && this.points.length < this.most;
    return {
      points: this.points,
      corners: this.corners_,
      pointer: leads_on ? this.pointer : null,
      closable: false,
      area: false,
    };
  }

  down(sample: PointerSample): void {
    const at: Point = [sample.x, sample.y];
    const last = this.points[this.points.length - 1];
    if (last && this.is_at(sample, last)) {
      if (this.points.length > 1) this.finish();
      return;
    }
    const points = this.points.length;
    if (points === 0 ? !this.begin(sample) : points >= this.most) return;
    if (points > 0) this.points.push(at);
    this.corners_ = [...(points > 0 ? this.corners_ : []), at];
    this.press_ = { at, first: points === 0, dragged: false, points };
    this.host.outline_changed();
  }

  move(samples: PointerSample[]): void {
    const press = this.press_;
    if (!press) return;
    const reach = kDragReach_px * this.host.scale();
    press.dragged ||= samples.some(
      ({ x, y }) => Math.hypot(x - press.at[0], y - press.at[1]) > reach,
    );
    if (press.dragged) this.follow(samples);
  }

  up(): void {
    const press = this.press_;
    this.press_ = null;
    if (press?.first && press.dragged) this.finish();
  }

  /** A second finger came: its first one's press was none. */
  cancel(): void {
    const press = this.press_;
    this.press_ = null;
    if (press) this.take_back(press.points);
  }

  protected override give_up(): void {
    this.press_ = null;
    this.corners_ = [];
    super.give_up();
  }

  protected override take_back(points: number): void {
    const left = this.points.slice(0, points);
    this.corners_ = this.corners_.filter((corner) =>
      left.some(([x, y]) => x === corner[0] && y === corner[1]),
    );
    super.take_back(points);
  }
}
