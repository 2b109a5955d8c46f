// The camera of this page's view. It does not move while the user paints. Each move is sent to the
// server.

import {
  between,
  OrbitCamera,
  placeOf,
  type Bounds,
  type CameraMessage,
  type Place,
  type StandardView,
} from "../math/camera";
import { hasArrived, placeLike } from "../math/fit-to-window";
import type { Plane } from "../core/protocol.gen";
import type { Model } from "../core/types";
import type { Vec3 } from "../math/vector";

const kStillAfterMs = 120; // after this time without input, the camera has stopped
const kFlightMs = 600;
// The time constants of the movement towards a followed camera.
const kEaseMs = { least: 70, most: 250 };

export interface ViewHost {
  send(moving: boolean): void;
  /**
   * Runs the action now, or after the current stroke, because the pixels of a stroke belong to the
   * camera at its start.
   */
  whenFree(action: () => void): void;
  isPainting(): boolean;
  cameToRest(): void;
  /** This user has moved the view, so the page stops following another view. */
  wentOwnWay(): void;
  changed(): void;
}

export class ViewControl {
  readonly camera = new OrbitCamera();
  /** The number of window pixels per CSS pixel. */
  scale = 1;
  framesDrawn = 0;

  private _hasModel = false;
  private _fitted = false;
  private _first: Place | null = null; // the position of the first view; null for the default
  private _stillTimer: ReturnType<typeof setTimeout> | null = null;
  private _flight = 0; // id of requestAnimationFrame, or 0
  private _flightTo: Place | null = null;
  // The followed camera.
  private _beside: {
    camera: CameraMessage;
    heardMs: number;
    easeMs: number;
    glidedMs: number;
  } | null = null;
  private _glide = 0; // id of requestAnimationFrame, or 0

  constructor(private readonly _host: ViewHost) {}

  /** Sets the stage's size in CSS pixels and the number of window pixels per CSS pixel. */
  setViewport(width: number, height: number, scale: number): void {
    this._host.whenFree(() => {
      this.scale = scale;
      this.camera.resize(width * scale, height * scale);
      this.fitAtFirst();
      this.moved(false);
      this.glide();
    });
  }

  /** Sets the model. `turned` is true if the up direction of the model has changed. */
  setModel(model: Model, turned: boolean): void {
    this._hasModel = true;
    this.camera.setModel(model.bounds, model.up);
    this.camera.partBoxes = (model.parts ?? []).map(({ bounds }) => bounds);
    this.fitAtFirst();
    if (turned) this.moved(false);
  }

  /** Sets the position of the first view. Call this before `setModel`. */
  beginAt(place: Place): void {
    this._first = place;
  }

  /** Shows the model with another up direction without saving it. */
  previewUp(model: Model, up: Model["up"]): void {
    if (this.camera.up === up) return;
    this.endFlight();
    this.camera.setModel(model.bounds, up);
    this.camera.fit(); // another side faces the viewer
    this.moved(false);
  }

  orbitPixels(dx: number, dy: number): void {
    this.move(() => this.camera.orbitPixels(dx, dy));
  }
  panPixels(dx: number, dy: number): void {
    this.move(() => this.camera.panPixels(dx, dy));
  }
  zoomAt(factor: number, x: number, y: number): void {
    this.move(() => this.camera.zoomAt(factor, x, y));
  }
  twist(angle: number): void {
    this.move(() => this.camera.orbit(-angle, 0));
  }
  standardView(view: StandardView): void {
    this.moveInUsualField(() => this.camera.standardView(view));
  }
  fit(): void {
    this.moveInUsualField(() => this.camera.fit());
  }
  /** Flies to a part of the model, like `fly`. */
  flyTo(box: Bounds, normal?: Vec3): void {
    this.flyToResult(() => this.camera.lookAt(box, normal));
  }
  flyToStandard(view: StandardView): void {
    this.flyToResult(() => this.camera.standardView(view));
  }
  /** Flies to the initial view of the model. */
  flyToFirst(): void {
    this.flyToResult(() => this.camera.firstView());
  }
  private flyToResult(change: () => void): void {
    if (this._host.isPainting()) return;
    const from = placeOf(this.camera);
    this.camera.resetField();
    change();
    const to = placeOf(this.camera);
    Object.assign(this.camera, from);
    this.fly(to);
  }
  /**
   * Flies to a position in this time, or immediately for users who prefer reduced motion. Any other
   * move ends the flight.
   */
  fly(to: Place, flightMs = kFlightMs): void {
    if (this._host.isPainting()) return;
    this.goOwnWay();
    this.endFlight();
    if (flightMs <= 0 || wantsLessMotion()) {
      Object.assign(this.camera, to);
      this.moved(false);
      return;
    }
    const from = placeOf(this.camera);
    this._flightTo = to;
    const start = performance.now();
    const step = (): void => {
      const share = Math.min(1, (performance.now() - start) / flightMs);
      Object.assign(
        this.camera,
        share < 1 ? between(from, to, share * share * (3 - 2 * share)) : to,
      );
      if (share < 1 && !this._host.isPainting()) this._flight = requestAnimationFrame(step);
      else this.endFlight();
      this.moved(this._flight !== 0);
    };
    this._flight = requestAnimationFrame(step);
  }
  private endFlight(): void {
    if (this._flight) cancelAnimationFrame(this._flight);
    this._flight = 0;
    this._flightTo = null;
  }

  /** The position of the camera, or the end of its flight. */
  get place(): Place {
    return this._flightTo ?? placeOf(this.camera);
  }

  /** Follows another camera until `lookAlone`, and begins after the current stroke. */
  lookAlong(camera: CameraMessage): void {
    const now = performance.now();
    if (this._beside) {
      // Smoothing depends on the interval between messages.
      const easeMs = Math.min(kEaseMs.most, Math.max(kEaseMs.least, now - this._beside.heardMs));
      this._beside = { ...this._beside, camera, heardMs: now, easeMs };
    } else {
      this.endFlight();
      this._beside = { camera, heardMs: now, easeMs: kEaseMs.most / 2, glidedMs: now };
    }
    this._host.whenFree(() => this.glide());
  }

  /** Stops following. The camera keeps its position and gets the default field of view. */
  lookAlone(): void {
    if (!this._beside) return;
    this._beside = null;
    this.endGlide();
    this._host.whenFree(() => {
      this.camera.resetField();
      this.moved(false);
    });
  }

  /** Sets the center of rotation to the middle of the view at this depth. */
  turnAround(depth: number): void {
    this.camera.turnAround(depth);
  }

  /** Whether the camera is moving towards a followed camera. */
  get gliding(): boolean {
    return this._glide !== 0;
  }

  private glide(): void {
    if (!this._beside || this._glide || !this._fitted) return;
    this._beside.glidedMs = performance.now();
    this.glideStep();
  }

  private readonly glideStep = (): void => {
    this._glide = 0;
    const { _beside: beside, camera } = this;
    if (!beside) return;
    if (this._host.isPainting()) {
      this._host.whenFree(() => this.glide());
      return;
    }
    const to = placeLike(beside.camera, camera);
    // This makes the path of the eye straight.
    if (camera.perspective === to.perspective)
      camera.turnAround(to.perspective ? to.distance : camera.depthOf(to.target));
    const now = performance.now();
    const share = wantsLessMotion() ? 1 : 1 - Math.exp((beside.glidedMs - now) / beside.easeMs);
    beside.glidedMs = now;
    Object.assign(camera, between(placeOf(camera), to, share));
    const arrived = hasArrived(camera, to);
    if (arrived) Object.assign(camera, to);
    else this._glide = requestAnimationFrame(this.glideStep);
    this.moved(!arrived);
  };

  private endGlide(): void {
    if (this._glide) cancelAnimationFrame(this._glide);
    this._glide = 0;
  }

  private goOwnWay(): void {
    if (this._beside) this._host.wentOwnWay();
  }

  setPerspective(perspective: boolean): void {
    this.moveInUsualField(() => (this.camera.perspective = perspective));
  }

  /**
   * Sets the planes of the section and the hidden parts of the model. The frame, the brush and the
   * pointer ignore what they remove.
   */
  setSection(planes: Plane[], hiddenParts: readonly number[], moving: boolean): void {
    this._host.whenFree(() => {
      this.camera.section = planes;
      this.camera.hiddenParts = hiddenParts;
      this.moved(moving);
    });
  }

  countFrame(): void {
    this.framesDrawn += 1;
    if (this.framesDrawn === 1) this._host.changed();
  }

  stop(): void {
    this.endFlight();
    this.endGlide();
    this.stopWaiting();
  }

  private stopWaiting(): void {
    if (this._stillTimer) clearTimeout(this._stillTimer);
    this._stillTimer = null;
  }

  /** Shows the first view, as soon as the model and the stage's size are known. */
  private fitAtFirst(): void {
    if (this._fitted || !this._hasModel || this.camera.width <= 1) return;
    this._fitted = true;
    if (this._first) Object.assign(this.camera, this._first);
    else this.camera.firstView();
    this.moved(false);
  }

  /**
   * Moves the camera and restores the default field of view. A view that was saved in another
   * window may have changed the field. Small moves keep it.
   */
  private moveInUsualField(change: () => void): void {
    this.move(() => {
      this.camera.resetField();
      change();
    }, false);
  }

  private move(change: () => void, moving = true): void {
    if (this._host.isPainting()) return;
    this.goOwnWay();
    this.endFlight();
    change();
    this.moved(moving);
  }

  private moved(moving: boolean): void {
    if (this._fitted) this._host.send(moving);
    this.stopWaiting();
    this._stillTimer = setTimeout(() => {
      this._stillTimer = null;
      if (moving) this._host.send(false);
      this._host.cameToRest();
    }, kStillAfterMs);
    this._host.changed();
  }
}

export const wantsLessMotion = (): boolean =>
  matchMedia("(prefers-reduced-motion: reduce)").matches;
