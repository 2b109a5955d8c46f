// Brush and eraser: a drag becomes a stroke in the selected layer, sent a batch per drawn picture.

import type { StrokeHandle, Point } from "../../net/connection";
import type { PointerSample } from "../../ui/input";
import type { Tool } from "../../tools/tool";

export interface BrushHost {
  /** Null when there is nothing to paint on; the host has then told the person why. */
  begin_stroke(erase: boolean): StrokeHandle | null;
  stroke_ended(): void;
  /** The radius in window pixels at the pointer; points closer than a tenth of it add nothing. */
  radius_px(): number;
  /** What share of its radius the brush has where a pen is pressed so strongly. */
  width_of(pressure: number): number;
  next_frame(callback: () => void): void;
}

const kWidthStep = 0.1; // of the radius

export class BrushTool implements Tool {
  private stroke_: StrokeHandle | null = null;
  private waiting_: Point[] = [];
  private widths_: number[] = []; // of the waiting points
  private last_: Point | null = null; // the last point taken
  private newest_: Point | null = null; // where the pointer is
  private newest_width_ = 1;
  private last_width_ = 1;
  private scheduled_ = false;

  constructor(
    readonly name: "brush" | "eraser",
    private readonly host_: BrushHost,
  ) {}

  activate(): void {}
  deactivate(): void {
    this.finish();
  }

  down(sample: PointerSample): void {
    this.finish();
    this.stroke_ = this.host_.begin_stroke(this.name === "eraser");
    if (!this.stroke_) return;
    this.waiting_ = [];
    this.widths_ = [];
    this.see(sample);
    this.take();
    this.flush();
  }

  move(samples: PointerSample[]): void {
    if (!this.stroke_ || !this.last_) return;
    const spacing = Math.max(0.5, this.host_.radius_px() * 0.1);
    for (const sample of samples) {
      this.see(sample);
      // in place, too
      const pressed = Math.abs(this.newest_width_ - this.last_width_) >= kWidthStep;
      if (pressed || Math.hypot(sample.x - this.last_[0], sample.y - this.last_[1]) >= spacing)
        this.take();
    }
    this.schedule();
  }

  private see({ x, y, pressure }: PointerSample): void {
    this.newest_ = [x, y];
    this.newest_width_ = pressure === undefined ? 1 : this.host_.width_of(pressure);
  }
  private take(): void {
    if (!this.newest_) return;
    this.last_ = this.newest_;
    this.waiting_.push(this.last_);
    this.widths_.push(this.newest_width_);
    this.last_width_ = this.newest_width_;
  }

  up(): void {
    this.finish();
  }

  /** What was painted stays: it can be undone. */
  cancel(): void {
    this.finish();
  }

  private schedule(): void {
    if (this.scheduled_ || this.waiting_.length === 0) return;
    this.scheduled_ = true;
    this.host_.next_frame(() => {
      this.scheduled_ = false;
      this.flush();
    });
  }

  private flush(): void {
    if (this.waiting_.length === 0) return;
    this.stroke_?.extend(
      this.waiting_,
      this.widths_.some((width) => width !== 1) ? this.widths_ : undefined,
    );
    this.waiting_ = [];
    this.widths_ = [];
  }

  private finish(): void {
    if (!this.stroke_) return;
    if (this.newest_ !== this.last_) this.take();
    this.flush();
    this.stroke_.end();
    this.stroke_ = null;
    this.last_ = this.newest_ = null;
    this.host_.stroke_ended();
  }
}
