// Settings of the painting tools: width, shape, reach, and a value for each layer.

import { purposeOf } from "../../domain/palette";
import { holdsFractions, type Layer } from "../../core/types";
import type { ToolShape } from "../../core/protocol.gen";

export type WidthUnit = "px" | "mm";

export const kWidths = { px: { min: 1, max: 2000 }, mm: { min: 0.05, max: 5000 } } as const;

export class BrushSettings {
  unit: WidthUnit = "px";
  width: Record<WidthUnit, number> = { px: 40, mm: 5 }; // diameters; px stands for CSS pixels
  shape: ToolShape = "disc";
  through = false; // whether hidden surfaces are painted too
  pressure = true; // whether a pen with less pressure paints a narrower line
  /**
   * If limited, surfaces at a larger angle to the camera are not painted. Has no effect while
   * `through` is true.
   */
  slant = { limited: false, maxDeg: 60 };
  snaps = false; // whether polygons and lines follow edges in the picture
  /** Settings of polygon, lasso and bucket. */
  areas: { erases: boolean; reach: "connected" | "island" } = { erases: false, reach: "connected" };
  private readonly _values = new Map<number, number>();

  setWidth(unit: WidthUnit, width: number): void {
    if (!Number.isFinite(width)) return;
    this.width[unit] = Math.min(kWidths[unit].max, Math.max(kWidths[unit].min, width));
  }

  setSlant(maxDeg: number): void {
    if (Number.isFinite(maxDeg)) this.slant.maxDeg = Math.min(90, Math.max(1, maxDeg));
  }

  /** Changes the width by one step of the [ and ] keys. */
  stepWidth(direction: 1 | -1): void {
    const grown = this.width[this.unit] * (direction > 0 ? 1.15 : 1 / 1.15);
    this.setWidth(
      this.unit,
      this.unit === "px" ? Math.round(grown + direction * 0.5) : Number(grown.toPrecision(3)),
    );
  }

  valueFor(layer: Layer): number {
    return this._values.get(layer.id) ?? firstValue(layer);
  }

  setValue(layer: Layer, value: number): void {
    this._values.set(layer.id, value);
  }
}

function firstValue(layer: Layer): number {
  const { palette } = layer;
  switch (purposeOf(layer)) {
    case "presence":
    case "classes":
    case "records":
      return palette.column ? 1 : (palette.points[0]?.at ?? 1);
    case "measurement": {
      const middle = (palette.min + palette.max) / 2;
      return holdsFractions(layer.type) ? Number(middle.toPrecision(3)) : Math.round(middle);
    }
  }
}
