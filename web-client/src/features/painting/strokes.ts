// Strokes inside and outside of an area, from which the page finds the area in the shown frame. The
// area is the next part of the selection, and follows each stroke until it is accepted. Strokes are
// pixels in the window of the camera at the first stroke. They end when the camera or another part
// of the selection changes. Their area stays selected then.

import type { Within } from "../../core/protocol.gen";
import type { CameraMessage } from "../../math/camera";
import type { Point } from "../../net/stroke";
import type { PointerSample } from "../../ui/input";
import type { Selection } from "./selection";
import type { SharpFrame } from "./sharp-frame";
import { areaOfStrokes, type AreaRing, type AreaStroke } from "./stroke-area";

export interface StrokesHost {
  readonly selection: Pick<Selection, "propose" | "acceptProposed" | "steps" | "key">;
  /** Returns null while the 3D view shows no such frame. */
  frame(): SharpFrame | null;
  camera(): CameraMessage;
  /** The number of window pixels per CSS pixel. */
  scale(): number;
  /** Whether the selection contains hidden surfaces. */
  through(): boolean;
  /** Returns false if an area cannot be selected. In this case, the host has shown the reason. */
  begin(at: PointerSample): boolean;
  /** Called when a stroke for which `begin` returned true is finished or canceled. */
  ended(): void;
  /** Calls back soon, after the page is drawn. */
  later(callback: () => void): void;
  changed(): void;
}

/**
 * What the user can do next. `searching`: the area follows soon. `found`: there is an area, which
 * can be older than the last stroke for a moment.
 */
export type StrokesState = "none" | "no_inside" | "no_outside" | "searching" | "nothing" | "found";

/** The radius of a stroke in CSS pixels. */
export const kStrokeRadius = 4;
const kSpacing = 2; // of the points of a stroke, in CSS pixels

export class Strokes {
  /** Whether strokes without Alt are inside. */
  drawsInside = true;
  private _drawn: AreaStroke[] = [];
  private _undone: AreaStroke[] = [];
  private _drawing: { inside: boolean; path: Point[] } | null = null;
  private _camera = ""; // of the drawn strokes
  private _steps: Selection["steps"] = []; // of the selection, as the strokes left it
  private _adds = false; // whether Shift was held at the first stroke
  private _state: StrokesState = "none";
  private _pending = false; // whether the strokes have changed since their area was found
  private _waits = false;

  constructor(private readonly _host: StrokesHost) {}

  /** The strokes to show in the current view, with the one that is being drawn. */
  get shown(): readonly AreaStroke[] {
    const drawn = this.isCurrent ? this._drawn : [];
    return this._drawing ? [...drawn, this._drawing] : drawn;
  }
  get state(): StrokesState {
    return this.isOpen ? this._state : "none";
  }
  /** Whether there are strokes whose area can still change. */
  get isOpen(): boolean {
    return this.isCurrent && this._drawn.length > 0;
  }
  get canRedo(): boolean {
    return this.isCurrent && this._undone.length > 0;
  }

  draw(inside: boolean): void {
    this.drawsInside = inside;
    this._host.changed();
  }

  // ── a stroke ───────────────────────────────────────────────────────────────────────────────────

  down(sample: PointerSample): void {
    if (!this.isCurrent) this.end();
    if (!this._host.begin(sample)) return;
    if (this._drawn.length === 0) {
      this._camera = JSON.stringify(this._host.camera());
      this._steps = this._host.selection.steps;
      this._adds = sample.shift ?? false;
    }
    const inside = sample.alt ? !this.drawsInside : this.drawsInside;
    this._drawing = { inside, path: [[sample.x, sample.y]] };
    this._host.changed();
  }

  move(samples: readonly PointerSample[]): void {
    const path = this._drawing?.path;
    if (!path) return;
    for (const { x, y } of samples) {
      const [lastX, lastY] = path[path.length - 1]!;
      if (Math.hypot(x - lastX, y - lastY) >= kSpacing * this._host.scale()) path.push([x, y]);
    }
    this._host.changed();
  }

  up(): void {
    const stroke = this._drawing;
    if (!stroke) return;
    this._drawing = null;
    this._drawn = [...this._drawn, stroke];
    this._undone = [];
    this._host.ended();
    this.follow();
  }

  cancel(): void {
    if (!this._drawing) return;
    this._drawing = null;
    this._host.ended();
    if (this._pending) this.wait();
    this._host.changed();
  }

  // ── all strokes ────────────────────────────────────────────────────────────────────────────────

  /** Removes the last stroke. */
  undo(): void {
    if (!this.isOpen) return;
    this._undone.push(this._drawn[this._drawn.length - 1]!);
    this._drawn = this._drawn.slice(0, -1);
    this.follow();
  }
  redo(): void {
    const stroke = this.canRedo ? this._undone.pop() : undefined;
    if (!stroke) return;
    this._drawn = [...this._drawn, stroke];
    this.follow();
  }

  /** Call this when the user undoes something else, because redo must then restore that first. */
  forgetUndone(): void {
    this._undone = [];
    this._host.changed();
  }

  /** Ends the strokes if they have an area, which stays selected. */
  accept(): void {
    this.cancel();
    this.search();
    if (this.state === "found") this.finish();
  }

  /** Ends the strokes. If they have an area, it stays selected. */
  leave(): void {
    this.cancel();
    this.search();
    this.finish();
  }

  /** Removes the strokes and their area. */
  giveUp(): void {
    this.cancel();
    if (this.isOpen) this._host.selection.propose(null);
    this.finish();
  }

  key(key: string): boolean {
    const { selection } = this._host;
    if (key === "Escape" && this._drawing) this.cancel();
    else if (!this.isOpen) return selection.key(key);
    else if (key === "Escape") this.giveUp();
    else if (key === "Backspace" || key === "Delete") this.undo();
    else if (key !== "Enter") return false;
    else this.accept();
    return true;
  }

  private finish(): void {
    this.end();
    this._host.changed();
  }

  private end(): void {
    this._host.selection.acceptProposed();
    this._drawn = [];
    this._undone = [];
    this._state = "none";
    this._pending = false;
  }

  /** Whether the view is that of the strokes, and only they have changed the selection since. */
  private get isCurrent(): boolean {
    return (
      this._camera === JSON.stringify(this._host.camera()) &&
      this._steps === this._host.selection.steps
    );
  }

  /** Finds the area of the changed strokes after the page is drawn. */
  private follow(): void {
    const hasInside = this._drawn.some(({ inside }) => inside);
    const hasOutside = this._drawn.some(({ inside }) => !inside);
    this._pending = hasInside && hasOutside;
    if (this._pending) {
      // While the area is searched, the old one is shown.
      if (this._state !== "found") this._state = "searching";
      this.wait();
    } else {
      this.take([]);
      this._state = hasInside ? "no_outside" : hasOutside ? "no_inside" : "none";
    }
    this._host.changed();
  }

  private wait(): void {
    if (this._waits) return;
    this._waits = true;
    this._host.later(() => {
      this._waits = false;
      // The end of the next stroke continues the search.
      if (!this._drawing) this.search();
    });
  }

  /** Finds the area now if it is pending. Without a frame, the search continues later. */
  private search(): void {
    if (!this._pending) return;
    if (!this.isCurrent) {
      this.end();
      return;
    }
    const frame = this._host.frame();
    if (!frame) {
      this.wait();
      if (this._state === "searching") return;
      this._state = "searching";
      this._host.changed();
      return;
    }
    this._pending = false;
    const camera = this._host.camera();
    const [across, down] = [frame.width / camera.width, frame.height / camera.height];
    const inFrame = this._drawn.map(({ inside, path }) => ({
      inside,
      path: path.map(([x, y]): Point => [x * across, y * down]),
    }));
    const rings = areaOfStrokes(frame, inFrame, kStrokeRadius * this._host.scale() * across);
    this.take(
      rings.map(({ hole, path }) => ({
        hole,
        path: path.map(([x, y]): Point => [x / across, y / down]),
      })),
    );
    this._host.changed();
  }

  private take(rings: readonly AreaRing[]): void {
    const { selection } = this._host;
    const within = withinRings(rings, this._host.camera(), this._host.through());
    selection.propose(within, { shift: this._adds });
    this._steps = selection.steps;
    this._state = within ? "found" : "nothing";
  }
}

function withinRings(
  [first, ...rest]: readonly AreaRing[],
  camera: CameraMessage,
  through: boolean,
): Within | null {
  if (!first) return null;
  const seen = through ? { camera, through } : { camera };
  return {
    ...seen,
    path: first.path,
    ...(rest.length > 0
      ? {
          steps: rest.map(({ hole, path }) => ({
            combine: hole ? ("subtract" as const) : ("add" as const),
            ...seen,
            path,
          })),
        }
      : {}),
  };
}
