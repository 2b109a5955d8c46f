// The options of the wand, which selects the surface that looks like the surface at one point. The
// server compares texels of the surface, so the selected surface does not depend on the view.

import type { Like } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import type { Point } from "../../net/stroke";

export type WandBy = Like["by"];

/** The path of a brush in the view of the compared point, and the brush's radius on the object. */
export interface Brushed {
  path: Point[];
  radius_mm: number;
}

export interface WandHost {
  /** Returns the layer to paint, or null. */
  selected(): Layer | null;
  /** Returns the layer with this id, or null. */
  layer(id: number | null): Layer | null;
  changed(): void;
}

/** Whether the values of a layer are classes or keys, which are either equal or different. */
export const hasClasses = ({ kind, palette }: Layer): boolean =>
  kind === "database" || palette.mode === "categorical";

/** Returns the largest tolerance of the slider, in the unit of the comparison. */
export function mostTolerance(by: WandBy, layer: Layer | null): number {
  if (by === "color") return 60;
  if (by === "normal") return 90;
  if (!layer || hasClasses(layer)) return 0;
  const { min, max, points = [] } = layer.palette;
  const low = min ?? points[0]?.at ?? 0;
  const high = max ?? points[points.length - 1]?.at ?? 1;
  return Math.max(0, high - low) / 2;
}

export class Wand {
  by: WandBy = "color";
  /** The surface image with the colors; null: the visible ones. */
  look: number | null = null;
  contiguous = true;
  /** Whether only the surface that a brush passes is selected. */
  brushes = false;
  /** The maximum distance from the point in millimeters; null: no limit. */
  reachMm: number | null = null;
  private _layer: number | null = null; // with the compared values; null: the selected layer
  // shares of the largest tolerance
  private readonly _tolerance: Record<WandBy, number> = { color: 0.2, normal: 0.2, value: 0.2 };

  constructor(private readonly _host: WandHost) {}

  /** The layer whose values are compared. */
  get layer(): Layer | null {
    return this._host.layer(this._layer) ?? this._host.selected();
  }

  get mostTolerance(): number {
    return mostTolerance(this.by, this.layer);
  }
  get tolerance(): number {
    return this._tolerance[this.by] * this.mostTolerance;
  }
  setTolerance(tolerance: number): void {
    const most = this.mostTolerance;
    if (most > 0) this._tolerance[this.by] = Math.min(1, Math.max(0, tolerance / most));
    this._host.changed();
  }

  /** Changes what is compared, or how far the selection reaches. */
  set(change: Partial<Pick<Wand, "by" | "look" | "contiguous" | "brushes" | "reachMm">>): void {
    Object.assign(this, change);
    this._host.changed();
  }
  setLayer(layer: Layer): void {
    this._layer = layer.id;
    this._host.changed();
  }

  /**
   * The surface that looks like the surface at this place, in the contract's format. With a path,
   * only the surface that the brush passes.
   */
  likeAt(at: Like["at"], brushed: Brushed | null = null): Like {
    // The selection does not change when the user selects another layer to paint.
    if (this.by === "value") this._layer ??= this._host.selected()?.id ?? null;
    const { by, look, layer, tolerance, contiguous, reachMm } = this;
    return {
      at,
      by,
      tolerance,
      contiguous,
      ...(by === "value" && layer ? { layer: layer.slug } : {}),
      ...(by === "color" && look !== null ? { look } : {}),
      ...(brushed ?? (reachMm === null ? {} : { radius_mm: reachMm })),
    };
  }
}
