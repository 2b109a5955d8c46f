// The past of the open model: the displayed state, the timeline, playback, and the comparison of a
// past state with the newest one.

import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import type { Difference, Timeline, TimelineInterval, TimelineStep } from "../../core/protocol.gen";
import type { FrameMessage } from "../../net/frame-header";
import type { Point } from "../../net/stroke";
import type { CameraMessage } from "../../math/camera";
import { notices } from "../../ui/notices";
import {
  intervalOf,
  joinSteps,
  lastWhere,
  nextInterval,
  placeOfTime,
  stepOf,
  zoomed,
} from "../../domain/timeline";
import { texts } from "../../texts";

const kIntervals = 240;
const kStepsAtOnce = 60;
const kStepsKept = 600;
const kPlayMs = 700; // time for each interval, at normal speed
const kSettleMs = 250; // delay until the steps around a dragged state are loaded
export const kSpeeds = [0.5, 1, 2, 4] as const;

export interface PastHost {
  /** Shows the state after this edit, or the newest one for null. `beside` uses a second view. */
  show(at: number | null, beside: boolean): void;
  /** Runs the action immediately, or after the current stroke. */
  whenFree(action: () => void): void;
  /** Returns the number of unsaved changes. */
  unsaved(): number;
  camera(): CameraMessage;
  /** Deactivates the tools that make changes. */
  stopPainting(): void;
  /** Activates the tool that draws the part to restore; `endPart` deactivates it. */
  beginPart(): void;
  endPart(): void;
  changed(): void;
}

/** A part of a layer to restore: the inside of an outline in a window. */
export interface PastPart {
  camera: CameraMessage;
  path: Point[];
}

export class Past {
  isOpen = false;
  /** The requested state; null for the newest. */
  at: number | null = null;
  /** The state of the last frame; null before the first frame of a past state. */
  drawn: number | null = null;
  timeline: Timeline | null = null;
  failed = false;
  playing = false;
  speed: (typeof kSpeeds)[number] = 1;
  /**
   * Whether the past and the newest state are side by side. `divider` is the past state's share of
   * the width.
   */
  compares = false;
  divider = 0.5;
  /**
   * The state whose differences from the newest one are highlighted on the surface; null for none.
   */
  changesFrom: number | null = null;
  /** The number of changes to the snapshots. */
  snapshotChanges = 0;
  /** The part to restore; null for the whole layer. */
  part: PastPart | null = null;
  drawsPart = false;
  /** The callback of the element that shows the past state next to the newest one. */
  onFrame: (part: FrameMessage) => void = () => {};

  private _whole: Timeline | null = null; // the timeline without zoom
  private _steps: TimelineStep[] = [];
  private _beginKnown = false; // whether the loaded steps include the first one
  private _asked = 0;
  private _playTimer: ReturnType<typeof setTimeout> | null = null;
  private _settleTimer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: PastHost,
  ) {}

  /** Whether the 3D view shows a past state, alone or next to the newest one. */
  get isActive(): boolean {
    return this.at !== null;
  }
  get isZoomed(): boolean {
    return this._whole !== null && this.timeline !== this._whole;
  }
  /** The newest known edit of the model. */
  get newest(): number {
    return this.timeline?.newest ?? 0;
  }
  get step(): TimelineStep | null {
    return this.at === null ? null : stepOf(this._steps, this.at);
  }
  get interval(): TimelineInterval | null {
    return this.timeline && this.at !== null ? intervalOf(this.timeline, this.at) : null;
  }
  /** The time of the requested state; null before the first edit and for the newest state. */
  get time(): string | null {
    if (this.at === null) return null;
    const { step, interval } = this;
    if (step && (!interval || step.last >= interval.first)) return step.time;
    return interval ? interval.ended : null;
  }
  /** The position of the handle, from 0 to 1. */
  get place(): number {
    if (this.at === null || !this.timeline) return 1;
    const { time } = this;
    return time === null ? 0 : placeOfTime(this.timeline, time);
  }

  // ── opening ────────────────────────────────────────────────────────────────────────────────────

  onSnapshot(): void {
    ++this.snapshotChanges;
    this._host.changed();
  }

  toggle(): void {
    if (this.isOpen) this.close();
    else void this.open();
  }

  /** Opens the timeline. With `time`, shows the state at that time. */
  async open(time?: string): Promise<void> {
    this.isOpen = true;
    this._host.changed();
    await this.load();
    if (time !== undefined) await this.goToTime(time);
  }

  /** Opens the timeline with a past state next to the newest one. */
  async compareWith(sequence: number): Promise<void> {
    await this.open();
    this.compares = true;
    this.goTo(sequence);
  }

  /** Opens the timeline, and highlights the changes since a state. */
  async showChangesSince(sequence: number): Promise<void> {
    this.changesFrom = sequence;
    await this.open();
  }
  setShowsChanges(shows: boolean): void {
    this.changesFrom = shows ? this.at : null;
    this._host.changed();
  }

  close(): void {
    this.stop();
    this.goNow();
    this.changesFrom = null;
    this.isOpen = this.compares = false;
    this.timeline = this._whole = null;
    this._steps = [];
    this._host.changed();
  }

  /** Call this on each new connection. The server has not received any request of this page yet. */
  welcome(): void {
    this.drawn = null;
    this._host.changed();
  }

  /** Loads the timeline again after edits by other users, because the timeline is longer now. */
  outdated(): void {
    if (this.isOpen && !this.isActive && !this.isZoomed) void this.load();
  }

  async load(span: { from: string; to: string } | null = null): Promise<void> {
    const question = ++this._asked;
    try {
      const timeline = await this._api.json("GET /models/{model}/timeline", {
        path: { model: this._modelId },
        query: { intervals: kIntervals, ...(span ?? {}) },
      });
      if (question !== this._asked || !this.isOpen) return;
      this.timeline = timeline;
      if (!span) this._whole = timeline;
      this.failed = false;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (question !== this._asked) return;
      this.failed = true;
    }
    this._host.changed();
  }

  /** Shows a shorter or longer period around the requested state. */
  async zoom(factor: number): Promise<void> {
    const { timeline, _whole: whole } = this;
    if (!timeline || !whole) return;
    const span = zoomed(whole, timeline, this.time ?? timeline.to ?? "", factor);
    if (span) await this.load(span);
    else {
      this.timeline = whole;
      this._host.changed();
    }
  }

  // ── moving ─────────────────────────────────────────────────────────────────────────────────────

  goNow(): void {
    this.show(null);
  }

  /** Shows the state after the edit with this sequence. */
  goTo(sequence: number): void {
    if (this.at === null && this._host.unsaved() > 0) {
      notices.show("info", texts.past.saving_first);
      return;
    }
    this._host.whenFree(() => this.show(sequence));
    this.settle();
  }

  goToInterval(interval: TimelineInterval | null): void {
    this.goTo(interval ? interval.last : 0);
  }

  async goToTime(iso: string): Promise<void> {
    try {
      const { intervals } = await this._api.json("GET /models/{model}/timeline", {
        path: { model: this._modelId },
        query: { intervals: 1, to: iso },
      });
      this.goToInterval(intervals[0] ?? null);
    } catch (error) {
      notices.error(error);
    }
  }

  /** Moves to the next edit or, with `far`, to the next interval with edits. */
  async goBy(forward: boolean, far = false): Promise<void> {
    const from = this.at ?? this.newest;
    if (far && this.timeline) {
      const next = nextInterval(this.timeline, from, forward);
      if (forward && (!next || next.last >= this.newest)) this.goNow();
      else this.goToInterval(next);
      return;
    }
    if (forward && this.at === null) return;
    const next = await this.nextStep(from, forward);
    if (next !== undefined) {
      if (forward && (next === null || next >= this.newest)) this.goNow();
      else this.goTo(next ?? 0);
    }
  }

  /** Returns null if no step exists in this direction, and undefined if it is unknown. */
  private async nextStep(from: number, forward: boolean): Promise<number | null | undefined> {
    const find = (): TimelineStep | null =>
      forward
        ? (this._steps.find(({ last }) => last > from) ?? null)
        : lastWhere(this._steps, ({ last }) => last < from);
    // the neighbor is known only if the state is inside the loaded steps
    const isInside =
      (this._steps[0]?.last ?? Infinity) <= from && (this._steps.at(-1)?.last ?? -1) >= from;
    let next = isInside ? find() : null;
    if (next || (isInside && !forward && this._beginKnown)) return next?.last ?? null;
    if (!(await this.readSteps(from))) return undefined;
    next = find();
    return next?.last ?? null;
  }

  private async readSteps(around: number): Promise<boolean> {
    const path = { model: this._modelId };
    const query = { limit: kStepsAtOnce };
    try {
      const [before, after] = await Promise.all([
        this._api.json("GET /models/{model}/timeline/steps", {
          path,
          query: { ...query, before: around },
        }),
        this._api.json("GET /models/{model}/timeline/steps", {
          path,
          query: { ...query, after: around },
        }),
      ]);
      // Keeps one run of steps without a gap, and discards other steps.
      this._steps = joinSteps(before.steps, after.steps).slice(-kStepsKept);
      this._beginKnown = !before.more;
      this._host.changed();
      return true;
    } catch (error) {
      notices.error(error);
      return false;
    }
  }

  /** Loads the author of the state after the handle has stopped. */
  private settle(): void {
    if (this._settleTimer) clearTimeout(this._settleTimer);
    this._settleTimer = setTimeout(() => {
      this._settleTimer = null;
      const { at } = this;
      if (at === null || at === 0 || this._steps.some(({ last }) => last === at)) return;
      void this.readSteps(at);
    }, kSettleMs);
  }

  private show(at: number | null): void {
    if (at !== null && this.at === null) this._host.stopPainting();
    if (at === null) this.setPart(null);
    this.at = at;
    if (at === null) this.drawn = null;
    else if (this.changesFrom !== null) this.changesFrom = at;
    this._host.show(at, this.compares);
    this._host.changed();
  }

  // ── playing ────────────────────────────────────────────────────────────────────────────────────

  togglePlay(): void {
    if (this.playing) this.stop();
    else this.play();
  }

  private play(): void {
    if (!this.timeline || this.timeline.intervals.length === 0) return;
    this.playing = true;
    if (this.at === null) this.goTo(0);
    if (this.at === null) {
      this.playing = false; // after a refusal
      return;
    }
    this.playOn();
    this._host.changed();
  }

  /** Shows the next state after a pause, but not before the frame of the current state. */
  private playOn(): void {
    this._playTimer = setTimeout(() => {
      if (!this.playing) return;
      if (this.drawn === this.at) void this.playNext();
      else this.playOn();
    }, kPlayMs / this.speed);
  }

  private playNext(): void {
    const next = this.timeline && nextInterval(this.timeline, this.at ?? this.newest, true);
    if (!next || next.last >= this.newest) {
      this.stop();
      this.goNow();
      return;
    }
    this.goToInterval(next);
    this.playOn();
  }

  stop(): void {
    if (this._playTimer) clearTimeout(this._playTimer);
    this._playTimer = null;
    if (!this.playing) return;
    this.playing = false;
    this._host.changed();
  }

  setSpeed(speed: (typeof kSpeeds)[number]): void {
    this.speed = speed;
    this._host.changed();
  }

  // ── frames ─────────────────────────────────────────────────────────────────────────────────────

  /** Call this after a frame of the view of the past was displayed. */
  frameDrawn({ header }: FrameMessage): void {
    if (!this.isActive || header.scene_sequence === this.drawn) return;
    // Until the server has loaded the past state, it sends frames of the newest state.
    if (this.drawn === null && header.scene_sequence !== this.at) return;
    this.drawn = header.scene_sequence;
    this._host.changed();
  }

  setCompares(compares: boolean): void {
    if (compares === this.compares) return;
    this.compares = compares;
    this.drawn = null;
    this._host.show(this.at, compares);
    this._host.changed();
  }

  setDivider(share: number): void {
    this.divider = Math.min(0.98, Math.max(0.02, share));
    this._host.changed();
  }

  // ── restoring ──────────────────────────────────────────────────────────────────────────────────

  /**
   * Lets the user draw the part. Until the user has drawn it, the restore applies to the whole
   * layer.
   */
  drawPart(): void {
    this.part = null;
    this.drawsPart = true;
    this._host.beginPart();
    this._host.changed();
  }
  setPart(path: Point[] | null): void {
    if (path === null && !this.part && !this.drawsPart) return;
    this.part = path ? { camera: this._host.camera(), path } : null;
    if (this.drawsPart) {
      this.drawsPart = false;
      this._host.endPart();
    }
    this._host.changed();
  }

  /**
   * Returns the texels and the area that the restore would change. If the request fails, shows the
   * reason to the user and returns null.
   */
  async count(layer: number): Promise<Difference | null> {
    if (this.at === null) return null;
    try {
      return await this._api.json("POST /models/{model}/layers/{layer}/difference", {
        path: { model: this._modelId, layer },
        body: { from: this.at, ...(this.part ? { within: this.part } : {}) },
      });
    } catch (error) {
      notices.error(error);
      return null;
    }
  }

  /**
   * Restores the layer and shows the newest state. Returns null after a refusal, which a notice
   * reports.
   */
  async restore(layer: number): Promise<{ texels_changed: number; area_m2: number } | null> {
    if (this.at === null) return null;
    try {
      const done = await this._api.json("POST /models/{model}/layers/{layer}/restore", {
        path: { model: this._modelId, layer },
        body: { sequence: this.at, ...(this.part ? { within: this.part } : {}) },
      });
      this.goNow();
      return done;
    } catch (error) {
      notices.error(error);
      return null;
    }
  }
}
