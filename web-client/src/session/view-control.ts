// The camera of this page's view: it moves while nothing is painted, and the server hears of every
// move.

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

const kStillAfterMs = 120; // without input the camera counts as still
const kFlightMs = 600;
// in which a followed camera comes nearer by a factor of e
const kEaseMs = { least: 70, most: 250 };

export interface ViewHost {
  send(moving: boolean): void;
  /**
   * Runs the action now, or as soon as no stroke is under way: a stroke's pixels are of the camera
   * that it began with.
   */
  whenFree(action: () => void): void;
  isPainting(): boolean;
  cameToRest(): void;
  /** This person moved the view, which looked along with somebody. */
  wentOwnWay(): void;
  changed(): void;
}

export class ViewControl {
  readonly camera = new OrbitCamera();
  /** Window pixels per CSS pixel. */
  scale = 1;
  framesDrawn = 0;

  private _hasModel = false;
  private _fitted = false;
  private _stillTimer: ReturnType<typeof setTimeout> | null = null;
  private _flight = 0; // of requestAnimationFrame; 0: none
  private _flightTo: Place | null = null;
  // whom it looks along with
  private _beside: {
    camera: CameraMessage;
    heardMs: number;
    easeMs: number;
    glidedMs: number;
  } | null = null;
  private _glide = 0; // of requestAnimationFrame; 0: none

  constructor(private readonly _host: ViewHost) {}

  /** The stage's size in CSS pixels, and window pixels for each of them. */
  setViewport(width: number, height: number, scale: number): void {
    this._host.whenFree(() => {
      this.scale = scale;
      this.camera.resize(width * scale, height * scale);
      this.fitAtFirst();
      this.moved(false);
      this.glide();
    });
  }

  /** The model as it is now known; `turned`: its up direction is another than before. */
  setModel(model: Model, turned: boolean): void {
    this._hasModel = true;
    this.camera.setModel(model.bounds, model.up);
    this.fitAtFirst();
    if (turned) this.moved(false);
  }

  /** Shows the model with another up direction without keeping it. */
  previewUp(model: Model, up: Model["up"]): void {
    if (this.camera.up === up) return;
    this.endFlight();
    this.camera.setModel(model.bounds, up);
    this.camera.fit(); // another side of it lies before the eye
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
  /** To a part of the model, as `fly`. */
  flyTo(box: Bounds, normal?: Vec3): void {
    if (this._host.isPainting()) return;
    const from = placeOf(this.camera);
    this.camera.resetField();
    this.camera.lookAt(box, normal);
    const to = placeOf(this.camera);
    Object.assign(this.camera, from);
    this.fly(to);
  }
  /**
   * To where a camera stands, in so long; at once for people who want less motion. Any other move
   * ends the flight.
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

  /** Where it stands, or flies to. */
  get place(): Place {
    return this._flightTo ?? placeOf(this.camera);
  }

  /**
   * To where somebody's newest camera is, and along with it until `look_alone`. Strokes are waited
   * for.
   */
  lookAlong(camera: CameraMessage): void {
    const now = performance.now();
    if (this._beside) {
      // As smooth as what comes is frequent.
      const easeMs = Math.min(kEaseMs.most, Math.max(kEaseMs.least, now - this._beside.heardMs));
      this._beside = { ...this._beside, camera, heardMs: now, easeMs };
    } else {
      this.endFlight();
      this._beside = { camera, heardMs: now, easeMs: kEaseMs.most / 2, glidedMs: now };
    }
    this._host.whenFree(() => this.glide());
  }

  /** What it shows stays, seen with the usual field. */
  lookAlone(): void {
    if (!this._beside) return;
    this._beside = null;
    this.endGlide();
    this._host.whenFree(() => {
      this.camera.resetField();
      this.moved(false);
    });
  }

  /** Turns from now on around what is seen in the middle, in this depth. */
  turnAround(depth: number): void {
    this.camera.turnAround(depth);
  }

  /** On its way to where somebody looks from. */
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
    // so that the eye goes straight
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

  /** What the planes cut away is not there: for the picture, the brush and the pointer alike. */
  setSection(planes: Plane[], moving: boolean): void {
    this._host.whenFree(() => {
      this.camera.section = planes;
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

  /** Once the model and the stage's size are both known. */
  private fitAtFirst(): void {
    if (this._fitted || !this._hasModel || this.camera.width <= 1) return;
    this._fitted = true;
    this.camera.firstView();
    this.moved(false);
  }

  /** A kept view of another window may have brought another field. Small moves go on with it. */
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
