// Polygon and lasso: an outline in the picture, whose inside is painted. While one is drawn the
// camera stays, because its points are pixels of the camera that it began with. Lines are drawn the
// same way.

import type { Point } from "../net/connection";
import type { PointerSample } from "../ui/input";
import type { Outline, Tool } from "./tool";

export interface OutlineHost {
  /** False when there is nothing to paint on; the host has then told the person why. */
  begin_outline(): boolean;
  /** Of an area at least three points, of a line two. */
  finish_outline(path: Point[]): void;
  /** After `begin_outline` returned true, finished or given up. */
  outline_ended(): void;
  /** Window pixels per CSS pixel. */
  scale(): number;
  outline_changed(): void;
}

export const kMostPoints = 4096;
export const kSnap_px = 11; // CSS pixels: so near a press counts as on a point
const kSpacing_px = 2; // CSS pixels

export abstract class OutlineTool {
  protected points: Point[] = [];
  private spacing_ = kSpacing_px;

  constructor(
    protected readonly host: OutlineHost,
    private readonly least_ = 3,
    protected readonly most = kMostPoints,
  ) {}

  get outline(): Outline | null {
    return this.points.length > 0
      ? { points: this.points, corners: [], pointer: null, closable: false, area: true }
      : null;
  }

  activate(): void {}
  deactivate(): void {
    this.give_up();
  }

  protected begin(at: PointerSample): boolean {
    if (!this.host.begin_outline()) return false;
    this.spacing_ = kSpacing_px;
    this.points = [[at.x, at.y]];
    this.host.outline_changed();
    return true;
  }

  /** Goes on to where the pointer was dragged. */
  protected follow(samples: PointerSample[]): void {
    for (const { x, y } of samples) {
      const [last_x, last_y] = this.points[this.points.length - 1]!;
      if (Math.hypot(x - last_x, y - last_y) < this.spacing_ * this.host.scale()) continue;
      this.points.push([x, y]);
      if (this.points.length < this.most) continue;
      this.points = this.points.filter((_, index) => index % 2 === 0);
      this.spacing_ *= 2;
    }
    this.host.outline_changed();
  }

  protected finish(): void {
    const path = this.points;
    this.give_up();
    if (path.length >= this.least_) this.host.finish_outline(path);
  }

  protected is_at(sample: PointerSample, [x, y]: Point): boolean {
    return Math.hypot(sample.x - x, sample.y - y) <= kSnap_px * this.host.scale();
  }

  protected give_up(): void {
    if (this.points.length === 0) return;
    this.points = [];
    this.host.outline_ended();
    this.host.outline_changed();
  }
}

/** A drag goes round what is to be painted. */
export class LassoTool extends OutlineTool implements Tool {
  readonly name = "lasso";

  down(sample: PointerSample): void {
    this.begin(sample);
  }

  move(samples: PointerSample[]): void {
    if (this.points.length > 0) this.follow(samples);
  }

  up(): void {
    this.finish();
  }
  cancel(): void {
    this.give_up();
  }
  key(key: string): boolean {
    if (key !== "Escape" || this.points.length === 0) return false;
    this.give_up();
    return true;
  }
}

/** Of one that is pressed place by place, to which the pointer leads on. */
export abstract class PlacesTool extends OutlineTool {
  protected pointer: Point | null = null;

  hover(sample: PointerSample | null): void {
    this.pointer = sample ? [sample.x, sample.y] : null;
    if (this.points.length > 0) this.host.outline_changed();
  }

  key(key: string): boolean {
    if (this.points.length === 0) return false;
    if (key === "Escape") this.give_up();
    else if (key === "Backspace" || key === "Delete") this.take_back(this.points.length - 1);
    else if (key === "Enter") this.enter();
    else return false;
    return true;
  }

  protected enter(): void {
    this.finish();
  }
  /** To so many places. */
  protected take_back(points: number): void {
    if (points < 1) {
      this.give_up();
      return;
    }
    this.points.length = Math.min(points, this.points.length);
    this.host.outline_changed();
  }
}

/** A press sets a corner; one on the first corner, a second one on the last, or Enter closes. */
export class PolygonTool extends PlacesTool implements Tool {
  readonly name = "polygon";
  private added_ = false; // by the press that is under way

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

  down(sample: PointerSample): void {
    this.added_ = false;
    this.pointer = [sample.x, sample.y];
    if (this.points.length === 0) {
      this.added_ = this.begin(sample);
      return;
    }
    const closes =
      this.is_at(sample, this.points[0]!) ||
      this.is_at(sample, this.points[this.points.length - 1]!);
    if (closes) {
      if (this.points.length >= 3) this.finish();
      return;
    }
    if (this.points.length === this.most) return;
    this.points.push([sample.x, sample.y]);
    this.added_ = true;
    this.host.outline_changed();
  }

  move(samples: PointerSample[]): void {
    const last = samples[samples.length - 1];
    if (last) this.hover(last);
  }
  up(): void {}

  /** A second finger came: its first one's press was none. */
  cancel(): void {
    if (this.added_) this.take_back(this.points.length - 1);
    this.added_ = false;
  }

  protected override enter(): void {
    if (this.points.length >= 3) this.finish();
  }
}
