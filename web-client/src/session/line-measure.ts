// How long the line is that is being drawn. The server is asked what lies under the part that is
// new, one part at a time and not too often: a long line must not cost more with every move of the
// pointer.

import type { Point } from "../net/stroke";
import type { Outline } from "../tools/tool";

const kAskEveryMs = 80;

export interface LineMeasureHost<Step> {
  /** What lies under the pixels of a path. */
  lookAlong(path: readonly Point[]): Promise<readonly Step[]>;
  metresAlong(steps: readonly Step[]): number;
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

  private _line: Pick<Outline, "points" | "pointer"> | null = null;
  private _due = false; // it is another than the one that `metres` is about
  private _known: Part<Step>[] = [];
  private _asking = false;
  private _timer: ReturnType<typeof setTimeout> | null = null;
  private _count = 0; // of lines: answers about the one before come too late

  constructor(private readonly _host: LineMeasureHost<Step>) {}

  /** The line goes this way now; null: there is none any more. */
  follow(line: Pick<Outline, "points" | "pointer"> | null): void {
    this._line = line && { points: [...line.points], pointer: line.pointer };
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
    const { points, pointer } = this._line;
    const known = this.keepKnown(points);
    if (known < points.length - 1) {
      void this.learn(points.slice(known), true);
    } else {
      this._due = false;
      if (pointer) void this.learn([points[known]!, pointer], false);
      else this.tell([]);
    }
  }

  /** Only what is still drawn so; how many points on the last of it is. */
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

  /** `stays`: no pointer leads there, it is drawn. */
  private async learn(path: readonly Point[], stays: boolean): Promise<void> {
    const count = this._count;
    this._asking = true;
    this._timer = setTimeout(() => {
      this._timer = null;
      this.ask();
    }, kAskEveryMs);
    // what is wrong is told when the line is finished
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
