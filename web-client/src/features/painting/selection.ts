// The area that polygon, lasso, wand and strokes select together. It consists of parts that are
// combined in their order, and of changes to its border. The points of an outline are pixels in the
// window of the camera with which it was drawn. The 3D view highlights the area until it is painted,
// erased or discarded. Corners of an outline can be moved while the 3D view shows the view of this
// outline.

import type { Combination, Like, SelectResponse, Within } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import type { CameraMessage } from "../../math/camera";
import { ApiError } from "../../net/api-error";
import type { Point } from "../../net/stroke";
import type { LitArea } from "../../session/lit-area";
import { kSnapPx, type FinishedOutlines } from "../../tools/outline";
import type { PointerSample } from "../../ui/input";
import {
  fitsRequest,
  isOutline,
  isPart,
  type OutlinePart,
  type SelectionPart,
  type SelectionStep,
  stepsOf,
  withinOf,
} from "./selection-steps";
import { type Brushed, Wand } from "./wand";

/** The effect of the next part on the selection. */
export type SelectionMode = "replace" | Combination;

/** The keys that are held at the start of a part. */
export type HeldKeys = Pick<PointerSample, "shift" | "alt">;

export interface DrawnOutline {
  camera: CameraMessage;
  path: Point[];
  through: boolean;
  /** Whether the user set the points one by one. */
  corners: boolean;
}

/** A corner of an outline or, with `between`, the middle of the edge after that corner. */
export interface CornerPlace {
  /** The index of the outline's step. */
  step: number;
  corner: number;
  between: boolean;
}

export interface SelectionHost {
  readonly lit: Pick<LitArea, "showLasting">;
  camera(): CameraMessage;
  /** Returns the number of window pixels per CSS pixel. */
  scale(): number;
  /** Returns the layer to paint, whose values in the selection are shown, or null. */
  selected(): Layer | null;
  /** Returns the layer with this id, or null. */
  layer(id: number | null): Layer | null;
  /** Returns whether the user can paint. If not, shows the reason to the user. */
  mayPaint(): boolean;
  /** Whether Enter erases the selection. */
  erases(): boolean;
  /**
   * Paints or erases an area as one edit. Returns false if this is not possible, after showing the
   * reason to the user.
   */
  paint(within: Within, erases: boolean): Promise<boolean>;
  /** Shows that the selection has as many parts as possible. */
  full(): void;
  failed(error: unknown): void;
  changed(): void;
}

type Steps = readonly SelectionStep[];

const kMostUndone = 100;
const rounded = (pixel: number): number => Math.round(pixel * 10) / 10;
const kMostPathPoints = 4096; // of the path of a brush

export class Selection implements FinishedOutlines {
  steps: Steps = [];
  /** The mode of the pressed button. Keys held at the start of a part take precedence. */
  mode: SelectionMode = "replace";
  /** The measured selection; null while it is unknown. */
  measured: SelectResponse | null = null;
  /** Whether the server could not measure the selection. */
  unmeasured = false;
  /** Whether the selection is being painted. */
  busy = false;
  /** The corner that was pressed last. It can be deleted. */
  active: CornerPlace | null = null;
  readonly wand: Wand;

  private _wandIsActive = false;
  private _past: Steps[] = [];
  private _future: Steps[] = [];
  private _before: Steps | null = null; // the steps before the drag of a corner
  // by the wand
  private _clicked: { part: SelectionPart; at: Like["at"]; brushed: Brushed | null } | null = null;
  // an area that can still be replaced, the steps without it, and how it is combined with them
  private _proposal: { before: Steps; steps: Steps; combine: Combination | null } | null = null;
  private _accepted: Steps = []; // the last steps that the server has measured
  private _asked = 0;
  private _asking = false;
  private _again = false;

  constructor(private readonly _host: SelectionHost) {
    this.wand = new Wand({
      selected: () => _host.selected(),
      layer: (id) => _host.layer(id),
      changed: () => this.wandChanged(),
    });
  }

  get isEmpty(): boolean {
    return this.steps.length === 0;
  }

  /** The selected area in the contract's format; null if nothing is selected. */
  get within(): Within | null {
    return withinOf(this.steps);
  }

  setMode(mode: SelectionMode): void {
    this.mode = mode;
    this._host.changed();
  }

  // ── parts ──────────────────────────────────────────────────────────────────────────────────────

  /** Returns whether another part would exceed the limits, after showing this to the user. */
  refusesMore(keys: HeldKeys): boolean {
    if (this.isProposed) return false; // the next area replaces the proposed one
    const refused = !fitsRequest(this.with({ where: "true" }, keys));
    if (refused) this._host.full();
    return refused;
  }

  /** Shift adds, Alt subtracts, and both together intersect. */
  addOutline({ camera, path, through, corners }: DrawnOutline, keys: HeldKeys = {}): void {
    this.addPart({ camera, path, ...(through ? { through } : {}) }, keys, corners);
  }

  /**
   * Selects the surface that looks like the surface at a pixel. With the radius of a brush on the
   * object, only as far as the brush reaches there.
   */
  addSimilar([x, y]: Point, keys: HeldKeys = {}, radiusMm: number | null = null): void {
    if (!this._host.mayPaint() || this.refusesMore(keys)) return;
    const at = { camera: this._host.camera(), x, y };
    const brushed: Brushed | null =
      radiusMm === null ? null : { path: [[x, y]], radius_mm: radiusMm };
    this.addPart({ like: this.wand.likeAt(at, brushed) }, keys);
    const part = this.steps[this.steps.length - 1];
    if (part && isPart(part)) this._clicked = { part, at, brushed };
    this._host.changed();
  }

  /**
   * Moves the brush that began with `addSimilar` to further pixels. The server does not join the
   * pixels of the path, so they are `spacing` pixels apart, however fast the pointer is.
   */
  brushTo(points: readonly Point[], spacing: number): void {
    if (!this.clicked || !this._clicked?.brushed) return;
    const path = [...this._clicked.brushed.path];
    const step = Math.max(1, spacing);
    for (const [toX, toY] of points)
      while (path.length < kMostPathPoints) {
        const [x, y] = path[path.length - 1]!;
        const distance = Math.hypot(toX - x, toY - y);
        if (distance < step) break;
        const share = step / distance;
        path.push([rounded(x + (toX - x) * share), rounded(y + (toY - y) * share)]);
      }
    if (path.length === this._clicked.brushed.path.length) return;
    this._clicked.brushed = { ...this._clicked.brushed, path };
    this.wandChanged();
  }

  /** Whether the wand selects with a brush. */
  useBrush(brushes: boolean): void {
    this.changeDefault(() => this.wand.set({ brushes }));
  }
  /** The wand is the active tool, or another tool is. */
  wandIsActive(active: boolean): void {
    this.changeDefault(() => (this._wandIsActive = active));
  }

  /** The mode before the user chooses one. Strokes of a brush usually make up one area together. */
  private get defaultMode(): SelectionMode {
    return this._wandIsActive && this.wand.brushes ? "add" : "replace";
  }
  private changeDefault(change: () => void): void {
    const wasDefault = this.mode === this.defaultMode;
    change();
    if (wasDefault) this.setMode(this.defaultMode);
  }

  /** Adds a saved selection. Its steps can be removed one by one if it replaces the selection. */
  addSaved(within: Within, keys: HeldKeys = {}): void {
    this.acceptProposed();
    if (this.combination(keys) === null) this.put(stepsOf(within));
    else if (!this.refusesMore(keys)) this.addPart(within, keys);
  }

  /**
   * Selects an area as the next part, or replaces the proposed one. Null removes the proposed one.
   * The keys and the mode at the first area apply until the proposal is accepted.
   */
  propose(within: Within | null, keys: HeldKeys = {}): void {
    const known = this.isProposed ? this._proposal : null;
    if (!within && !known) return;
    const before = known?.before ?? this.steps;
    if (known && this._past[this._past.length - 1] === before) this._past.pop();
    this._proposal = null;
    if (!within) {
      this.active = null;
      this.steps = before;
      this.measure();
      return;
    }
    const combine = known ? known.combine : this.combination(keys);
    this.steps = before;
    this.put(this.combined(within, combine));
    this._proposal = { before, steps: this.steps, combine };
  }

  /** Whether the last part is a proposed area. */
  get isProposed(): boolean {
    return this._proposal?.steps === this.steps;
  }

  /** Keeps the proposed area, so the next one does not replace it. */
  acceptProposed(): void {
    this._proposal = null;
  }

  /** Grows the area by this distance. A negative distance shrinks it. */
  grow(mm: number): void {
    this.change({ grow_mm: mm });
  }
  /** Removes pieces and closes gaps that are narrower than this width. */
  smooth(mm: number): void {
    this.change({ smooth_mm: mm });
  }

  clear(): void {
    if (this.isEmpty) return;
    this.mode = this.defaultMode;
    this.active = this._clicked = null;
    this._past = [];
    this._future = [];
    this._accepted = this.steps = [];
    this.measure();
  }

  private change(change: SelectionStep): void {
    if (this.isEmpty) return;
    const steps = [...this.steps, change];
    if (fitsRequest(steps)) this.put(steps);
    else this._host.full();
  }

  private addPart(within: Within, keys: HeldKeys, corners = false): void {
    this.put(this.with(within, keys, corners));
  }

  private with(within: Within, keys: HeldKeys, corners = false): Steps {
    return this.combined(within, this.combination(keys), corners);
  }

  /** Returns the steps with another part. It replaces them if `combine` is null. */
  private combined(within: Within, combine: Combination | null, corners = false): Steps {
    const part = { combine: combine ?? "add", within, ...(corners ? { corners } : {}) };
    return combine ? [...this.steps, part] : [part];
  }

  /** Returns how the next part is combined. Null means that it replaces the selection. */
  private combination({ shift = false, alt = false }: HeldKeys): Combination | null {
    if (this.isEmpty) return null;
    if (shift || alt) return shift && alt ? "intersect" : shift ? "add" : "subtract";
    return this.mode === "replace" ? null : this.mode;
  }

  /** The last part, if the wand has selected it. Its options can still change. */
  get clicked(): SelectionPart | null {
    const last = this.steps.filter(isPart).pop();
    return last && last === this._clicked?.part ? last : null;
  }

  private wandChanged(): void {
    const { clicked: old, _clicked: clicked } = this;
    if (old && clicked) {
      const part = { ...old, within: { like: this.wand.likeAt(clicked.at, clicked.brushed) } };
      this.steps = this.steps.map((step) => (step === old ? part : step));
      this._clicked = { ...clicked, part };
      this._future = [];
      this._again = true;
      // While a request is running, changes wait, so a moving slider does not send one at each step.
      if (!this._asking) this.measure();
    }
    this._host.changed();
  }

  // ── undo ───────────────────────────────────────────────────────────────────────────────────────

  get canUndo(): boolean {
    return this._past.length > 0;
  }
  get canRedo(): boolean {
    return this._future.length > 0;
  }
  /** Returns to the steps before the last change. */
  undo(): void {
    this.travel(this._past, this._future);
  }
  redo(): void {
    this.travel(this._future, this._past);
  }

  private travel(from: Steps[], to: Steps[]): void {
    const steps = from.pop();
    if (!steps) return;
    to.push(this.steps);
    this.active = null;
    this.steps = steps;
    this.measure();
  }

  /** Removes the last step. */
  private removeLast(): void {
    if (this.steps.length === 1) this.clear();
    else this.put(this.steps.slice(0, -1));
  }

  private put(steps: Steps): void {
    if (!this.isEmpty) this._past = [...this._past, this.steps].slice(-kMostUndone);
    this._future = [];
    this.active = null;
    this.steps = steps;
    this.measure();
  }

  // ── corners ────────────────────────────────────────────────────────────────────────────────────

  /** The outlines with the indices of their steps. */
  get outlines(): { outline: OutlinePart; step: number }[] {
    return this.steps.flatMap((outline, step) => (isOutline(outline) ? [{ outline, step }] : []));
  }

  /** Returns whether the 3D view shows the view that the outline was drawn in. */
  isInView({ within }: OutlinePart): boolean {
    return JSON.stringify(within.camera) === JSON.stringify(this._host.camera());
  }

  grab(at: PointerSample): boolean {
    // with a held key the pointer starts another outline
    const place = at.shift || at.alt ? null : this.placeAt(at);
    if (!place && this.active) {
      this.active = null;
      this._host.changed();
    }
    if (!place) return false;
    this._before = this.steps;
    if (place.between) {
      const { step, corner } = place;
      this.steps = this.withPath(step, (path) => path.splice(corner + 1, 0, [at.x, at.y]));
      this.active = { step, corner: corner + 1, between: false };
    } else {
      this.active = place;
    }
    this._host.changed();
    return true;
  }

  drag({ x, y }: PointerSample): void {
    const { active } = this;
    if (!active) return;
    this.steps = this.withPath(active.step, (path) => (path[active.corner] = [x, y]));
    this._host.changed();
  }

  release(keep: boolean): void {
    const { _before: before, steps, active } = this;
    this._before = null;
    if (!before || before === steps) return;
    this.steps = before;
    if (keep) this.put(steps);
    this.active = keep ? active : null;
    this._host.changed();
  }

  /** Whether the pressed corner can be deleted. A triangle keeps its corners. */
  get canDelete(): boolean {
    const outline = this.active && this.steps[this.active.step];
    return !!outline && isOutline(outline) && outline.within.path.length > 3;
  }

  deleteCorner(): void {
    const { active } = this;
    if (!active || !this.canDelete) return;
    this.put(this.withPath(active.step, (path) => path.splice(active.corner, 1)));
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
    for (const { outline, step } of this.outlines) {
      if (!outline.corners || !this.isInView(outline)) continue;
      const { path } = outline.within;
      path.forEach((point, corner) => {
        offer({ step, corner, between: true }, middleAfter(path, corner));
        offer({ step, corner, between: false }, point);
      });
    }
    return nearest;
  }

  private withPath(at: number, edit: (path: Point[]) => void): Steps {
    return this.steps.map((step, index) => {
      if (index !== at || !isOutline(step)) return step;
      const path = [...step.within.path];
      edit(path);
      return { ...step, within: { ...step.within, path } };
    });
  }

  // ── use ────────────────────────────────────────────────────────────────────────────────────────

  key(key: string): boolean {
    if (this.isEmpty) return false;
    if (key === "Enter") void this.paint(this._host.erases());
    else if (key === "Escape") this.clear();
    else if (key !== "Backspace" && key !== "Delete") return false;
    else if (this.active) this.deleteCorner();
    else this.removeLast();
    return true;
  }

  /** Paints or erases the selection, as one edit. */
  async paint(erases: boolean): Promise<void> {
    const { within, steps } = this;
    if (!within || this.busy) return;
    this.busy = true;
    this._host.changed();
    try {
      const isPainted = await this._host.paint(within, erases);
      if (isPainted && steps === this.steps) this.clear(); // the user may have selected something else
    } catch (error) {
      this._host.failed(error);
    } finally {
      this.busy = false;
      this._host.changed();
    }
  }

  /** Measures the selection again, for other layers or after a failure. */
  measureAgain(): void {
    if (!this.isEmpty) this.measure();
  }

  /** Measures and shows the newest selection. Ends a running request for an older one. */
  private measure(): void {
    void this.ask(++this._asked);
  }

  private async ask(asked: number): Promise<void> {
    const { steps, within } = this;
    this._asking = within !== null;
    this._again = this.unmeasured = false;
    this.measured = null;
    this._host.changed();
    const layer = this._host.selected();
    const layers = layer ? [layer.slug] : [];
    try {
      const measured = await this._host.lit.showLasting(within ? { within, layers } : null);
      if (asked !== this._asked) return;
      this._accepted = steps;
      if (!this._again) this.measured = measured;
    } catch (error) {
      if (asked !== this._asked) return;
      this.onFailure(error);
    }
    this._asking = false;
    if (this._again) this.measure();
    this._host.changed();
  }

  private onFailure(error: unknown): void {
    const status = error instanceof ApiError ? error.status : 0;
    // The highlight was requested again for another camera. Without a new request, the size would
    // remain unknown.
    if (status === 499) this._again = true;
    else if (!this._again) {
      this._host.failed(error);
      if (status === 413 || status === 422) this.dropRefused();
      else this.unmeasured = true;
    }
  }

  /**
   * Returns to the steps before a change that the server refuses. Earlier parts stay, also those
   * that the server has not measured yet.
   */
  private dropRefused(): void {
    const { steps: refused, _accepted: accepted } = this;
    const before = accepted.length >= refused.length ? accepted : this._past[this._past.length - 1];
    if (!before || before === refused) {
      this.clear();
      return;
    }
    this._past = this._past.filter((steps) => steps !== before);
    this.active = null;
    this.steps = before;
    this._again = true;
  }
}

/** Returns the middle of the edge after a corner. */
export function middleAfter(path: readonly Point[], corner: number): Point {
  const [x0, y0] = path[corner]!;
  const [x1, y1] = path[(corner + 1) % path.length]!;
  return [(x0 + x1) / 2, (y0 + y1) / 2];
}
