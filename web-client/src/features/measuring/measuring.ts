// This user's measurement on the model: the points, the surface between them, and the plotted
// values. Points belong to the object and not to an image, so the camera may move between them.
// Nothing is stored.

import type { Sent } from "../../net/calls";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { boundingRadius, OrbitCamera, type CameraMessage } from "../../math/camera";
import type { Point } from "../../net/stroke";
import type { PointerSample } from "../../ui/input";
import { markLength, partsOfLine } from "../../domain/marks";
import { legsOf, sum } from "../../math/measured-line";
import { metresPer } from "../../domain/measure";
import type { MarkPlace, ProfileRequest } from "../../core/protocol.gen";
import {
  lengthOf,
  passesThrough,
  profileParts,
  simplifyProfile,
  type ProfileParts,
  type ProfilePlace,
} from "../../domain/profile";
import type { Layer, Model } from "../../core/types";
import type { Vec3 } from "../../math/vector";
import { kSnapPx } from "../../tools/outline";
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
 * How the line follows the surface. "seen" follows the surface that one camera sees under the
 * straight legs. "nearest" uses the nearest surface point for each step of the legs.
 */
export type Way = "seen" | "nearest";

export interface MeasuredProfile {
  way: Way;
  line: Sent<ProfileRequest>;
  /** In model units. */
  parts: ProfileParts;
  /** The course with as few points as necessary. */
  course: ProfileParts;
  /** All points, from the start. */
  places: readonly ProfilePlace[];
}

export const kMostPlaces = 100;
const kNearestSteps = 1000;
const kReachPx = 4; // a point is visible if the line on the surface passes it within this distance
const kReach = 0.001; // added to this distance, as a share of the model's radius

export class Measuring {
  places: readonly MeasuredPlace[] = [];
  /** Whether the measurement is complete, so the next tap starts a new one. */
  ended = false;
  profile: MeasuredProfile | null = null;
  /** Whether a request for the surface between the points is pending. */
  busy = false;
  problem = "";
  /** The marked point in the plot and on the model, as an index of the profile's points. */
  pointed: number | null = null;

  private _way: Way | null = null; // the user's choice; null stands for "seen" where possible
  private _layer: number | null = null; // the layer with the plotted values
  private _pointer: PointerSample | null = null;
  // the camera at the time of the last pointer position
  private _seenBy: CameraMessage | null = null;
  private _work: Promise<void> = Promise.resolve(); // taps are processed one at a time
  private _waiting = 0; // the number of pending taps
  private _count = 0; // the number of measurements; responses for earlier measurements are ignored
  private _asked = 0; // the number of profile requests; only the response to the latest one is used
  private readonly _soFar: LineMeasure<MarkPlace | null>;

  constructor(
    private readonly _api: Api,
    private readonly _host: MeasuringHost,
  ) {
    this._soFar = new LineMeasure({
      lookAlong: (path) => this.lookAlong(path),
      metresAlong: (places) => this.metresAlong(places),
      changed: () => _host.changed(),
    });
  }

  // ── state ──────────────────────────────────────────────────────────────────────────────────────

  get positions(): Vec3[] {
    return this.places.map(({ position }) => position);
  }
  /** The length along the surface; null while it is unknown. */
  get along(): number | null {
    return this.profile ? lengthOf(this.profile.parts) : null;
  }
  /**
   * Whether the length along the surface is meaningful. If a line passes through the object, its
   * nearest surface points form separate patches, and their length is meaningless.
   */
  get hasWay(): boolean {
    return this.profile?.way !== "nearest" || this.profile.parts.length === 1;
  }
  /** The length along the surface to the pointer, in meters; null if it is unknown. */
  get soFar(): number | null {
    return this._soFar.metres;
  }
  /** The end of the line from the last point to the pointer, in window pixels. */
  get tip(): Point | null {
    return this.open && this._pointer ? [this._pointer.x, this._pointer.y] : null;
  }
  /** Whether there are points, or a tap that is still being processed. */
  get begun(): boolean {
    return this.places.length > 0 || this._waiting > 0;
  }
  /** Whether the next tap adds a point. */
  get open(): boolean {
    return this.places.length > 0 && !this.ended && this.places.length < kMostPlaces;
  }

  /** The layers with values that can be plotted as a curve. */
  get layers(): Layer[] {
    return this._host.layers.all.filter(
      ({ kind, palette }) => kind === "numeric" && palette.mode !== "categorical",
    );
  }
  /** The layer with the plotted values; null for heights. */
  get layer(): Layer | null {
    return this.layers.find(({ id }) => id === this._layer) ?? null;
  }

  // ── actions ────────────────────────────────────────────────────────────────────────────────────

  /**
   * A tap sets a new point. A tap on the last point, or on the first of several, ends the
   * measurement.
   */
  setAt({ x, y }: PointerSample): void {
    const camera = this.cameraNow();
    const reach = kSnapPx * this._host.view.scale;
    this.queue(async (isCurrent) => {
      const isAt = (place: MeasuredPlace): boolean => {
        const at = faces(camera, place) ? camera.project(place.position) : null;
        return at !== null && Math.hypot(at.x - x, at.y - y) <= reach;
      };
      const last = this.places.at(-1);
      if (
        !this.ended &&
        last &&
        (isAt(last) || (this.places.length > 2 && isAt(this.places[0]!)))
      ) {
        this.endNow();
        return;
      }
      const model = this._host.model();
      if (!model || (!this.ended && this.places.length === kMostPlaces)) return;
      const { hit, position, normal } = await this._api.json("POST /models/{model}/pick", {
        path: { model: model.id },
        body: { camera: camera.message(), x, y },
      });
      if (!isCurrent()) return;
      if (!hit || !position) {
        notices.show("info", texts.marks.missed);
        return;
      }
      if (this.ended) this.beginAnew();
      this.places = [...this.places, { position, normal: normal ?? camera.axes().back }];
      this.placesChanged(camera);
    });
  }

  setInMiddle(): void {
    const { width, height } = this._host.view.camera;
    this.setAt({ x: width / 2, y: height / 2 });
  }

  end(): void {
    this.queue(async () => this.endNow());
  }

  /** Removes the last point. Opens an ended measurement again. */
  takeBack(): void {
    this.queue(async () => {
      this.ended = false;
      this.places = this.places.slice(0, -1);
      this.placesChanged(this.cameraNow());
    });
  }

  clear(): void {
    this._count += 1;
    this._waiting = 0;
    this.beginAnew();
    this.followPointer();
    this._host.changed();
  }

  pointAt(sample: PointerSample | null): void {
    this._pointer = sample;
    this.followPointer();
  }

  /**
   * Sets how the line follows the surface: as the current camera sees it, or through the surface
   * points that are nearest to the straight legs.
   */
  chooseWay(way: Way): void {
    this._way = way;
    void this.learn(this.cameraNow());
  }

  chooseLayer(id: number | null): void {
    this._layer = id;
    const { profile } = this;
    for (const place of profile?.places ?? []) place.value = null; // values of the previous layer
    if (profile) void this.askValues(profile);
    this._host.changed();
  }

  pointOut(index: number | null): void {
    if (this.pointed === index) return;
    this.pointed = index;
    this._host.changed();
  }

  /** Returns the server's file, with the values of all layers that this user sees. */
  async csv(): Promise<Blob> {
    const { profile } = this;
    const model = this._host.model();
    if (!profile || !model) throw new Error("nothing is measured");
    return this._api.blob("POST /models/{model}/profile", {
      path: { model: model.id },
      body: profile.line,
      accept: "text/csv",
    });
  }

  // ── events ─────────────────────────────────────────────────────────────────────────────────────

  /**
   * Ends the measurement of the line to the pointer, because its pixels belong to the old camera.
   */
  cameraMoved(): void {
    this._soFar.follow(null);
  }
  cameToRest(): void {
    this.followPointer();
  }
  onLayerEdited(id: number): void {
    if (this.layer?.id === id && this.profile) void this.askValues(this.profile);
  }

  // ── the surface between the points ─────────────────────────────────────────────────────────────

  /** Returns a copy, because the camera may move before a response arrives. */
  private cameraNow(): OrbitCamera {
    return Object.assign(new OrbitCamera(), this._host.view.camera);
  }

  private beginAnew(): void {
    this.places = [];
    this.ended = false;
    this.forgetProfile();
  }

  private forgetProfile(): void {
    this._asked += 1;
    this.profile = this.pointed = null;
    this.busy = false;
    this.problem = "";
  }

  private endNow(): void {
    if (this.places.length < 2) return;
    this.ended = true;
    this.followPointer();
    this._host.changed();
  }

  private placesChanged(camera: OrbitCamera): void {
    this.forgetProfile();
    if (this.places.length > 1) void this.learn(camera);
    this.followPointer();
    this._host.changed();
  }

  /** Runs one task at a time, because a tap depends on the result of the previous one. */
  private queue(work: (isCurrent: () => boolean) => Promise<void>): void {
    const count = this._count;
    const isCurrent = (): boolean => count === this._count;
    this._waiting += 1;
    this._work = this._work
      .then(() => (isCurrent() ? work(isCurrent) : undefined))
      .catch((error: unknown) => notices.error(error))
      .finally(() => void (this._waiting -= isCurrent() ? 1 : 0));
  }

  /** Requests the profile. Until the response arrives, keeps a known profile of the same points. */
  private async learn(camera: OrbitCamera): Promise<void> {
    const model = this._host.model();
    if (!model || this.places.length < 2) return;
    const asked = (this._asked += 1);
    this.busy = true;
    this.problem = "";
    this._host.changed();
    try {
      const profile =
        (this._way === "nearest" ? null : await this.askSeen(model, camera)) ??
        (await this.askNearest(model));
      if (asked !== this._asked) return;
      this.profile = profile;
      this.pointed = null;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked === this._asked) this.problem = error.message;
    }
    if (asked === this._asked) this.busy = false;
    this._host.changed();
  }

  /** Returns null if the camera does not see all points. */
  private async askSeen(model: Model, camera: OrbitCamera): Promise<MeasuredProfile | null> {
    const { positions } = this;
    const pixels = positions.flatMap((position): Point[] => {
      const at = camera.projectInside(position);
      return at ? [[at.x, at.y]] : [];
    });
    if (pixels.length < positions.length) return null;
    const pixelAt = camera.pixelSize();
    const profile = await this.ask(
      model,
      "seen",
      { camera: camera.message(), path: pixels },
      pixelAt,
    );
    return passesThrough(
      profile.parts,
      positions,
      (place) => kReachPx * pixelAt(place) + kReach * boundingRadius(camera.bounds),
    )
      ? profile
      : null;
  }

  private askNearest(model: Model): Promise<MeasuredProfile> {
    const { positions } = this;
    const step = Math.max(sum(legsOf(positions)) / kNearestSteps, 1e-9);
    return this.ask(
      model,
      "nearest",
      { places: positions, step_mm: Math.max(step * metresPer(model.unit) * 1000, 1e-6) },
      () => step,
    );
  }

  private async ask(
    model: Model,
    way: Way,
    line: Sent<ProfileRequest>,
    stepAt: (place: Vec3) => number,
  ): Promise<MeasuredProfile> {
    const { layer } = this;
    const { samples } = await this._api.json("POST /models/{model}/profile", {
      path: { model: model.id },
      body: {
        ...line,
        layers: layer ? [layer.slug] : [],
      },
    });
    const parts = profileParts(samples, stepAt, layer?.slug ?? null);
    return {
      way,
      line,
      parts,
      course: simplifyProfile(parts, (place) => stepAt(place) / 4),
      places: parts.flat(),
    };
  }

  /** Requests the profile of the same points again, with the values of the plotted layer. */
  private async askValues(profile: MeasuredProfile): Promise<void> {
    const { layer } = this;
    const model = this._host.model();
    if (!layer || !model) return;
    try {
      const { samples } = await this._api.json("POST /models/{model}/profile", {
        path: { model: model.id },
        body: {
          ...profile.line,
          layers: [layer.slug],
        },
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
      this._host.changed();
    } catch (error) {
      notices.error(error);
    }
  }

  // ── the line to the pointer ────────────────────────────────────────────────────────────────────

  private followPointer(): void {
    const { camera } = this._host.view;
    const { tip } = this;
    const points = tip ? this.positions.map((position) => camera.projectInside(position)) : [];
    if (!tip || points.includes(null)) {
      this._soFar.follow(null);
      return;
    }
    this._seenBy = camera.message();
    this._soFar.follow({ points: points.map((at): Point => [at!.x, at!.y]), pointer: tip });
  }

  private async lookAlong(path: readonly Point[]): Promise<readonly (MarkPlace | null)[]> {
    const { samples } = await this._api.json("POST /models/{model}/profile", {
      path: { model: this._host.model()!.id },
      body: { camera: this._seenBy!, path, layers: [] },
    });
    return samples.map(({ point }) => (point.hit && point.position ? point.position : null));
  }

  private metresAlong(places: readonly (MarkPlace | null)[]): number {
    const parts = partsOfLine(places, (place) => place, this._host.view.camera.pixelSize());
    return (
      sum(parts.map((coordinates) => markLength({ coordinates }))) *
      metresPer(this._host.model()!.unit)
    );
  }
}
