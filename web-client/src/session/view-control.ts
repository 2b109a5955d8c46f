// The camera of this page's view: it moves while nothing is painted, and the server hears of every
// move.

import {
  between,
  OrbitCamera,
  place_of,
  type Bounds,
  type CameraMessage,
  type Place,
  type StandardView,
} from "../math/camera";
import { has_arrived, place_like } from "../math/fit-to-window";
import type { Plane } from "../core/protocol.gen";
import type { Model } from "../core/types";
import type { Vec3 } from "../math/vector";

const kStillAfter_ms = 120; // without input the camera counts as still
const kFlight_ms = 600;
// in which a followed camera comes nearer by a factor of e
const kEase_ms = { least: 70, most: 250 };

export interface ViewHost {
  send(moving: boolean): void;
  /**
   * Runs the action now, or as soon as no stroke is under way: a stroke's pixels are of the camera
   * that it began with.
   */
  when_free(action: () => void): void;
  is_painting(): boolean;
  came_to_rest(): void;
  /** This person moved the view, which looked along with somebody. */
  went_own_way(): void;
  changed(): void;
}

export class ViewControl {
  readonly camera = new OrbitCamera();
  /** Window pixels per CSS pixel. */
  scale = 1;
  frames_drawn = 0;

  private has_model_ = false;
  private fitted_ = false;
  private still_timer_: ReturnType<typeof setTimeout> | null = null;
  private flight_ = 0; // of requestAnimationFrame; 0: none
  private flight_to_: Place | null = null;
  // whom it looks along with
  private beside_: {
    camera: CameraMessage;
    heard_ms: number;
    ease_ms: number;
    glided_ms: number;
  } | null = null;
  private glide_ = 0; // of requestAnimationFrame; 0: none

  constructor(private readonly host_: ViewHost) {}

  /** The stage's size in CSS pixels, and window pixels for each of them. */
  set_viewport(width: number, height: number, scale: number): void {
    this.host_.when_free(() => {
      this.scale = scale;
      this.camera.resize(width * scale, height * scale);
      this.fit_at_first();
      this.moved(false);
      this.glide();
    });
  }

  /** The model as it is now known; `turned`: its up direction is another than before. */
  set_model(model: Model, turned: boolean): void {
    this.has_model_ = true;
    this.camera.set_model(model.bounds, model.up);
    this.fit_at_first();
    if (turned) this.moved(false);
  }

  /** Shows the model with another up direction without keeping it. */
  preview_up(model: Model, up: Model["up"]): void {
    if (this.camera.up === up) return;
    this.end_flight();
    this.camera.set_model(model.bounds, up);
    this.camera.fit(); // another side of it lies before the eye
    this.moved(false);
  }

  orbit_pixels(dx: number, dy: number): void {
    this.move(() => this.camera.orbit_pixels(dx, dy));
  }
  pan_pixels(dx: number, dy: number): void {
    this.move(() => this.camera.pan_pixels(dx, dy));
  }
  zoom_at(factor: number, x: number, y: number): void {
    this.move(() => this.camera.zoom_at(factor, x, y));
  }
  twist(angle: number): void {
    this.move(() => this.camera.orbit(-angle, 0));
  }
  standard_view(view: StandardView): void {
    this.move_in_usual_field(() => this.camera.standard_view(view));
  }
  fit(): void {
    this.move_in_usual_field(() => this.camera.fit());
  }
  /** To a part of the model, as `fly`. */
  fly_to(box: Bounds, normal?: Vec3): void {
    if (this.host_.is_painting()) return;
    const from = place_of(this.camera);
    this.camera.reset_field();
    this.camera.look_at(box, normal);
    const to = place_of(this.camera);
    Object.assign(this.camera, from);
    this.fly(to);
  }
  /**
   * To where a camera stands, in so long; at once for people who want less motion. Any other move
   * ends the flight.
   */
  fly(to: Place, flight_ms = kFlight_ms): void {
    if (this.host_.is_painting()) return;
    this.go_own_way();
    this.end_flight();
    if (flight_ms <= 0 || wants_less_motion()) {
      Object.assign(this.camera, to);
      this.moved(false);
      return;
    }
    const from = place_of(this.camera);
    this.flight_to_ = to;
    const start = performance.now();
    const step = (): void => {
      const share = Math.min(1, (performance.now() - start) / flight_ms);
      Object.assign(
        this.camera,
        share < 1 ? between(from, to, share * share * (3 - 2 * share)) : to,
      );
      if (share < 1 && !this.host_.is_painting()) this.flight_ = requestAnimationFrame(step);
      else this.end_flight();
      this.moved(this.flight_ !== 0);
    };
    this.flight_ = requestAnimationFrame(step);
  }
  private end_flight(): void {
    if (this.flight_) cancelAnimationFrame(this.flight_);
    this.flight_ = 0;
    this.flight_to_ = null;
  }

  /** Where it stands, or flies to. */
  get place(): Place {
    return this.flight_to_ ?? place_of(this.camera);
  }

  /**
   * To where somebody's newest camera is, and along with it until `look_alone`. Strokes are waited
   * for.
   */
  look_along(camera: CameraMessage): void {
    const now = performance.now();
    if (this.beside_) {
      // As smooth as what comes is frequent.
      const ease_ms = Math.min(
        kEase_ms.most,
        Math.max(kEase_ms.least, now - this.beside_.heard_ms),
      );
      this.beside_ = { ...this.beside_, camera, heard_ms: now, ease_ms };
    } else {
      this.end_flight();
      this.beside_ = { camera, heard_ms: now, ease_ms: kEase_ms.most / 2, glided_ms: now };
    }
    this.host_.when_free(() => this.glide());
  }

  /** What it shows stays, seen with the usual field. */
  look_alone(): void {
    if (!this.beside_) return;
    this.beside_ = null;
    this.end_glide();
    this.host_.when_free(() => {
      this.camera.reset_field();
      this.moved(false);
    });
  }

  /** Turns from now on around what is seen in the middle, in this depth. */
  turn_around(depth: number): void {
    this.camera.turn_around(depth);
  }

  /** On its way to where somebody looks from. */
  get gliding(): boolean {
    return this.glide_ !== 0;
  }

  private glide(): void {
    if (!this.beside_ || this.glide_ || !this.fitted_) return;
    this.beside_.glided_ms = performance.now();
    this.glide_step();
  }

  private readonly glide_step = (): void => {
    this.glide_ = 0;
    const { beside_: beside, camera } = this;
    if (!beside) return;
    if (this.host_.is_painting()) {
      this.host_.when_free(() => this.glide());
      return;
    }
    const to = place_like(beside.camera, camera);
    // so that the eye goes straight
    if (camera.perspective === to.perspective)
      camera.turn_around(to.perspective ? to.distance : camera.depth_of(to.target));
    const now = performance.now();
    const share = wants_less_motion() ? 1 : 1 - Math.exp((beside.glided_ms - now) / beside.ease_ms);
    beside.glided_ms = now;
    Object.assign(camera, between(place_of(camera), to, share));
    const arrived = has_arrived(camera, to);
    if (arrived) Object.assign(camera, to);
    else this.glide_ = requestAnimationFrame(this.glide_step);
    this.moved(!arrived);
  };

  private end_glide(): void {
    if (this.glide_) cancelAnimationFrame(this.glide_);
    this.glide_ = 0;
  }

  private go_own_way(): void {
    if (this.beside_) this.host_.went_own_way();
  }

  set_perspective(perspective: boolean): void {
    this.move_in_usual_field(() => (this.camera.perspective = perspective));
  }

  /** What the planes cut away is not there: for the picture, the brush and the pointer alike. */
  set_section(planes: Plane[], moving: boolean): void {
    this.host_.when_free(() => {
      this.camera.section = planes;
      this.moved(moving);
    });
  }

  count_frame(): void {
    this.frames_drawn += 1;
    if (this.frames_drawn === 1) this.host_.changed();
  }

  stop(): void {
    this.end_flight();
    this.end_glide();
    this.stop_waiting();
  }

  private stop_waiting(): void {
    if (this.still_timer_) clearTimeout(this.still_timer_);
    this.still_timer_ = null;
  }

  /** Once the model and the stage's size are both known. */
  private fit_at_first(): void {
    if (this.fitted_ || !this.has_model_ || this.camera.width <= 1) return;
    this.fitted_ = true;
    this.camera.first_view();
    this.moved(false);
  }

  /** A kept view of another window may have brought another field. Small moves go on with it. */
  private move_in_usual_field(change: () => void): void {
    this.move(() => {
      this.camera.reset_field();
      change();
    }, false);
  }

  private move(change: () => void, moving = true): void {
    if (this.host_.is_painting()) return;
    this.go_own_way();
    this.end_flight();
    change();
    this.moved(moving);
  }

  private moved(moving: boolean): void {
    if (this.fitted_) this.host_.send(moving);
    this.stop_waiting();
    this.still_timer_ = setTimeout(() => {
      this.still_timer_ = null;
      if (moving) this.host_.send(false);
      this.host_.came_to_rest();
    }, kStillAfter_ms);
    this.host_.changed();
  }
}

export const wants_less_motion = (): boolean =>
  matchMedia("(prefers-reduced-motion: reduce)").matches;
