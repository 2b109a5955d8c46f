// Where the others point on the surface, as this view sees it. What comes a few times a second
// glides between; whether a place is hidden behind the surface the server is asked, one place at a
// time: what would a ray through its pixel meet?

import { new_id } from "../../net/api";
import { bounding_radius, type CameraMessage, type OrbitCamera } from "../../math/camera";
import type { Picked, PresencePointer, PresenceUser } from "../../core/protocol.gen";
import { dot, length, mix, subtract, type Vec3 } from "../../math/vector";

const kGlide_ms = { least: 90, most: 400 };
const kFadesAfter_ms = 10_000;
const kAskEvery_ms = 100;
const kGiveUpAfter_ms = 2000;
const kSlack_px = 4; // the ray's end and the place may differ by so much, seen from the side

export interface PersonCursor {
  viewer: PresenceUser;
  x: number; // CSS pixels of the stage
  y: number;
  radius: number | null; // of the brush, CSS pixels; null: another tool
  hidden: boolean; // behind the surface, or cut away here
  faded: boolean; // rests for long
}

export interface PeopleCursorsHost {
  camera(): OrbitCamera;
  /** Window pixels per CSS pixel. */
  scale(): number;
  ready(): boolean;
  ask(id: string, x: number, y: number, camera: CameraMessage): void;
  wants_less_motion(): boolean;
}

interface Cursor {
  viewer: PresenceUser;
  from: Vec3;
  to: Vec3;
  moved_ms: number;
  glide_ms: number;
  radius: number | null; // world
  hidden: boolean;
  asked: boolean; // nothing changed since it was asked whether it is hidden
}

export class PeopleCursors {
  /** Set by the element that draws them. */
  on_change: () => void = () => {};

  private readonly cursors_ = new Map<string, Cursor>(); // by session
  private question_: {
    id: string;
    session: string;
    to: Vec3;
    back: Vec3;
    slack: number;
    at_ms: number;
  } | null = null;
  private ask_timer_: ReturnType<typeof setTimeout> | null = null;
  private fade_timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly host_: PeopleCursorsHost) {}

  /** Everybody but this connection. */
  receive(viewers: readonly PresenceUser[]): void {
    const pointing = viewers.filter(({ pointer }) => pointer);
    for (const session of this.cursors_.keys())
      if (!pointing.some((viewer) => viewer.session === session)) this.cursors_.delete(session);
    for (const viewer of pointing) this.put(viewer, viewer.pointer!);
    this.wait_to_fade();
    this.ask();
    this.on_change();
  }

  /** The view is another, or the surface: what was hidden may be seen. */
  look_again(): void {
    for (const cursor of this.cursors_.values()) cursor.asked = false;
    this.ask();
  }

  /** Those whose place is in the window, as they are to be drawn now. */
  now(): PersonCursor[] {
    const [camera, scale, now] = [this.host_.camera(), this.host_.scale(), performance.now()];
    return [...this.cursors_.values()].flatMap((cursor) => {
      const place = this.place(cursor, now);
      const seen = camera.project_inside(place);
      if (!seen) return [];
      const radius =
        cursor.radius === null ? null : cursor.radius / camera.unit_per_pixel(seen.depth) / scale;
      const hidden = cursor.hidden || camera.cuts_away(place);
      return [
        {
          viewer: cursor.viewer,
          x: seen.x / scale,
          y: seen.y / scale,
          radius,
          hidden,
          faded: now - cursor.moved_ms >= kFadesAfter_ms,
        },
      ];
    });
  }

  /** One of them is on its way: they are to be drawn again with the next picture. */
  get gliding(): boolean {
    const now = performance.now();
    return [...this.cursors_.values()].some(({ moved_ms, glide_ms }) => now < moved_ms + glide_ms);
  }

  /** True when it was the answer to a question of these. */
  answer({ id, hit, position }: Picked): boolean {
    const { question_: question } = this;
    if (!question || id !== question.id) return false;
    this.question_ = null;
    const cursor = this.cursors_.get(question.session);
    // A place that has moved on is asked for again.
    if (cursor && cursor.to === question.to) {
      cursor.hidden =
        hit &&
        position !== undefined &&
        dot(subtract(position, question.to), question.back) > question.slack;
      this.on_change();
    }
    this.ask();
    return true;
  }
  refused(ref: string | undefined): boolean {
    if (ref === undefined || ref !== this.question_?.id) return false;
    this.question_ = null;
    return true;
  }
  /** The connection is gone, and the answer with it. */
  reset(): void {
    this.question_ = null;
    this.cursors_.clear();
    this.on_change();
  }

  stop(): void {
    if (this.ask_timer_) clearTimeout(this.ask_timer_);
    if (this.fade_timer_) clearTimeout(this.fade_timer_);
    this.ask_timer_ = this.fade_timer_ = null;
    this.cursors_.clear();
    this.on_change = () => {};
  }

  private put(viewer: PresenceUser, { position, radius }: PresencePointer): void {
    const now = performance.now();
    const known = this.cursors_.get(viewer.session);
    if (!known) {
      const still = { from: position, to: position, moved_ms: now, glide_ms: 0 };
      this.cursors_.set(viewer.session, {
        viewer,
        ...still,
        radius: radius ?? null,
        hidden: false,
        asked: false,
      });
      return;
    }
    known.viewer = viewer;
    known.radius = radius ?? null;
    if (length(subtract(position, known.to)) === 0) return;
    known.from = this.place(known, now);
    known.to = position;
    known.glide_ms = this.host_.wants_less_motion()
      ? 0
      : Math.min(kGlide_ms.most, Math.max(kGlide_ms.least, now - known.moved_ms));
    known.moved_ms = now;
    known.asked = false;
  }

  private place({ from, to, moved_ms, glide_ms }: Cursor, now: number): Vec3 {
    return now >= moved_ms + glide_ms ? to : mix(from, to, (now - moved_ms) / glide_ms);
  }

  private wait_to_fade(): void {
    if (this.fade_timer_) clearTimeout(this.fade_timer_);
    this.fade_timer_ = null;
    const now = performance.now();
    const waits = [...this.cursors_.values()]
      .map(({ moved_ms }) => moved_ms + kFadesAfter_ms - now)
      .filter((wait) => wait > 0);
    if (waits.length === 0) return;
    this.fade_timer_ = setTimeout(
      () => {
        this.on_change();
        this.wait_to_fade();
      },
      Math.min(...waits) + 1,
    );
  }

  private ask(): void {
    if (this.ask_timer_ || !this.host_.ready()) return;
    const now = performance.now();
    // its answer asks on
    if (this.question_ && now - this.question_.at_ms < kGiveUpAfter_ms) return;
    const camera = this.host_.camera();
    for (const [session, cursor] of this.cursors_) {
      if (cursor.asked) continue;
      const seen = camera.project_inside(cursor.to);
      if (!seen) continue;
      cursor.asked = true;
      const slack = Math.max(
        kSlack_px * camera.unit_per_pixel(seen.depth),
        1e-3 * bounding_radius(camera.bounds),
      );
      this.question_ = {
        id: new_id(),
        session,
        to: cursor.to,
        back: camera.axes().back,
        slack,
        at_ms: now,
      };
      this.host_.ask(this.question_.id, seen.x, seen.y, camera.message());
      this.ask_timer_ = setTimeout(() => {
        this.ask_timer_ = null;
        this.ask();
      }, kAskEvery_ms);
      return;
    }
  }
}
