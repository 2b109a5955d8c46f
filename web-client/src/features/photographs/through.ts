// What the camera of a photograph sees, and edits through it. A picture of the photograph is its
// window with fewer pixels. Drawn points are pixels of the picture with y upward, from 0 downward.

import type { Camera, Edit } from "../../core/protocol.gen";
import type { PaintPart, PicturePoint } from "../../session/picture/picture-drawing";

const kShownWidth = 1200; // of a picture without zoom
const kFrameSide = 1600; // of the longer side of the model's picture

/** Returns the window with this width, or with the width for a zoom, at most that of the camera. */
export function windowOf(camera: Camera, width: number | null, zoom = 1): Camera {
  const shown = width ?? Math.min(camera.width, kShownWidth * zoom);
  return { ...camera, width: shown, height: heightFor(camera, shown) };
}

/** Returns the window in which the model is drawn. */
export function frameThrough(camera: Camera): Camera {
  const share = Math.min(1, kFrameSide / Math.max(camera.width, camera.height));
  return windowOf(camera, Math.max(1, Math.round(camera.width * share)));
}

const heightFor = ({ width, height }: Camera, shown: number): number =>
  Math.max(1, Math.round((height * shown) / width));

/** Returns the edit that paints or erases a drawn part in a window. */
export function editThrough(
  window: Camera,
  part: PaintPart,
  paint: { value: number } | { erase: true },
): Edit {
  return "polygon" in part
    ? { op: "polygon", ...paint, camera: window, path: part.polygon.map(toPixel) }
    : {
        op: "stroke",
        ...paint,
        camera: window,
        path: part.stroke.path.map(toPixel),
        radius_px: part.stroke.radius,
      };
}

/** Returns a drawn point as a pixel of the window. */
export const toPixel = ([x, y]: PicturePoint): [number, number] => [x, -y];
