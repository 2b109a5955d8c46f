// What this person measures on the model: places that were set one by one, the surface between
// them, and what is looked at of it. Places are of the object, not of a picture: the camera moves
// on between them. Nothing of it is stored.

import { ApiError, type Api, type ProfileLine } from "../../net/api";
import { bounding_radius, OrbitCamera, type CameraMessage } from "../../math/camera";
import type { Point } from "../../net/connection";
import type { PointerSample } from "../../ui/input";
import { mark_length, parts_of_line } from "../../domain/marks";
import { legs_of, sum } from "../../math/measured-line";
import { metres_per } from "../../domain/measure";
import type { MarkPlace } from "../../core/protocol.gen";
import {
  length_of,
  passes_through,
  profile_parts,
  simplify_profile,
  type ProfileParts,
  type ProfilePlace,
} from "../../domain/profile";
import type { Layer, Model } from "../../core/types";
import type { Vec3 } from "../../math/vector";
import { kSnap_px } from "../../tools/outline";
import { LineMeasure } from "../../session/line-measure";
import { notices } from "../../ui/notices";
import { faces } from "../../session/pin-sight";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { LayersPart } from "../../session/parts";

export interface MeasuringHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  model(): Model | null;
  changed(): void;
}

export interface MeasuredPlace {
  position: Vec3;
  normal: Vec3;
}

/**
 * How the line lies on the surface: what was seen under its straight legs from one camera, or of
 * each of their steps what is nearest.
 */
export type Way = "seen" | "nearest";

export interface MeasuredProfile {
  way: Way;
  line: ProfileLine;
  /** Model units. */
  parts: ProfileParts;
  /** Its course, in as few places as show it. */
  course: ProfileParts;
  /** All of its places, from the beginning. */
  places: readonly ProfilePlace[];
}

export const kMostPlaces = 100;
const kNearestSteps = 1000;
const kReach_px = 4; // how near the line must come to a place for it to have been seen there
const kReach = 0.001; // of the model's size, besides

export class Measuring {
  places: readonly MeasuredPlace[] = [];
  /** No place follows: the next one begins anew. */
  ended = false;
  profile: MeasuredProfile | null = null;
  /** The surface between the places is being asked for. */
  busy = false;
  problem = "";
  /** The one that the plot points at, also on the model: an index of the profile's places. */
  pointed: number | null = null;

  private way_: Way | null = null; // that the person wants; null: seen where that can be
  private layer_: number | null = null; // whose values are plotted
  private pointer_: PointerSample | null = null;
  private seen_by_: CameraMessage | null = null; // where the pointer was
  private work_: Promise<void> = Promise.resolve(); // taps, one after the other
  private waiting_ = 0; // of them, for an answer or for their turn
  private count_ = 0; // of measurements: what is answered to one that was cleared comes too late
  private asked_ = 0; // for a profile: the newest counts
  private readonly so_far_: LineMeasure<MarkPlace | null>;

  constructor(
    private readonly api_: Api,
    private readonly host_: MeasuringHost,
  ) {
    this.so_far_ = new LineMeasure({
      look_along: (path) => this.look_along(path),
      metres_along: (places) => this.metres_along(places),
      changed: () => host_.changed(),
    });
  }

  // ── what is known
  // ─────────────────────────────────────────────────────────────────────────────────────────────────

  get positions(): Vec3[] {
    return this.places.map(({ position }) => position);
  }
  /** Along the surface; null while it is not known. */
  get along(): number | null {
    return this.profile ? length_of(this.profile.parts) : null;
  }
  /**
   * What is nearest to a line through the object are patches here and there, whose lengths say
   * nothing.
   */
  get has_way(): boolean {
    return this.profile?.way !== "nearest" || this.profile.parts.length === 1;
  }
  /** Metres along the surface to the pointer; null where that is not known. */
  get so_far(): number | null {
    return this.so_far_.metres;
  }
  /** Where a line leads from the last place to the pointer, window pixels. */
  get tip(): Point | null {
    return this.open && this.pointer_ ? [this.pointer_.x, this.pointer_.y] : null;
  }
  /** There are places, or one is on its way. */
  get begun(): boolean {
    return this.places.length > 0 || this.waiting_ > 0;
  }
  /** More places may follow. */
  get open(): boolean {
    return this.places.length > 0 && !this.ended && this.places.length < kMostPlaces;
  }

  /** Those with values that make a curve. */
  get layers(): Layer[] {
    return this.host_.layers.all.filter(
      ({ kind, palette }) => kind === "numeric" && palette.mode !== "categorical",
    );
  }
  /** Whose values are plotted; null: heights are. */
  get layer(): Layer | null {
    return this.layers.find(({ id }) => id === this.layer_) ?? null;
  }

  // ── what the person does
  // ──────────────────────────────────────────────────────────────────────────────────────────

  /** A tap: a new place; on the last one, or on the first of several, the end. */
  set_at({ x, y }: PointerSample): void {
    const camera = this.camera_now();
    const reach = kSnap_px * this.host_.view.scale;
    this.queue(async (is_current) => {
      const is_at = (place: MeasuredPlace): boolean => {
        const at = faces(camera, place) ? camera.project(place.position) : null;
        return at !== null && Math.hypot(at.x - x, at.y - y) <= reach;
      };
      const last = this.places.at(-1);
      if (
        !this.ended &&
        last &&
        (is_at(last) || (this.places.length > 2 && is_at(this.places[0]!)))
      ) {
        this.end_now();
        return;
      }
      const model = this.host_.model();
      if (!model || (!this.ended && this.places.length === kMostPlaces)) return;
      const { hit, position, normal } = await this.api_.pick(model.id, camera.message(), [x, y]);
      if (!is_current()) return;
      if (!hit || !position) {
        notices.show("info", texts.marks.missed);
        return;
      }
      if (this.ended) this.begin_anew();
      this.places = [...this.places, { position, normal: normal ?? camera.axes().back }];
      this.places_changed(camera);
    });
  }

  set_in_middle(): void {
    const { width, height } = this.host_.view.camera;
    this.set_at({ x: width / 2, y: height / 2 });
  }

  end(): void {
    this.queue(async () => this.end_now());
  }

  /** The last place. What was ended is open again. */
  take_back(): void {
    this.queue(async () => {
      this.ended = false;
      this.places = this.places.slice(0, -1);
      this.places_changed(this.camera_now());
    });
  }

  clear(): void {
    this.count_ += 1;
    this.waiting_ = 0;
    this.begin_anew();
    this.follow_pointer();
    this.host_.changed();
  }

  point_at(sample: PointerSample | null): void {
    this.pointer_ = sample;
    this.follow_pointer();
  }

  /** The line as it is seen from here, or nearest to its straight legs. */
  choose_way(way: Way): void {
    this.way_ = way;
    void this.learn(this.camera_now());
  }

  choose_layer(id: number | null): void {
    this.layer_ = id;
    const { profile } = this;
    for (const place of profile?.places ?? []) place.value = null; // those are of another one
    if (profile) void this.ask_values(profile);
    this.host_.changed();
  }

  point_out(index: number | null): void {
    if (this.pointed === index) return;
    this.pointed = index;
    this.host_.changed();
  }

  /** As the server writes it: with the values of all layers that this person sees. */
  async csv(): Promise<Blob> {
    const { profile } = this;
    const model = this.host_.model();
    if (!profile || !model) throw new Error("nothing is measured");
    return this.api_.profile_csv(model.id, profile.line);
  }

  // ── what happens
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  /** How long the line to the pointer is, was told of another camera. */
  camera_moved(): void {
    this.so_far_.follow(null);
  }
  came_to_rest(): void {
    this.follow_pointer();
  }
  on_layer_edited(id: number): void {
    if (this.layer?.id === id && this.profile) void this.ask_values(this.profile);
  }

  // ── the surface between the places
  // ────────────────────────────────────────────────────────────────────────────────

  /** It moves on while answers are waited for. */
  private camera_now(): OrbitCamera {
    return Object.assign(new OrbitCamera(), this.host_.view.camera);
  }

  private begin_anew(): void {
    this.places = [];
    this.ended = false;
    this.forget_profile();
  }

  private forget_profile(): void {
    this.asked_ += 1;
    this.profile = this.pointed = null;
    this.busy = false;
    this.problem = "";
  }

  private end_now(): void {
    if (this.places.length < 2) return;
    this.ended = true;
    this.follow_pointer();
    this.host_.changed();
  }

  private places_changed(camera: OrbitCamera): void {
    this.forget_profile();
    if (this.places.length > 1) void this.learn(camera);
    this.follow_pointer();
    this.host_.changed();
  }

  /** One after the other: a tap is about what the one before left. */
  private queue(work: (is_current: () => boolean) => Promise<void>): void {
    const count = this.count_;
    const is_current = (): boolean => count === this.count_;
    this.waiting_ += 1;
    this.work_ = this.work_
      .then(() => (is_current() ? work(is_current) : undefined))
      .catch((error: unknown) => notices.error(error))
      .finally(() => void (this.waiting_ -= is_current() ? 1 : 0));
  }

  /** What is known of the same places stays until then. */
  private async learn(camera: OrbitCamera): Promise<void> {
    const model = this.host_.model();
    if (!model || this.places.length < 2) return;
    const asked = (this.asked_ += 1);
    this.busy = true;
    this.problem = "";
    this.host_.changed();
    try {
      const profile =
        (this.way_ === "nearest" ? null : await this.ask_seen(model, camera)) ??
        (await this.ask_nearest(model));
      if (asked !== this.asked_) return;
      this.profile = profile;
      this.pointed = null;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked === this.asked_) this.problem = error.message;
    }
    if (asked === this.asked_) this.busy = false;
    this.host_.changed();
  }

  /** Null where not all places are seen from there. */
  private async ask_seen(model: Model, camera: OrbitCamera): Promise<MeasuredProfile | null> {
    const { positions } = this;
    const pixels = positions.flatMap((position): Point[] => {
      const at = camera.project_inside(position);
      return at ? [[at.x, at.y]] : [];
    });
    if (pixels.length < positions.length) return null;
    const pixel_at = camera.pixel_size();
    const profile = await this.ask(
      model,
      "seen",
      { camera: camera.message(), path: pixels },
      pixel_at,
    );
    return passes_through(
      profile.parts,
      positions,
      (place) => kReach_px * pixel_at(place) + kReach * bounding_radius(camera.bounds),
    )
      ? profile
      : null;
  }

  private ask_nearest(model: Model): Promise<MeasuredProfile> {
    const { positions } = this;
    const step = Math.max(sum(legs_of(positions)) / kNearestSteps, 1e-9);
    return this.ask(
      model,
      "nearest",
      { places: positions, step_mm: Math.max(step * metres_per(model.unit) * 1000, 1e-6) },
      () => step,
    );
  }

  private async ask(
    model: Model,
    way: Way,
    line: ProfileLine,
    step_at: (place: Vec3) => number,
  ): Promise<MeasuredProfile> {
    const { layer } = this;
    const { samples } = await this.api_.profile_of(model.id, {
      ...line,
      layers: layer ? [layer.slug] : [],
    });
    const parts = profile_parts(samples, step_at, layer?.slug ?? null);
    return {
      way,
      line,
      parts,
      course: simplify_profile(parts, (place) => step_at(place) / 4),
      places: parts.flat(),
    };
  }

  /** The same line, with values of the layer that is plotted now. */
  private async ask_values(profile: MeasuredProfile): Promise<void> {
    const { layer } = this;
    const model = this.host_.model();
    if (!layer || !model) return;
    try {
      const { samples } = await this.api_.profile_of(model.id, {
        ...profile.line,
        layers: [layer.slug],
      });
      if (this.profile !== profile || this.layer?.id !== layer.id) return;
      const values = samples.flatMap(({ point: { hit, values } }) =>
        hit ? [values?.[layer.slug]] : [],
      );
      profile.places.forEach((place, index) => {
        const found = values[index];
        place.value = found?.valid && found.value !== undefined ? found.value : null;
      });
      this.profile = { ...profile };
      this.host_.changed();
    } catch (error) {
      notices.error(error);
    }
  }

  // ── the line to the pointer
  // ───────────────────────────────────────────────────────────────────────────────────────

  private follow_pointer(): void {
    const { camera } = this.host_.view;
    const { tip } = this;
    const points = tip ? this.positions.map((position) => camera.project_inside(position)) : [];
    if (!tip || points.includes(null)) {
      this.so_far_.follow(null);
      return;
    }
    this.seen_by_ = camera.message();
    this.so_far_.follow({ points: points.map((at): Point => [at!.x, at!.y]), pointer: tip });
  }

  private async look_along(path: readonly Point[]): Promise<readonly (MarkPlace | null)[]> {
    const { samples } = await this.api_.profile(this.host_.model()!.id, this.seen_by_!, path);
    return samples.map(({ point }) => (point.hit && point.position ? point.position : null));
  }

  private metres_along(places: readonly (MarkPlace | null)[]): number {
    const parts = parts_of_line(places, (place) => place, this.host_.view.camera.pixel_size());
    return (
      sum(parts.map((coordinates) => mark_length({ coordinates }))) *
      metres_per(this.host_.model()!.unit)
    );
  }
}
