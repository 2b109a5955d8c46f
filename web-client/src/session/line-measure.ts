// Measures a line during drawing. The page requests the surface under each new part, one part at a
// time and with minimum intervals. So the cost of a long line does not grow with each pointer move.

import type { Point } from "../net/stroke";
import type { Outline } from "../tools/tool";

const kAskEveryMs = 80;

export interface LineMeasureHost<Step> {
  /** Returns the surface under the pixels of a path. */
  lookAlong(path: readonly Point[]): Promise<readonly Step[]>;
  metresAlong(steps: readonly Step[]): number;
  changed(): void;
}

type MeasuredOutline = Pick<Outline, "points" | "edge" | "pointer">;

/** A part of the line. It begins at the end of the previous part. */
interface Part<Step> {
  path: readonly Point[];
  steps: readonly Step[];
}

export class LineMeasure<Step> {
  /**
   * The last known length. Null if there is no line, if no part of it is on the surface, or if the
   * length is not known yet.
   */
  metres: number | null = null;

  private _line: MeasuredOutline | null = null;
  private _due = false; // the line has changed since `metres` was computed
  private _known: Part<Step>[] = [];
  private _asking = false;
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _count = 0; // number of lines; responses about earlier lines are ignored

  constructor(private readonly _host: LineMeasureHost<Step>) {}

  /** Sets the current path of the line. Null means that there is no line. */
  follow(line: MeasuredOutline | null): void {
    this._line = line && { ...line, points: [...line.points] };
    this._due = line !== null;
    if (line) {
      this.ask();
      return;
    }
    this.metres = null;
    this._known = [];
    this._count += 1;
  }

  private ask(): void {
    if (!this._line || !this._due || this._asking || this._timer) return;
    const { points, edge = [], pointer } = this._line;
    const known = this.keepKnown(points);
    if (known < points.length - 1) {
      void this.learn(points.slice(known), true);
    } else {
      this._due = false;
      if (pointer) void this.learn([points[known]!, ...edge, pointer], false);
      else this.tell([]);
    }
  }

  /** Keeps the parts that still belong to the line. Returns the index of their last point. */
  private keepKnown(points: readonly Point[]): number {
    let at = 0;
    const other = this._known.findIndex(({ path }) => {
      if (
        path.some(([x, y], index) => points[at + index]?.[0] !== x || points[at + index]?.[1] !== y)
      )
        return true;
      at += path.length - 1;
      return false;
    });
    if (other >= 0) this._known.length = other;
    return at;
  }

  /**
   * Measures a part of the line. `stays` is true for a drawn part, and false for the segment to the
   * pointer.
   */
  private async learn(path: readonly Point[], stays: boolean): Promise<void> {
    const count = this._count;
    this._asking = true;
    this._timer = setTimeout(() => {
      this._timer = null;
      this.ask();
    }, kAskEveryMs);
    // Problems are reported when the line is finished.
    const steps = await this._host.lookAlong(path).catch(() => null);
    this._asking = false;
    if (count === this._count) {
      if (!steps) this._due = false;
      else if (stays) this._known.push({ path, steps });
      else this.tell(steps);
    }
    this.ask();
  }

  private tell(tip: readonly Step[]): void {
    const metres = this._host.metresAlong([...this._known.flatMap(({ steps }) => steps), ...tip]);
    this.metres = metres > 0 ? metres : null;
    this._host.changed();
  }
}
