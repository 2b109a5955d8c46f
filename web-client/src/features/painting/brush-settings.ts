// What is painted with: width, shape, reach, and one value per layer.

import { purpose_of } from "../../domain/palette";
import { holds_fractions, type Layer } from "../../core/types";
import type { ToolShape } from "../../core/protocol.gen";

export type WidthUnit = "px" | "mm";

export const kWidths = { px: { min: 1, max: 2000 }, mm: { min: 0.05, max: 5000 } } as const;

export class BrushSettings {
  unit: WidthUnit = "px";
  width: Record<WidthUnit, number> = { px: 40, mm: 5 }; // diameters; px are CSS pixels
  shape: ToolShape = "disc";
  through = false; // what is hidden, too
  pressure = true; // a pen that is pressed less paints a narrower line
  /**
   * What is seen at more of a slant is left out, where that is wanted. Not together with what is
   * hidden.
   */
  slant = { limited: false, max_deg: 60 };
  /** Of polygon, lasso and bucket. */
  areas: { erases: boolean; reach: "connected" | "island" } = { erases: false, reach: "connected" };
  private readonly values_ = new Map<number, number>();

  set_width(unit: WidthUnit, width: number): void {
    if (!Number.isFinite(width)) return;
    this.width[unit] = Math.min(kWidths[unit].max, Math.max(kWidths[unit].min, width));
  }

  set_slant(max_deg: number): void {
    if (Number.isFinite(max_deg)) this.slant.max_deg = Math.min(90, Math.max(1, max_deg));
  }

  /** One step of the [ and ] keys. */
  step_width(direction: 1 | -1): void {
    const grown = this.width[this.unit] * (direction > 0 ? 1.15 : 1 / 1.15);
    this.set_width(
      this.unit,
      this.unit === "px" ? Math.round(grown + direction * 0.5) : Number(grown.toPrecision(3)),
    );
  }

  value_of(layer: Layer): number {
    return this.values_.get(layer.id) ?? first_value(layer);
  }

  set_value(layer: Layer, value: number): void {
    this.values_.set(layer.id, value);
  }
}

function first_value(layer: Layer): number {
  const { palette } = layer;
  switch (purpose_of(layer)) {
    case "presence":
    case "classes":
    case "records":
      return palette.column ? 1 : (palette.points[0]?.at ?? 1);
    case "measurement": {
      const middle = (palette.min + palette.max) / 2;
      return holds_fractions(layer.type) ? Number(middle.toPrecision(3)) : Math.round(middle);
    }
  }
}
