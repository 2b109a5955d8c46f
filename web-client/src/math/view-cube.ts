// The standard views as faces of a cube around the model.

import type { OrbitCamera, StandardView } from "./camera";

/** The standard views, in the order of their keys. */
export const kStandardViews: readonly StandardView[] = [
  "front",
  "back",
  "left",
  "right",
  "top",
  "bottom",
];

type Direction = Pick<OrbitCamera, "azimuth" | "elevation">;

const kAround: readonly StandardView[] = ["front", "right", "back", "left"];
const kQuarter = Math.PI / 2;
const kSame = 1e-6; // radians

const quarters = (azimuth: number): number => ((Math.round(azimuth / kQuarter) % 4) + 4) % 4;

/** Returns the view whose face points most directly to the viewer. */
export function viewTowards({ azimuth, elevation }: Direction): StandardView {
  if (Math.abs(elevation) > kQuarter / 2) return elevation > 0 ? "top" : "bottom";
  return kAround[quarters(azimuth)]!;
}

/** Returns the standard view from exactly this direction, or null. */
export function standardViewOf(direction: Direction): StandardView | null {
  const { azimuth, elevation } = direction;
  const isUpright = Math.abs(Math.abs(elevation) - kQuarter) < kSame;
  const isLevel = Math.abs(elevation) < kSame;
  const turn = azimuth / kQuarter;
  return (isUpright || isLevel) && Math.abs(turn - Math.round(turn)) < kSame
    ? viewTowards(direction)
    : null;
}

/** Returns the view to which an arrow key moves from `from`. Returns null for other keys. */
export function neighborView(from: StandardView, key: string): StandardView | null {
  const at = kAround.indexOf(from);
  switch (key) {
    case "ArrowRight":
    case "ArrowLeft":
      return kAround[(Math.max(at, 0) + (key === "ArrowRight" ? 1 : 3)) % 4]!;
    case "ArrowUp":
      return from === "bottom" ? "front" : "top";
    case "ArrowDown":
      return from === "top" ? "front" : "bottom";
    default:
      return null;
  }
}
