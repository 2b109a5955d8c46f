// How long the line is that is being drawn. The server is asked what lies under the part that is
// new, one part at a time and not too often: a long line must not cost more with every move of the
// pointer.

import type { Point } from "../net/connection";
import type { Outline } from "../tools/tool";

const kAskEvery_ms = 80;

export interface LineMeasureHost<Step> {
  /** What lies under the pixels of a path. */
  look_along(path: readonly Point[]): Promise<readonly Step[]>;
  metres_along(steps: readonly Step[]): number;
  changed(): void;
}

/** Of the line: from where the part before ended. */
interface Part<Step> {
  path: readonly Point[];
  steps: readonly Step[];
}

export class LineMeasure<Step> {
  /**
   * Newest known; null: nothing is drawn, none of it is on the surface, or that is not known yet.
   */
  metres: number | null = null;

  private line_: Pick<Outline, "points" | "pointer"> | null = null;
  private due_ = false; // it is another than the one that `metres` is about
  private known_: Part<Step>[] = [];
  private asking_ = false;
  private timer_: ReturnType<typeof setTimeout> | null = null;
  private count_ = 0; // of lines: answers about the one before come too late

  constructor(private readonly host_: LineMeasureHost<Step>) {}

  /** The line goes this way now; null: there is none any more. */
  follow(line: Pick<Outline, "points" | "pointer"> | null): void {
    this.line_ = line && { points: [...line.points], pointer: line.pointer };
    this.due_ = line !== null;
    if (line) {
      this.ask();
      return;
    }
    this.metres = null;
    this.known_ = [];
    this.count_ += 1;
  }

  private ask(): void {
    if (!this.line_ || !this.due_ || this.asking_ || this.timer_) return;
    const { points, pointer } = this.line_;
    const known = this.keep_known(points);
    if (known < points.length - 1) {
      void this.learn(points.slice(known), true);
    } else {
      this.due_ = false;
      if (pointer) void this.learn([points[known]!, pointer], false);
      else this.tell([]);
    }
  }

  /** Only what is still drawn so; how many points on the last of it is. */
  private keep_known(points: readonly Point[]): number {
    let at = 0;
    const other = this.known_.findIndex(({ path }) => {
      if (
        path.some(([x, y], index) => points[at + index]?.[0] !== x || points[at + index]?.[1] !== y)
      )
        return true;
      at += path.length - 1;
      return false;
    });
    if (other >= 0) this.known_.length = other;
    return at;
  }

  /** `stays`: no pointer leads there, it is drawn. */
  private async learn(path: readonly Point[], stays: boolean): Promise<void> {
    const count = this.count_;
    this.asking_ = true;
    this.timer_ = setTimeout(() => {
      this.timer_ = null;
      this.ask();
    }, kAskEvery_ms);
    // what is wrong is told when the line is finished
    const steps = await this.host_.look_along(path).catch(() => null);
    this.asking_ = false;
    if (count === this.count_) {
      if (!steps) this.due_ = false;
      else if (stays) this.known_.push({ path, steps });
      else this.tell(steps);
    }
    this.ask();
  }

  private tell(tip: readonly Step[]): void {
    const metres = this.host_.metres_along([...this.known_.flatMap(({ steps }) => steps), ...tip]);
    this.metres = metres > 0 ? metres : null;
    this.host_.changed();
  }
}
