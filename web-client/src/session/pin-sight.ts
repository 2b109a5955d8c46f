// Determines the visibility of points on the surface. While the camera moves, points whose surface
// faces the camera are shown, except points that were hidden before. When the camera stops, the
// server returns the surface at the pixels of the points.

import { boundingRadius, type CameraMessage, type OrbitCamera } from "../math/camera";
import type { Point } from "../net/stroke";
import { dot, length, subtract, type Vec3 } from "../math/vector";

export interface PinPlace {
  id: number;
  position: Vec3;
  normal: Vec3;
}

export interface PinSightHost {
  camera(): OrbitCamera;
  /** Returns the points to show. */
  places(): PinPlace[];
  /**
   * Returns the surface point at each of these window pixels (two or more), or null for a pixel off
   * the model.
   */
  lookAt(camera: CameraMessage, pixels: Point[]): Promise<(Vec3 | null)[]>;
  changed(): void;
}

export const kMostLooked = 1000; // largest number of pixels in one request
const kReach = 0.004; // tolerance for a hit in front of a point, relative to the model's radius

export class PinSight {
  private _known = new Map<number, boolean>(); // visibility when the camera last stopped
  private _moved = true; // whether the camera has moved since then
  private _asked = 0;

  constructor(private readonly _host: PinSightHost) {}

  cameraMoved(): void {
    this._moved = true;
    this._asked += 1; // a pending response belongs to another camera
  }

  /**
   * Determines the visibility. Call this when the camera stops, or when the points have changed.
   */
  async look(): Promise<void> {
    const camera = this._host.camera();
    const asked = (this._asked += 1);
    const seenBy = camera.message();
    const known = new Map<number, boolean>();
    const askedOf: { place: PinPlace; depth: number }[] = [];
    const pixels: Point[] = [];
    for (const place of this._host.places()) {
      const at = camera.projectInside(place.position);
      if (!at || pixels.length === kMostLooked) continue;
      if (camera.cutsAway(place.position)) {
        known.set(place.id, false);
        continue;
      }
      askedOf.push({ place, depth: at.depth });
      pixels.push([at.x, at.y]);
    }
    const [only] = pixels;
    if (only && pixels.length === 1) pixels.push(only);
    const surface = pixels.length > 0 ? await this._host.lookAt(seenBy, pixels) : [];
    if (asked !== this._asked) return;
    const reach = kReach * boundingRadius(camera.bounds);
    askedOf.forEach(({ place, depth }, index) => {
      const before = surface[index];
      known.set(place.id, !before || camera.depthOf(before) >= depth - reach);
    });
    this._known = known;
    this._moved = false;
    this._host.changed();
  }

  isSeen(place: PinPlace): boolean {
    const known = this._known.get(place.id);
    if (!this._moved && known !== undefined) return known;
    const camera = this._host.camera();
    return known !== false && faces(camera, place) && !camera.cutsAway(place.position);
  }
}

/** Whether the surface at the point faces the camera. */
export function faces(
  camera: OrbitCamera,
  { position, normal }: Pick<PinPlace, "position" | "normal">,
): boolean {
  const towards = camera.perspective ? subtract(camera.eye(), position) : camera.axes().back;
  return dot(normal, towards) > 0.05 * length(towards);
}
