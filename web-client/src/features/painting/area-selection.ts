// The area that polygon and lasso select: outlines that are combined in their order. The points of
// each outline are pixels in the window of the camera with which the outline was drawn. The 3D view
// highlights the area until it is painted, erased or discarded. Corners can be changed while the 3D
// view shows the view of their outline.

import type { OutlineStep, SelectRequest, SelectResponse } from "../../core/protocol.gen";
import type { CameraMessage } from "../../math/camera";
import { ApiError } from "../../net/api-error";
import type { Point } from "../../net/stroke";
import type { LitArea } from "../../session/lit-area";
import { kSnapPx, type FinishedOutlines } from "../../tools/outline";
import type { PointerSample } from "../../ui/input";

/** The effect of the next outline on the selection. */
export type SelectionMode = "replace" | OutlineStep["combine"];

export interface SelectedOutline extends OutlineStep {
  /** Whether the user set the points one by one. */
  corners: boolean;
}

/** A corner of an outline or, with `between`, the middle of the edge after that corner. */
export interface CornerPlace {
  outline: number;
  corner: number;
  between: boolean;
}

export interface AreaSelectionHost {
  readonly lit: Pick<LitArea, "showLasting">;
  camera(): CameraMessage;
  /** Returns the number of window pixels per CSS pixel. */
  scale(): number;
  /** Returns the layers whose values in the selection are shown. */
  layers(): string[];
  /** Paints or erases the selection. */
  fill(): void;
  failed(error: unknown): void;
  changed(): void;
}

export const kMostOutlines = 32;

type Within = NonNullable<SelectRequest["within"]>;

export class AreaSelection implements FinishedOutlines {
  outlines: readonly SelectedOutline[] = [];
  /** The mode of the pressed button. Keys held at the start of an outline take precedence. */
  mode: SelectionMode = "replace";
  /** The measured selection; null while it is unknown. */
  measured: SelectResponse | null = null;
  /** The corner that was pressed last. It can be deleted. */
  active: CornerPlace | null = null;
  private _next: SelectionMode = "replace";
  // the outlines before the drag of a corner
  private _before: readonly SelectedOutline[] | null = null;
  private _asked = 0;

  constructor(private readonly _host: AreaSelectionHost) {}

  get isEmpty(): boolean {
    return this.outlines.length === 0;
  }
  get isFull(): boolean {
    return this.outlines.length >= kMostOutlines;
  }

  setMode(mode: SelectionMode): void {
    this.mode = mode;
    this._host.changed();
  }

  /**
   * Call this at the start of an outline. Shift adds, Alt subtracts, and both together intersect.
   */
  begin({ shift = false, alt = false }: PointerSample): void {
    const byKeys = shift && alt ? "intersect" : shift ? "add" : alt ? "subtract" : null;
    this._next = byKeys ?? this.mode;
  }

  /** Returns whether another outline would exceed the limit. */
  refusesMore(sample: PointerSample): boolean {
    this.begin(sample);
    return this.isFull && this._next !== "replace";
  }

  add(path: Point[], through: boolean, corners: boolean): void {
    const begins = this._next === "replace" || this.isEmpty;
    const outline: SelectedOutline = {
      combine: begins ? "add" : (this._next as OutlineStep["combine"]),
      camera: this._host.camera(),
      path,
      through,
      corners,
    };
    this.active = null;
    this.put(begins ? [outline] : [...this.outlines, outline]);
  }

  clear(): void {
    if (this.isEmpty) return;
    this.active = null;
    this.mode = "replace";
    this.put([]);
  }

  /** The area in the contract's format; null if nothing is selected. */
  get within(): Within | null {
    const [first, ...rest] = this.outlines;
    if (!first) return null;
    const { camera, path, through } = first;
    return {
      camera,
      path,
      ...(through ? { through } : {}),
      ...(rest.length > 0 ? { steps: rest.map(stepOf) } : {}),
    };
  }

  /** Measures the selection again for other layers. */
  measureAgain(): void {
    if (!this.isEmpty) void this.measure();
  }

  // ── corners ────────────────────────────────────────────────────────────────────────────────────

  /** Returns whether the 3D view shows the view that the outline was drawn in. */
  isInView({ camera }: Pick<SelectedOutline, "camera">): boolean {
    return JSON.stringify(camera) === JSON.stringify(this._host.camera());
  }

  grab(at: PointerSample): boolean {
    // with a held key the pointer starts another outline
    const place = at.shift || at.alt ? null : this.placeAt(at);
    if (!place && this.active) {
      this.active = null;
      this._host.changed();
    }
    if (!place) return false;
    this._before = this.outlines;
    if (place.between) {
      const { outline, corner } = place;
      this.change(outline, (path) => path.splice(corner + 1, 0, [at.x, at.y]));
      this.active = { outline, corner: corner + 1, between: false };
    } else {
      this.active = place;
    }
    this._host.changed();
    return true;
  }

  drag({ x, y }: PointerSample): void {
    const { active } = this;
    if (!active) return;
    this.change(active.outline, (path) => (path[active.corner] = [x, y]));
    this._host.changed();
  }

  release(keep: boolean): void {
    const before = this._before;
    this._before = null;
    if (!before || before === this.outlines) return;
    if (!keep) this.active = null;
    this.put(keep ? this.outlines : before);
  }

  /** Whether the pressed corner can be deleted. A triangle keeps its corners. */
  get canDelete(): boolean {
    return this.active !== null && (this.outlines[this.active.outline]?.path.length ?? 0) > 3;
  }

  deleteCorner(): void {
    const { active } = this;
    if (!active || !this.canDelete) return;
    this.change(active.outline, (path) => path.splice(active.corner, 1));
    this.active = null;
    this.put(this.outlines);
  }

  key(key: string): boolean {
    if (this.isEmpty) return false;
    if (key === "Enter") this._host.fill();
    else if (key === "Escape") this.clear();
    else if (key !== "Backspace" && key !== "Delete") return false;
    else if (this.active) this.deleteCorner();
    else if (this.outlines.length === 1) this.clear();
    else this.put(this.outlines.slice(0, -1));
    return true;
  }

  private placeAt({ x, y }: PointerSample): CornerPlace | null {
    const reach = kSnapPx * this._host.scale();
    let nearest: CornerPlace | null = null;
    let least = reach;
    const offer = (place: CornerPlace, [px, py]: Point): void => {
      const distance = Math.hypot(x - px, y - py);
      if (distance > least) return;
      least = distance;
      nearest = place;
    };
    this.outlines.forEach((each, outline) => {
      if (!each.corners || !this.isInView(each)) return;
      each.path.forEach((point, corner) => {
        offer({ outline, corner, between: true }, middleAfter(each.path, corner));
        offer({ outline, corner, between: false }, point);
      });
    });
    return nearest;
  }

  private change(index: number, edit: (path: Point[]) => void): void {
    this.outlines = this.outlines.map((each, at) => {
      if (at !== index) return each;
      const path = [...each.path];
      edit(path);
      return { ...each, path };
    });
  }

  // ── the area ───────────────────────────────────────────────────────────────────────────────────

  private put(outlines: readonly SelectedOutline[]): void {
    this.outlines = outlines;
    void this.measure();
  }

  private async measure(): Promise<void> {
    const asked = ++this._asked;
    const { within } = this;
    this.measured = null;
    this._host.changed();
    try {
      const measured = await this._host.lit.showLasting(
        within ? { within, layers: this._host.layers() } : null,
      );
      if (asked !== this._asked) return;
      this.measured = measured;
      this._host.changed();
    } catch (error) {
      const isOld = error instanceof ApiError && error.status === 499;
      if (asked === this._asked && !isOld) this._host.failed(error);
    }
  }
}

const stepOf = ({ combine, camera, path, through }: SelectedOutline): OutlineStep => ({
  combine,
  camera,
  path,
  ...(through ? { through } : {}),
});

/** Returns the middle of the edge after a corner. */
export function middleAfter(path: readonly Point[], corner: number): Point {
  const [x0, y0] = path[corner]!;
  const [x1, y1] = path[(corner + 1) % path.length]!;
  return [(x0 + x1) / 2, (y0 + y1) / 2];
}
