// The comments on the open model: the loaded threads, the open thread, unsent drafts, and the read
// comments.

import { labelOf } from "../../domain/cells";
import { ApiError } from "../../net/api-error";
import { newId } from "../../core/ids";
import { type Api, ifVersion } from "../../net/api";
import type { CameraMessage } from "../../math/camera";
import type { Point } from "../../net/stroke";
import type { PointerSample } from "../../ui/input";
import {
  findThreads,
  isUnread,
  mentions,
  threadsOf,
  withThreadRead,
  type ReadMarks,
  type Thread,
  type ThreadState,
} from "../../domain/comments";
import { called } from "../../domain/people";
import type {
  Comment,
  CommentEvent,
  PresenceUser,
  ProjectPerson,
  SurfacePoint,
} from "../../core/protocol.gen";
import type { Layer, Model } from "../../core/types";
import type { Vec3 } from "../../math/vector";
import { Kept } from "../../core/kept";
import { KnownItems } from "../../net/known-items";
import { notices } from "../../ui/notices";
import { PinSight, type PinPlace } from "../../session/pin-sight";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { LayersPart, TablesPart } from "../../session/parts";

const words = texts.comments;
const kAround = 0.12; // share of the model's radius that the camera shows around a comment

/** A possible subject of a comment: a layer or a record, and its name. */
export interface Subject {
  layer: number;
  record?: number;
  label: string;
}

/** An unsent text. `key` is its idempotency key, so a repeated request has no second effect. */
export interface Draft {
  text: string;
  key: string;
  /** Only for a new thread. */
  position?: Vec3;
  normal?: Vec3;
  subjects?: Subject[];
  subject?: number; // index in `subjects`, if a subject is chosen
}

/** The key of a draft. */
export type DraftOf = "new" | `reply ${number}` | `edit ${number}`;

export interface CommentsHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly tables: TablesPart;
  model(): Model | null;
  here(): readonly PresenceUser[];
  /** Runs when a user starts a comment, and ends other uses of the pointer. */
  began(): void;
  changed(): void;
}

type Marks = Record<string, Draft>;

export class Comments {
  /** The state of the threads that the list and the pins show. */
  state: ThreadState = "open";
  /** Filters of the list: only this user's threads, and only threads that contain these words. */
  mine = false;
  words = "";
  /** The id of the open thread; "new" for the new thread. */
  card: number | "new" | null = null;
  /** The latest event, for screen readers. */
  said = "";
  readonly sight: PinSight;

  private _me = "";
  private readonly _known = new KnownItems<Comment>();
  private _threads: Thread[] = [];
  private _people: readonly ProjectPerson[] = [];
  // the pending request for the project's members
  private _asking: Promise<ProjectPerson[]> | null = null;
  private _drafts: Kept<Marks> | null = null;
  private _reads: Kept<ReadMarks> | null = null;
  private readonly _shown = new Kept(() => globalThis.localStorage, "strata.comment_pins", true);

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: CommentsHost,
  ) {
    this.sight = new PinSight({
      camera: () => _host.view.camera,
      places: () => this.pins.map(placeOf),
      lookAt: (camera, pixels) => this.lookAt(camera, pixels),
      changed: () => _host.changed(),
    });
  }

  get me(): string {
    return this._me;
  }

  // ── threads ────────────────────────────────────────────────────────────────────────────────────

  get loaded(): boolean {
    return this._known.loaded;
  }
  /** Whether the last request for the comments failed. */
  get failed(): boolean {
    return this._known.failed;
  }
  get threads(): readonly Thread[] {
    return this._threads;
  }
  find(id: number): Thread | null {
    return this._threads.find(({ first }) => first.id === id) ?? null;
  }
  get listed(): Thread[] {
    return findThreads(this._threads, {
      state: this.state,
      of: this.mine ? this._me : null,
      words: this.words,
    });
  }
  get openCount(): number {
    return this._threads.filter(({ first }) => first.state === "open").length;
  }
  /** Returns the threads in the chosen state, and the open thread. */
  get pins(): Thread[] {
    const shown = this.pinsShown
      ? findThreads(this._threads, { state: this.state, of: null, words: "" })
      : [];
    const lookedAt = typeof this.card === "number" ? this.find(this.card) : null;
    return lookedAt && !shown.includes(lookedAt) ? [...shown, lookedAt] : shown;
  }
  get pinsShown(): boolean {
    return this._shown.value;
  }
  set pinsShown(shown: boolean) {
    this._shown.value = shown;
    this.lookAgain();
  }

  /** Returns the names of all users who are present, wrote a comment, or were loaded as members. */
  get people(): ReadonlySet<string> {
    const names = new Set(this._host.here().map(({ name }) => name));
    names.add(this._me);
    for (const { user } of this._known.all) names.add(user);
    for (const { user } of this._people) names.add(user);
    return names;
  }

  /**
   * Loads the users that a comment can mention: the members of the project except this user. They
   * are loaded once for each page, and again after a failure.
   */
  async loadPeople(): Promise<readonly ProjectPerson[]> {
    const model = this._host.model();
    if (this._people.length === 0 && model) {
      this._asking ??= this._api.all("GET /projects/{project}/people", "people", {
        path: { project: model.project },
      });
      try {
        this._people = (await this._asking).filter(({ user }) => user !== this._me);
        this._host.changed();
      } catch (error) {
        if (!(error instanceof ApiError)) throw error; // comments also work without completion
      } finally {
        this._asking = null;
      }
    }
    return this._people;
  }

  /**
   * Runs when the server has identified this user. This page has not received earlier events, so it
   * loads all comments.
   */
  welcome(user: string): void {
    if (user !== this._me) {
      const name = `${user}.${this._modelId}`;
      this._me = user;
      this._drafts = new Kept<Marks>(
        () => globalThis.sessionStorage,
        `strata.comment_drafts.${name}`,
        {},
      );
      this._reads = new Kept<ReadMarks>(
        () => globalThis.localStorage,
        `strata.comments_read.${name}`,
        { upto: 0, threads: {} },
      );
    }
    void this.load();
  }

  async load(): Promise<void> {
    if (
      await this._known.load(() =>
        this._api.all("GET /models/{model}/comments", "comments", {
          path: { model: this._modelId },
        }),
      )
    )
      this.sort();
  }

  onEvent({ event, comment_id: commentId, comment, user }: CommentEvent): void {
    if (event === "deleted" || !comment) {
      this._known.drop(commentId);
      this.sort();
      return;
    }
    const isNew = this._known.find(comment.id) === null;
    this.put(comment);
    if (event !== "created" || !isNew || user === this._me) return;
    this.said = words.said(called(comment), comment.text);
    // the open thread already shows the comment to this user
    if (!mentions(comment.text, this._me) || this.card === comment.thread) return;
    const act = (): void => this.goTo(comment.id);
    notices.show("info", words.mentioned(called(comment)), comment.text.slice(0, 200), {
      label: words.show,
      act,
    });
  }

  private put(comment: Comment): void {
    if (this._known.put(comment)) this.sort();
  }

  private sort(): void {
    this._threads = threadsOf(this._known.all);
    if (typeof this.card === "number" && this.loaded && !this.find(this.card)) this.card = null;
    this.lookAgain();
  }

  // ── the open thread ────────────────────────────────────────────────────────────────────────────

  show(thread: number): void {
    this.card = thread;
    this.lookAgain();
  }
  /** Closes the card and keeps the draft. Returns false if no card was open. */
  close(): boolean {
    if (this.card === null) return false;
    if (this.card === "new" && !this.draft("new")?.text.trim()) this.setDraft("new", null);
    this.card = null;
    this.lookAgain();
    return true;
  }
  chooseState(state: ThreadState): void {
    this.state = state;
    this.lookAgain();
  }
  list(what: { mine?: boolean; words?: string }): void {
    Object.assign(this, what);
    this._host.changed();
  }

  flyTo({ first }: Thread): void {
    const { min, max } = this._host.view.camera.bounds;
    const half = (kAround * Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2])) / 2;
    const [x, y, z] = first.position;
    this._host.view.flyTo(
      { min: [x - half, y - half, z - half], max: [x + half, y + half, z + half] },
      first.normal,
    );
  }

  /** Opens the thread of a comment and moves the camera to it. */
  goTo(id: number): void {
    const comment = this._known.find(id);
    const thread = comment && this.find(comment.thread ?? comment.id);
    if (!thread) {
      notices.show("info", words.missing);
      return;
    }
    this.show(thread.first.id);
    this.flyTo(thread);
  }

  isSeen(thread: Thread): boolean {
    return this.sight.isSeen(placeOf(thread));
  }

  /** Call this when pins change, or when other objects may hide them. */
  lookAgain(): void {
    this._host.changed();
    this.sight.look().catch((error: unknown) => {
      // until the camera stops again, the pins are shown as during a movement of the camera
      if (!(error instanceof ApiError)) throw error;
    });
  }

  private async lookAt(camera: CameraMessage, pixels: Point[]): Promise<(Vec3 | null)[]> {
    const { samples } = await this._api.json("POST /models/{model}/profile", {
      path: { model: this._modelId },
      body: { camera, path: pixels, layers: [] },
    });
    return samples.map(({ point }) => (point.hit && point.position ? point.position : null));
  }

  // ── read marks ─────────────────────────────────────────────────────────────────────────────────

  isUnread(thread: Thread): boolean {
    return this._reads !== null && isUnread(thread, this._reads.value, this._me);
  }
  get unreadCount(): number {
    return this._threads.filter((thread) => this.isUnread(thread)).length;
  }
  markRead(thread: Thread): void {
    if (!this._reads || !this.isUnread(thread)) return;
    this._reads.value = withThreadRead(this._reads.value, thread);
    this._host.changed();
  }
  markAllRead(): void {
    if (!this._reads) return;
    this._reads.value = { upto: Math.max(0, ...this._known.all.map(({ id }) => id)), threads: {} };
    this._host.changed();
  }

  // ── drafts ─────────────────────────────────────────────────────────────────────────────────────

  draft(of: DraftOf): Draft | null {
    return this._drafts?.value[of] ?? null;
  }
  /** Changes the draft. Null or an empty text discards it. */
  setDraft(of: DraftOf, change: Partial<Omit<Draft, "key">> | null): void {
    if (!this._drafts) return;
    const { [of]: before, ...others } = this._drafts.value;
    // A changed text needs a new key, because the server refuses a different request with a used
    // key.
    const draft = change && { text: "", ...before, ...change, key: newId() };
    const isEmpty = !draft || (of !== "new" && draft.text === "");
    this._drafts.value = isEmpty ? others : { ...others, [of]: draft };
    this._host.changed();
  }

  /** Sets the subject of the new thread. With null, the comment is about the position. */
  chooseSubject(subject: number | null): void {
    const { subject: _, ...draft } = this.draft("new") ?? { text: "" };
    this.setDraft("new", null);
    this.setDraft("new", subject === null ? draft : { ...draft, subject });
  }

  /** Opens the unsent new thread again. */
  goOn(): void {
    this.card = "new";
    this.lookAgain();
  }

  /** Starts a new thread at the pointer. An unsent new thread moves there with its text. */
  async begin({ x, y }: PointerSample): Promise<void> {
    try {
      const found = await this._api.json("POST /models/{model}/pick", {
        path: { model: this._modelId },
        body: { camera: this._host.view.camera.message(), x, y },
      });
      if (found.hit && found.position && found.normal)
        this.beginAt(found.position, found.normal, this.subjectsAt(found));
      else notices.show("info", words.missed);
    } catch (error) {
      notices.error(error);
    }
  }

  private beginAt(position: Vec3, normal: Vec3, subjects: Subject[]): void {
    const { subject: _, ...draft } = this.draft("new") ?? { text: "" };
    this.setDraft("new", null);
    this.setDraft("new", { ...draft, position, normal, subjects });
    this.card = "new";
    this._host.began();
    this.lookAgain();
  }

  /**
   * Returns the possible subjects at a point: the layers with a value there, and the selected
   * layer, because a comment may be about a gap in it.
   */
  private subjectsAt({ values }: SurfacePoint): Subject[] {
    const { layers, tables } = this._host;
    const subjectOf = (layer: Layer): Subject[] => {
      const here = values?.[layer.slug];
      const own: Subject = { layer: layer.id, label: labelOf(layer) };
      if (!here?.valid || here.value === undefined) return layer === layers.selected ? [own] : [];
      if (layer.table === undefined || tables.lacks(layer.table, here.value)) return [own];
      const called = tables.label(layer.table, here.value) ?? texts.tables.record(here.value);
      return [
        { layer: layer.id, record: here.value, label: words.record_of(called, labelOf(layer)) },
        own,
      ];
    };
    return layers.all
      .filter((layer) => layers.visible(layer))
      .reverse()
      .flatMap(subjectOf);
  }

  async sendNew(): Promise<void> {
    const draft = this.draft("new");
    if (!draft?.position) return;
    const { text, position, key } = draft;
    const subject = draft.subject === undefined ? undefined : draft.subjects?.[draft.subject];
    const about = subject
      ? {
          layer: subject.layer,
          ...(subject.record === undefined ? {} : { record: subject.record }),
        }
      : {};
    const made = await this._api.json("POST /models/{model}/comments", {
      path: { model: this._modelId },
      body: { text, position, ...about },
      header: { "Idempotency-Key": key },
    });
    this.setDraft("new", null);
    this.put(made);
    if (this.card === "new") this.show(made.id);
  }

  async sendReply(thread: number): Promise<void> {
    const draft = this.draft(`reply ${thread}`);
    if (!draft) return;
    const made = await this._api.json("POST /comments/{comment}/replies", {
      path: { comment: thread },
      body: { text: draft.text },
      header: { "Idempotency-Key": draft.key },
    });
    this.setDraft(`reply ${thread}`, null);
    this.put(made);
  }

  /**
   * Changes the version that this page has loaded. If another user has changed the comment since,
   * throws an ApiError with status 412 and updates the comment.
   */
  async change(
    comment: Comment,
    change: { text?: string; state?: "open" | "resolved" },
  ): Promise<void> {
    await this.newestAfter(comment, async () =>
      this.put(
        await this._api.json("PATCH /comments/{comment}", {
          path: { comment: comment.id },
          body: change,
          header: ifVersion(comment.version),
        }),
      ),
    );
    if (change.text !== undefined) this.setDraft(`edit ${comment.id}`, null);
  }

  async remove(comment: Comment): Promise<void> {
    await this.newestAfter(comment, () =>
      this._api.send("DELETE /comments/{comment}", {
        path: { comment: comment.id },
        header: ifVersion(comment.version),
      }),
    );
    this.setDraft(`edit ${comment.id}`, null);
    if (comment.thread === undefined && this.find(comment.id)?.replies.length)
      this.put(await this._api.json("GET /comments/{comment}", { path: { comment: comment.id } }));
    else this.onEvent({ op: "comment", event: "deleted", comment_id: comment.id });
  }

  private async newestAfter({ id }: Comment, work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412)
        this.put(await this._api.json("GET /comments/{comment}", { path: { comment: id } }));
      throw error;
    }
  }
}

const placeOf = ({ first }: Thread): PinPlace => ({
  id: first.id,
  position: first.position,
  normal: first.normal,
});
