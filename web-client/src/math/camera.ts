// The viewer's camera: a turntable around the model's up axis, in world coordinates and double
// precision. The server subtracts the model's origin. Pixels refer to the window (width × height),
// with the origin at the top left and y down.

import type { Plane } from "../core/protocol.gen";
import { add, cross, dot, length, scale, subtract, transform, type Vec3 } from "./vector";

export type UpAxis = "x" | "y" | "z" | "-x" | "-y" | "-z";
export type StandardView = "front" | "back" | "left" | "right" | "top" | "bottom";

export interface Bounds {
  min: Vec3;
  max: Vec3;
}

/** The camera in the format of the protocol: column-major matrices, OpenGL clip space. */
export interface CameraMessage {
  view: number[];
  projection: number[];
  width: number;
  height: number;
  section?: Plane[];
  hidden_parts?: number[];
}

/**
 * Returns a function for a camera. It returns the world length of a window pixel at a point in front
 * of the eye.
 */
export function pixelSizeThrough({
  view,
  projection,
  height,
}: CameraMessage): (place: Vec3) => number {
  const unit = 2 / (projection[5]! * height); // at depth 1, or at any depth without perspective
  const perspective = projection[11] !== 0;
  return (place) =>
    perspective ? -unit * transform(view, [place[0], place[1], place[2], 1])[2] : unit;
}

const kFieldOfView = (35 * Math.PI) / 180; // vertical field of view
export const kHalfFieldTangent = Math.tan(kFieldOfView / 2);
const kMinZoom = 1e-4; // smallest and largest distance, relative to the model's radius
const kMaxZoom = 40;
const kFitMargin = 1.04;

interface Frame {
  right: Vec3;
  into: Vec3;
  up: Vec3;
}

// Right-handed coordinate frames of the front view: to the right, into the screen, and up. The
// coordinate frame of the opposite axis is rotated about `right` by half a turn, as on the server
// (server/core/up.h).
export const kFrames: Record<UpAxis, Frame> = {
  z: { right: [1, 0, 0], into: [0, 1, 0], up: [0, 0, 1] },
  y: { right: [1, 0, 0], into: [0, 0, -1], up: [0, 1, 0] },
  x: { right: [0, 1, 0], into: [0, 0, 1], up: [1, 0, 0] },
  "-z": { right: [1, 0, 0], into: [0, -1, 0], up: [0, 0, -1] },
  "-y": { right: [1, 0, 0], into: [0, 0, 1], up: [0, -1, 0] },
  "-x": { right: [0, 1, 0], into: [0, 0, -1], up: [-1, 0, 0] },
};
export const kUpAxes: readonly UpAxis[] = ["x", "y", "z", "-x", "-y", "-z"];

/** Returns the name of an axis, such as "z" or "−y". */
export const axisName = (up: UpAxis): string => up.replace("-", "−");
/** Returns the name of an up direction, such as "+Z" or "−Y". */
export const upName = (up: UpAxis): string =>
  (up.startsWith("-") ? `−${up.slice(1)}` : `+${up}`).toUpperCase();

export const centre = (bounds: Bounds): Vec3 => scale(add(bounds.min, bounds.max), 0.5);
export const boundingRadius = (bounds: Bounds): number =>
  Math.max(length(subtract(bounds.max, bounds.min)) / 2, 1e-9);

export class OrbitCamera {
  target: Vec3 = [0, 0, 0];
  distance = 1;
  azimuth = 0; // radians around the up axis; 0 is the front view
  elevation = 0; // radians above the horizon, −π/2…π/2
  perspective = true;
  /**
   * The tangent of half the vertical field of view. It differs from the default while this camera
   * shows another participant's view, or a view that was saved in another window.
   */
  halfField = kHalfFieldTangent;
  width = 1; // window pixels
  height = 1;
  /** The planes of the section. The camera does not show the parts that they cut away. */
  section: Plane[] = [];
  /** The numbers of the parts of the model that the camera does not show. */
  hiddenParts: readonly number[] = [];
  /** The boxes of the parts of the model, by number. */
  partBoxes: readonly Bounds[] = [];

  private _bounds: Bounds = { min: [-1, -1, -1], max: [1, 1, 1] };
  private _up: UpAxis = "z";

  get up(): UpAxis {
    return this._up;
  }
  get bounds(): Bounds {
    return this._bounds;
  }

  setModel(bounds: Bounds, up: UpAxis): void {
    this._bounds = bounds;
    this._up = up;
  }

  resize(width: number, height: number): void {
    this.width = Math.max(1, Math.round(width));
    this.height = Math.max(1, Math.round(height));
  }

  /** Shows the whole model from the current direction. */
  fit(): void {
    const { min, max } = this._bounds;
    const { right, up, back } = this.axes();
    const halfWidth = (this.halfField * this.width) / this.height;
    this.target = centre(this._bounds);
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const at: Vec3 = [
        corner & 1 ? max[0] : min[0],
        corner & 2 ? max[1] : min[1],
        corner & 4 ? max[2] : min[2],
      ];
      const offset = subtract(at, this.target);
      const towards = this.perspective ? dot(offset, back) : 0;
      const across = Math.abs(dot(offset, right)) / halfWidth;
      const along = Math.abs(dot(offset, up)) / this.halfField;
      distance = Math.max(distance, towards + Math.max(across, along));
    }
    this.distance = Math.max(distance * kFitMargin, boundingRadius(this._bounds) * kMinZoom);
  }

  /**
   * Shows a part of the model, from the direction that its surface faces. Without `normal`, shows
   * the part from its side of the model. For a part near the middle of the model, keeps the
   * direction.
   */
  lookAt(box: Bounds, normal?: Vec3): void {
    const middle = centre(box);
    const outwards = normal ?? subtract(middle, centre(this._bounds));
    const { back } = this.axes();
    const hasSide = normal !== undefined || length(outwards) > 0.15 * boundingRadius(this._bounds);
    // Rotates only if the part faces away from the viewer.
    if (hasSide && dot(outwards, back) < 0.3 * length(outwards)) this.face(outwards);
    this.target = middle;
    const least = boundingRadius(this._bounds) * 0.08; // shows some surroundings of a small part
    const radius = Math.max(boundingRadius(box), least);
    const halfWidth = (this.halfField * this.width) / this.height;
    this.distance = (radius * 1.25) / Math.sin(Math.atan(Math.min(this.halfField, halfWidth)));
  }

  /** Rotates the camera until `outwards` points to the viewer. */
  private face(outwards: Vec3): void {
    const frame = kFrames[this._up];
    const [x, y, z] = [
      dot(outwards, frame.right),
      dot(outwards, frame.into),
      dot(outwards, frame.up),
    ];
    const level = Math.hypot(x, y);
    if (level > 1e-3 * Math.abs(z)) this.azimuth = Math.atan2(x, -y);
    this.elevation = Math.min(1.2, Math.max(-1.2, Math.atan2(z, level)));
  }

  /** Sets the first view, from slightly right and above, which shows that the object is solid. */
  firstView(): void {
    this.azimuth = 0.4;
    this.elevation = 0.18;
    this.fit();
  }

  standardView(view: StandardView): void {
    const quarter = Math.PI / 2;
    const angles: Record<StandardView, [number, number]> = {
      front: [0, 0],
      right: [quarter, 0],
      back: [Math.PI, 0],
      left: [-quarter, 0],
      top: [0, quarter],
      bottom: [0, -quarter],
    };
    [this.azimuth, this.elevation] = angles[view];
    this.fit();
  }

  /**
   * Returns the unit vectors of the window in world coordinates: right, up, and towards the viewer.
   */
  axes(): { right: Vec3; up: Vec3; back: Vec3 } {
    const frame = kFrames[this._up];
    const [sa, ca] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    const [se, ce] = [Math.sin(this.elevation), Math.cos(this.elevation)];
    const right = add(scale(frame.right, ca), scale(frame.into, sa));
    const level = subtract(scale(frame.right, sa), scale(frame.into, ca));
    const back = add(scale(level, ce), scale(frame.up, se));
    return { right, up: cross(back, right), back };
  }

  eye(): Vec3 {
    return add(this.target, scale(this.axes().back, this.distance));
  }

  /** Returns the world length of one window pixel at a depth in front of the eye. */
  unitPerPixel(depth = this.distance): number {
    return (2 * this.halfField * (this.perspective ? depth : this.distance)) / this.height;
  }

  /**
   * Returns a function for the current camera. It returns the world length of a window pixel at a
   * point.
   */
  pixelSize(): (place: Vec3) => number {
    return pixelSizeThrough(this.message());
  }

  /** Restores the default field of view. Objects at the target's distance keep their size. */
  resetField(): void {
    this.distance *= this.halfField / kHalfFieldTangent;
    this.halfField = kHalfFieldTangent;
  }

  /**
   * Sets the center of rotation to the middle of the window at this depth. The view does not
   * change.
   */
  turnAround(depth: number): void {
    this.target = subtract(this.eye(), scale(this.axes().back, depth));
    if (this.perspective) this.distance = depth;
  }

  depthOf(point: Vec3): number {
    return dot(subtract(this.eye(), point), this.axes().back);
  }

  orbit(azimuthDelta: number, elevationDelta: number): void {
    this.azimuth = wrap(this.azimuth + azimuthDelta);
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + elevationDelta));
  }

  /** Rotates the model by a drag in pixels. The angle per pixel is the same in both directions. */
  orbitPixels(dx: number, dy: number): void {
    const turn = Math.PI / Math.min(this.width, this.height);
    this.orbit(-dx * turn, dy * turn);
  }

  panPixels(dx: number, dy: number): void {
    const { right, up } = this.axes();
    const unit = this.unitPerPixel();
    this.target = add(this.target, add(scale(right, -dx * unit), scale(up, dy * unit)));
  }

  /**
   * Zooms in if the factor is less than 1. The point under the window pixel (x, y) keeps its
   * position.
   */
  zoomAt(factor: number, x: number, y: number): void {
    const radius = boundingRadius(this._bounds);
    const distance = Math.min(
      kMaxZoom * radius,
      Math.max(kMinZoom * radius, this.distance * factor),
    );
    const kept = distance / this.distance;
    const anchor = this.pointOnFocusPlane(x, y);
    this.target = add(anchor, scale(subtract(this.target, anchor), kept));
    this.distance = distance;
  }

  pointOnFocusPlane(x: number, y: number): Vec3 {
    const { right, up } = this.axes();
    const unit = this.unitPerPixel();
    return add(
      this.target,
      add(scale(right, (x - this.width / 2) * unit), scale(up, (this.height / 2 - y) * unit)),
    );
  }

  viewMatrix(): number[] {
    const { right, up, back } = this.axes();
    const eye = this.eye();
    return [
      right[0],
      up[0],
      back[0],
      0,
      right[1],
      up[1],
      back[1],
      0,
      right[2],
      up[2],
      back[2],
      0,
      -dot(right, eye),
      -dot(up, eye),
      -dot(back, eye),
      1,
    ];
  }

  projectionMatrix(): number[] {
    const { near, far } = this.depthRange();
    const aspect = this.width / this.height;
    if (this.perspective) {
      const f = 1 / this.halfField;
      return [
        f / aspect,
        0,
        0,
        0,
        0,
        f,
        0,
        0,
        0,
        0,
        (far + near) / (near - far),
        -1,
        0,
        0,
        (2 * far * near) / (near - far),
        0,
      ];
    }
    const halfHeight = this.halfField * this.distance;
    return [
      1 / (halfHeight * aspect),
      0,
      0,
      0,
      0,
      1 / halfHeight,
      0,
      0,
      0,
      0,
      -2 / (far - near),
      0,
      0,
      0,
      -(far + near) / (far - near),
      1,
    ];
  }

  message(): CameraMessage {
    return {
      view: this.viewMatrix(),
      projection: this.projectionMatrix(),
      width: this.width,
      height: this.height,
      ...(this.section.length > 0 ? { section: this.section } : {}),
      ...(this.hiddenParts.length > 0 ? { hidden_parts: [...this.hiddenParts] } : {}),
    };
  }

  /** Returns the window position of a world point, or null for a point behind the eye. */
  project(point: Vec3): { x: number; y: number; depth: number } | null {
    const seen = transform(this.viewMatrix(), [point[0], point[1], point[2], 1]);
    const clip = transform(this.projectionMatrix(), seen);
    if (clip[3] <= 0) return null;
    return {
      x: (clip[0] / clip[3] / 2 + 0.5) * this.width,
      y: (0.5 - clip[1] / clip[3] / 2) * this.height,
      depth: -seen[2],
    };
  }

  /**
   * Returns the window position of a world point, or null for a point behind the eye or outside the
   * window.
   */
  projectInside(point: Vec3): { x: number; y: number; depth: number } | null {
    const at = this.project(point);
    return at && at.x >= 0 && at.y >= 0 && at.x <= this.width && at.y <= this.height ? at : null;
  }

  /** Whether the planes of the section cut the world point away, or it is on hidden parts only. */
  cutsAway(point: Vec3): boolean {
    return (
      this.section.some(([a, b, c, d]) => dot([a, b, c], point) + d < 0) || this.isOnHidden(point)
    );
  }

  /** A point in the boxes of several parts may be on each of them. */
  private isOnHidden(point: Vec3): boolean {
    if (this.hiddenParts.length === 0) return false;
    const margin = boundingRadius(this._bounds) * 1e-3;
    const parts = this.partBoxes.flatMap(({ min, max }, number) =>
      point.every((at, axis) => at >= min[axis]! - margin && at <= max[axis]! + margin)
        ? [number]
        : [],
    );
    return parts.length > 0 && parts.every((number) => this.hiddenParts.includes(number));
  }

  private depthRange(): { near: number; far: number } {
    const radius = boundingRadius(this._bounds) * 1.02;
    const middle = this.depthOf(centre(this._bounds));
    const far = Math.max(middle + radius, radius * 1e-3);
    if (!this.perspective)
      return { near: middle - radius, far: Math.max(far, middle - radius + 1e-9) };
    return { near: Math.max(middle - radius, far * 2e-4), far };
  }
}

/** The position of a camera. `between` interpolates two positions. */
export type Place = Pick<
  OrbitCamera,
  "target" | "distance" | "azimuth" | "elevation" | "perspective" | "halfField"
>;
export const placeOf = (camera: OrbitCamera): Place => {
  const { target, distance, azimuth, elevation, perspective, halfField } = camera;
  return { target, distance, azimuth, elevation, perspective, halfField };
};
export function between(from: Place, to: Place, share: number): Place {
  const mix = (a: number, b: number): number => a + (b - a) * share;
  return {
    target: add(scale(from.target, 1 - share), scale(to.target, share)),
    distance: Math.exp(mix(Math.log(from.distance), Math.log(to.distance))),
    azimuth: wrap(from.azimuth + wrap(to.azimuth - from.azimuth) * share),
    elevation: mix(from.elevation, to.elevation),
    perspective: to.perspective,
    halfField: mix(from.halfField, to.halfField),
  };
}

function wrap(angle: number): number {
  const turn = 2 * Math.PI;
  return ((((angle + Math.PI) % turn) + turn) % turn) - Math.PI;
}
