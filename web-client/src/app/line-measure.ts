// How long the line is that is being drawn. The server is asked what lies under the part that is new, one part at a time and not too often:
// a long line must not cost more with every move of the pointer.

import type { Point } from "../core/connection";
import type { MarkPlace } from "../core/protocol.gen";
import type { Outline } from "../tools/outline";

const kAskEvery_ms = 80;

/** Under the pixels of a path; null where there is no surface. */
export type PlacesSeen = readonly (MarkPlace | null)[];

export interface LineMeasureHost {
  look_along(path: readonly Point[]): Promise<PlacesSeen>;
  metres_along(places: PlacesSeen): number;
  changed(): void;
}

/** Of the line: from where the part before ended. */
interface Part {
  path: readonly Point[];
  places: PlacesSeen;
}

export class LineMeasure {
  /** Newest known; null: nothing is drawn, none of it is on the surface, or that is not known yet. */
  metres: number | null = null;

  private line_: Pick<Outline, "points" | "pointer"> | null = null;
  private due_ = false; // it is another than the one that `metres` is about
  private known_: Part[] = [];
  private asking_ = false;
  private timer_: ReturnType<typeof setTimeout> | null = null;
  private count_ = 0; // of lines: answers about the one before come too late

  constructor(private readonly host_: LineMeasureHost) {}

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
      if (path.some(([x, y], index) => points[at + index]?.[0] !== x || points[at + index]?.[1] !== y)) return true;
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
    const places = await this.host_.look_along(path).catch(() => null); // what is wrong is told when the line is finished
    this.asking_ = false;
    if (count === this.count_) {
      if (!places) this.due_ = false;
      else if (stays) this.known_.push({ path, places });
      else this.tell(places);
    }
    this.ask();
  }

  private tell(tip: PlacesSeen): void {
    const metres = this.host_.metres_along([...this.known_.flatMap(({ places }) => places), ...tip]);
    this.metres = metres > 0 ? metres : null;
    this.host_.changed();
  }
}
