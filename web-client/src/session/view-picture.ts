// The picture of the current view that a response contains, such as a marked area.

import type { SelectionPicture } from "../core/protocol.gen";
import type { OrbitCamera } from "../math/camera";

const kMostPixels = 640; // longer side; enough for areas and previews

export function pictureOfView(camera: OrbitCamera): SelectionPicture {
  const scale = Math.min(1, kMostPixels / Math.max(camera.width, camera.height));
  const side = (pixels: number): number => Math.max(1, Math.round(pixels * scale));
  return { camera: camera.message(), width: side(camera.width), height: side(camera.height) };
}
