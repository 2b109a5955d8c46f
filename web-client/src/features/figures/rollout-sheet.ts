// The place of the picture of an unrolled sheet, and of parts that are drawn on it. Lengths are in
// millimeters on the sheet.

import type { RolloutSheet, UnrolledLine, Within } from "../../core/protocol.gen";
import type { PaintPart } from "../../session/picture/picture-drawing";

/** Returns the upper left corner of the sheet. */
export function sheetOrigin(sheet: RolloutSheet): [number, number] {
  const mmPerUnit = sheet.mm_per_pixel / sheet.units_per_pixel;
  return [sheet.left * mmPerUnit, sheet.top * mmPerUnit];
}

/** Whether two responses describe the same sheet, so that parts of one belong to the other. */
export const isSameSheet = (a: RolloutSheet, b: RolloutSheet): boolean =>
  JSON.stringify(a) === JSON.stringify(b);

/**
 * Returns the area of a part in the contract's format, on the sheet of a response. The fitted values
 * are fixed, so the sheet stays the same.
 */
export const withinSheet = (sheet: RolloutSheet, part: PaintPart): Within => ({
  unrolled: {
    ...fixedSheet(sheet),
    ...("polygon" in part
      ? { polygons: [part.polygon] }
      : { strokes: [{ path: part.stroke.path, radius_mm: part.stroke.radius }] }),
  },
});

/** Returns the sheet of a response in the contract's format, with its fitted values. */
export function fixedSheet(sheet: RolloutSheet): Omit<UnrolledLine, "path"> {
  const { axis, shape, radius, side, from, to } = sheet;
  return {
    axis,
    // The server finds the same cross section again.
    ...(shape === "general_cylinder"
      ? { shape }
      : { radius, ...(shape === "cone" ? { half_angle: sheet.half_angle } : {}) }),
    side,
    // The middle of the gap, or the end of a wall that goes all around.
    cut: ((from + to) / 2 + 180) % 360,
  };
}
