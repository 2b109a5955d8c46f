// Which places of the surface are seen, and not behind something. While the camera moves, those
// that were seen and face it count as seen; once it rests, the server says what it sees at their
// pixels.

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
  /** Those that are to be shown. */
  places(): PinPlace[];
  /** The surface at each of these window pixels (two or more); null off the model. */
  lookAt(camera: CameraMessage, pixels: Point[]): Promise<(Vec3 | null)[]>;
  changed(): void;
}

export const kMostLooked = 1000; // pixels that the server looks at in one question
const kReach = 0.004; // of the model's radius: what is no farther before a place is that place

export class PinSight {
  private _known = new Map<number, boolean>(); // of when the camera rested last
  private _moved = true; // since then
  private _asked = 0;

  constructor(private readonly _host: PinSightHost) {}

  cameraMoved(): void {
    this._moved = true;
    this._asked += 1; // an answer that is on its way is of another camera
  }

  /** The camera rests, or there are other places. */
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

/** Whether the surface at the place is turned to the camera. */
export function faces(
  camera: OrbitCamera,
  { position, normal }: Pick<PinPlace, "position" | "normal">,
): boolean {
  const towards = camera.perspective ? subtract(camera.eye(), position) : camera.axes().back;
  return dot(normal, towards) > 0.05 * length(towards);
}
