// The pointers of other participants on the surface, in this view. Positions arrive a few times a
// second, and the page animates between them. To find whether the surface hides a position, the
// page requests the surface point at the pixel of the position from the server. It sends one such
// request at a time.

import { newId } from "../../core/ids";
import { boundingRadius, type CameraMessage, type OrbitCamera } from "../../math/camera";
import type { Picked, PresencePointer, PresenceUser } from "../../core/protocol.gen";
import { dot, length, mix, subtract, type Vec3 } from "../../math/vector";

const kGlideMs = { least: 90, most: 400 };
const kFadesAfterMs = 10_000;
const kAskEveryMs = 100;
const kGiveUpAfterMs = 2000;
const kSlackPx = 4; // tolerated distance between the ray's hit and the position, in side view

export interface PersonCursor {
  viewer: PresenceUser;
  x: number; // in CSS pixels of the stage
  y: number;
  radius: number | null; // radius of the brush in CSS pixels; null for other tools
  hidden: boolean; // whether the position is behind the surface, or cut away in this view
  faded: boolean; // whether the pointer has rested for a long time
}

export interface PeopleCursorsHost {
  camera(): OrbitCamera;
  /** Returns the number of window pixels per CSS pixel. */
  scale(): number;
  ready(): boolean;
  ask(id: string, x: number, y: number, camera: CameraMessage): void;
  wantsLessMotion(): boolean;
}

interface Cursor {
  viewer: PresenceUser;
  from: Vec3;
  to: Vec3;
  movedMs: number;
  glideMs: number;
  radius: number | null; // in world units
  hidden: boolean;
  asked: boolean; // whether the position was requested after its last change
}

export class PeopleCursors {
  /** The callback of the element that draws the pointers. */
  onChange: () => void = () => {};

  private readonly _cursors = new Map<string, Cursor>(); // keyed by session
  private _question: {
    id: string;
    session: string;
    to: Vec3;
    back: Vec3;
    slack: number;
    atMs: number;
  } | null = null;
  private _askTimer: ReturnType<typeof setTimeout> | null = null;
  private _fadeTimer: ReturnType<typeof setTimeout> | null = null;

  constructor(private readonly _host: PeopleCursorsHost) {}

  /** Takes the state of all participants except this connection. */
  receive(viewers: readonly PresenceUser[]): void {
    const pointing = viewers.filter(({ pointer }) => pointer);
    for (const session of this._cursors.keys())
      if (!pointing.some((viewer) => viewer.session === session)) this._cursors.delete(session);
    for (const viewer of pointing) this.put(viewer, viewer.pointer!);
    this.waitToFade();
    this.ask();
    this.onChange();
  }

  /**
   * Call this when the view or the surface has changed, because hidden positions may become
   * visible.
   */
  lookAgain(): void {
    for (const cursor of this._cursors.values()) cursor.asked = false;
    this.ask();
  }

  /** Returns the pointers in the window at the current time. */
  now(): PersonCursor[] {
    const [camera, scale, now] = [this._host.camera(), this._host.scale(), performance.now()];
    return [...this._cursors.values()].flatMap((cursor) => {
      const place = this.place(cursor, now);
      const seen = camera.projectInside(place);
      if (!seen) return [];
      const radius =
        cursor.radius === null ? null : cursor.radius / camera.unitPerPixel(seen.depth) / scale;
      const hidden = cursor.hidden || camera.cutsAway(place);
      return [
        {
          viewer: cursor.viewer,
          x: seen.x / scale,
          y: seen.y / scale,
          radius,
          hidden,
          faded: now - cursor.movedMs >= kFadesAfterMs,
        },
      ];
    });
  }

  /** Whether a pointer is moving, so the next animation frame must draw the pointers again. */
  get gliding(): boolean {
    const now = performance.now();
    return [...this._cursors.values()].some(({ movedMs, glideMs }) => now < movedMs + glideMs);
  }

  /** Returns true if the message is the response to one of these requests. */
  answer({ id, hit, position }: Picked): boolean {
    const { _question: question } = this;
    if (!question || id !== question.id) return false;
    this._question = null;
    const cursor = this._cursors.get(question.session);
    // a position that has changed is requested again
    if (cursor && cursor.to === question.to) {
      cursor.hidden =
        hit &&
        position !== undefined &&
        dot(subtract(position, question.to), question.back) > question.slack;
      this.onChange();
    }
    this.ask();
    return true;
  }
  refused(ref: string | undefined): boolean {
    if (ref === undefined || ref !== this._question?.id) return false;
    this._question = null;
    return true;
  }
  /** The connection was lost, so the response will not arrive. */
  reset(): void {
    this._question = null;
    this._cursors.clear();
    this.onChange();
  }

  stop(): void {
    if (this._askTimer) clearTimeout(this._askTimer);
    if (this._fadeTimer) clearTimeout(this._fadeTimer);
    this._askTimer = this._fadeTimer = null;
    this._cursors.clear();
    this.onChange = () => {};
  }

  private put(viewer: PresenceUser, { position, radius }: PresencePointer): void {
    const now = performance.now();
    const known = this._cursors.get(viewer.session);
    if (!known) {
      const still = { from: position, to: position, movedMs: now, glideMs: 0 };
      this._cursors.set(viewer.session, {
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
    known.glideMs = this._host.wantsLessMotion()
      ? 0
      : Math.min(kGlideMs.most, Math.max(kGlideMs.least, now - known.movedMs));
    known.movedMs = now;
    known.asked = false;
  }

  private place({ from, to, movedMs, glideMs }: Cursor, now: number): Vec3 {
    return now >= movedMs + glideMs ? to : mix(from, to, (now - movedMs) / glideMs);
  }

  private waitToFade(): void {
    if (this._fadeTimer) clearTimeout(this._fadeTimer);
    this._fadeTimer = null;
    const now = performance.now();
    const waits = [...this._cursors.values()]
      .map(({ movedMs }) => movedMs + kFadesAfterMs - now)
      .filter((wait) => wait > 0);
    if (waits.length === 0) return;
    this._fadeTimer = setTimeout(
      () => {
        this.onChange();
        this.waitToFade();
      },
      Math.min(...waits) + 1,
    );
  }

  private ask(): void {
    if (this._askTimer || !this._host.ready()) return;
    const now = performance.now();
    // the response to the pending request triggers the next one
    if (this._question && now - this._question.atMs < kGiveUpAfterMs) return;
    const camera = this._host.camera();
    for (const [session, cursor] of this._cursors) {
      if (cursor.asked) continue;
      const seen = camera.projectInside(cursor.to);
      if (!seen) continue;
      cursor.asked = true;
      const slack = Math.max(
        kSlackPx * camera.unitPerPixel(seen.depth),
        1e-3 * boundingRadius(camera.bounds),
      );
      this._question = {
        id: newId(),
        session,
        to: cursor.to,
        back: camera.axes().back,
        slack,
        atMs: now,
      };
      this._host.ask(this._question.id, seen.x, seen.y, camera.message());
      this._askTimer = setTimeout(() => {
        this._askTimer = null;
        this.ask();
      }, kAskEveryMs);
      return;
    }
  }
}
