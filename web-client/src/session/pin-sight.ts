// Which places of the surface are seen, and not behind something. While the camera moves, those
// that were seen and face it count as seen; once it rests, the server says what it sees at their
// pixels.

import { bounding_radius, type CameraMessage, type OrbitCamera } from "../math/camera";
import type { Point } from "../net/connection";
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
  look_at(camera: CameraMessage, pixels: Point[]): Promise<(Vec3 | null)[]>;
  changed(): void;
}

export const kMostLooked = 1000; // pixels that the server looks at in one question
const kReach = 0.004; // of the model's radius: what is no farther before a place is that place

export class PinSight {
  private known_ = new Map<number, boolean>(); // of when the camera rested last
  private moved_ = true; // since then
  private asked_ = 0;

  constructor(private readonly host_: PinSightHost) {}

  camera_moved(): void {
    this.moved_ = true;
    this.asked_ += 1; // an answer that is on its way is of another camera
  }

  /** The camera rests, or there are other places. */
  async look(): Promise<void> {
    const camera = this.host_.camera();
    const asked = (this.asked_ += 1);
    const seen_by = camera.message();
    const known = new Map<number, boolean>();
    const asked_of: { place: PinPlace; depth: number }[] = [];
    const pixels: Point[] = [];
    for (const place of this.host_.places()) {
      const at = camera.project_inside(place.position);
      if (!at || pixels.length === kMostLooked) continue;
      if (camera.cuts_away(place.position)) {
        known.set(place.id, false);
        continue;
      }
      asked_of.push({ place, depth: at.depth });
      pixels.push([at.x, at.y]);
    }
    const [only] = pixels;
    if (only && pixels.length === 1) pixels.push(only);
    const surface = pixels.length > 0 ? await this.host_.look_at(seen_by, pixels) : [];
    if (asked !== this.asked_) return;
    const reach = kReach * bounding_radius(camera.bounds);
    asked_of.forEach(({ place, depth }, index) => {
      const before = surface[index];
      known.set(place.id, !before || camera.depth_of(before) >= depth - reach);
    });
    this.known_ = known;
    this.moved_ = false;
    this.host_.changed();
  }

  is_seen(place: PinPlace): boolean {
    const known = this.known_.get(place.id);
    if (!this.moved_ && known !== undefined) return known;
    const camera = this.host_.camera();
    return known !== false && faces(camera, place) && !camera.cuts_away(place.position);
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
