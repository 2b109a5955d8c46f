// The comments of the open model: what is known of them, which thread is open, what is written and
// not sent yet, and what was read.

import { label_of } from "../../domain/cells";
import { ApiError, new_id, type Api } from "../../net/api";
import type { CameraMessage } from "../../math/camera";
import type { Point } from "../../net/connection";
import type { PointerSample } from "../../ui/input";
import {
  find_threads,
  is_unread,
  mentions,
  threads_of,
  with_thread_read,
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
const kAround = 0.12; // of the model's radius: what is shown around a comment's place

/** What a comment can be about, and what that is called. */
export interface Subject {
  layer: number;
  record?: number;
  label: string;
}

/** What is written and not sent. `key` tells the server when it is sent again. */
export interface Draft {
  text: string;
  key: string;
  /** Of a new thread. */
  position?: Vec3;
  normal?: Vec3;
  subjects?: Subject[];
  subject?: number; // of them; absent: none
}

/** The name of a draft. */
export type DraftOf = "new" | `reply ${number}` | `edit ${number}`;

export interface CommentsHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly tables: TablesPart;
  model(): Model | null;
  here(): readonly PresenceUser[];
  /** Somebody began to write, and wants to do nothing else with the pointer. */
  began(): void;
  changed(): void;
}

type Marks = Record<string, Draft>;

export class Comments {
  /** Which are listed and have pins. */
  state: ThreadState = "open";
  /** Only this person's; only with these words: in the list. */
  mine = false;
  words = "";
  /** A thread by its id, or the one that is being begun. */
  card: number | "new" | null = null;
  /** What happened, for those who cannot see it. */
  said = "";
  readonly sight: PinSight;

  private me_ = "";
  private readonly known_ = new KnownItems<Comment>();
  private threads_: Thread[] = [];
  private people_: readonly ProjectPerson[] = [];
  private asking_: Promise<ProjectPerson[]> | null = null; // for them
  private drafts_: Kept<Marks> | null = null;
  private reads_: Kept<ReadMarks> | null = null;
  private readonly shown_ = new Kept(() => globalThis.localStorage, "strata.comment_pins", true);

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly host_: CommentsHost,
  ) {
    this.sight = new PinSight({
      camera: () => host_.view.camera,
      places: () => this.pins.map(place_of),
      look_at: (camera, pixels) => this.look_at(camera, pixels),
      changed: () => host_.changed(),
    });
  }

  get me(): string {
    return this.me_;
  }

  // ── what there is
  // ─────────────────────────────────────────────────────────────────────────────────────────────────

  get loaded(): boolean {
    return this.known_.loaded;
  }
  /** They could not be read. */
  get failed(): boolean {
    return this.known_.failed;
  }
  get threads(): readonly Thread[] {
    return this.threads_;
  }
  find(id: number): Thread | null {
    return this.threads_.find(({ first }) => first.id === id) ?? null;
  }
  get listed(): Thread[] {
    return find_threads(this.threads_, {
      state: this.state,
      of: this.mine ? this.me_ : null,
      words: this.words,
    });
  }
  get open_count(): number {
    return this.threads_.filter(({ first }) => first.state === "open").length;
  }
  /** Those of the chosen state, and the one that is looked at. */
  get pins(): Thread[] {
    const shown = this.pins_shown
      ? find_threads(this.threads_, { state: this.state, of: null, words: "" })
      : [];
    const looked_at = typeof this.card === "number" ? this.find(this.card) : null;
    return looked_at && !shown.includes(looked_at) ? [...shown, looked_at] : shown;
  }
  get pins_shown(): boolean {
    return this.shown_.value;
  }
  set pins_shown(shown: boolean) {
    this.shown_.value = shown;
    this.look_again();
  }

  /** Those that are here, or wrote something, or were asked for. */
  get people(): ReadonlySet<string> {
    const names = new Set(this.host_.here().map(({ name }) => name));
    names.add(this.me_);
    for (const { user } of this.known_.all) names.add(user);
    for (const { user } of this.people_) names.add(user);
    return names;
  }

  /**
   * Whom one may name: the people of the project but oneself. They are asked for once a page, and
   * again where that failed.
   */
  async load_people(): Promise<readonly ProjectPerson[]> {
    const model = this.host_.model();
    if (this.people_.length === 0 && model) {
      this.asking_ ??= this.api_.project_people(model.project);
      try {
        this.people_ = (await this.asking_).filter(({ user }) => user !== this.me_);
        this.host_.changed();
      } catch (error) {
        if (!(error instanceof ApiError)) throw error; // one still writes what one likes
      } finally {
        this.asking_ = null;
      }
    }
    return this.people_;
  }

  /** The server said who this is; what happened before, nobody told this page. */
  welcome(user: string): void {
    if (user !== this.me_) {
      const name = `${user}.${this.model_id_}`;
      this.me_ = user;
      this.drafts_ = new Kept<Marks>(
        () => globalThis.sessionStorage,
        `strata.comment_drafts.${name}`,
        {},
      );
      this.reads_ = new Kept<ReadMarks>(
        () => globalThis.localStorage,
        `strata.comments_read.${name}`,
        { upto: 0, threads: {} },
      );
    }
    void this.load();
  }

  async load(): Promise<void> {
    if (await this.known_.load(() => this.api_.comments(this.model_id_))) this.sort();
  }

  on_event({ event, comment_id, comment, user }: CommentEvent): void {
    if (event === "deleted" || !comment) {
      this.known_.drop(comment_id);
      this.sort();
      return;
    }
    const is_new = this.known_.find(comment.id) === null;
    this.put(comment);
    if (event !== "created" || !is_new || user === this.me_) return;
    this.said = words.said(called(comment), comment.text);
    // who reads the thread sees it there
    if (!mentions(comment.text, this.me_) || this.card === comment.thread) return;
    const act = (): void => this.go_to(comment.id);
    notices.show("info", words.mentioned(called(comment)), comment.text.slice(0, 200), {
      label: words.show,
      act,
    });
  }

  private put(comment: Comment): void {
    if (this.known_.put(comment)) this.sort();
  }

  private sort(): void {
    this.threads_ = threads_of(this.known_.all);
    if (typeof this.card === "number" && this.loaded && !this.find(this.card)) this.card = null;
    this.look_again();
  }

  // ── what is looked at
  // ─────────────────────────────────────────────────────────────────────────────────────────────

  show(thread: number): void {
    this.card = thread;
    this.look_again();
  }
  /** False: there was none. What was written is kept. */
  close(): boolean {
    if (this.card === null) return false;
    if (this.card === "new" && !this.draft("new")?.text.trim()) this.set_draft("new", null);
    this.card = null;
    this.look_again();
    return true;
  }
  choose_state(state: ThreadState): void {
    this.state = state;
    this.look_again();
  }
  list(what: { mine?: boolean; words?: string }): void {
    Object.assign(this, what);
    this.host_.changed();
  }

  fly_to({ first }: Thread): void {
    const { min, max } = this.host_.view.camera.bounds;
    const half = (kAround * Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2])) / 2;
    const [x, y, z] = first.position;
    this.host_.view.fly_to(
      { min: [x - half, y - half, z - half], max: [x + half, y + half, z + half] },
      first.normal,
    );
  }

  /** Opens the thread of a comment and goes there. */
  go_to(id: number): void {
    const comment = this.known_.find(id);
    const thread = comment && this.find(comment.thread ?? comment.id);
    if (!thread) {
      notices.show("info", words.missing);
      return;
    }
    this.show(thread.first.id);
    this.fly_to(thread);
  }

  is_seen(thread: Thread): boolean {
    return this.sight.is_seen(place_of(thread));
  }

  /** There are other pins, or they may be behind something else. */
  look_again(): void {
    this.host_.changed();
    this.sight.look().catch((error: unknown) => {
      // until the camera rests next, they count as seen where they face it
      if (!(error instanceof ApiError)) throw error;
    });
  }

  private async look_at(camera: CameraMessage, pixels: Point[]): Promise<(Vec3 | null)[]> {
    const { samples } = await this.api_.profile(this.model_id_, camera, pixels);
    return samples.map(({ point }) => (point.hit && point.position ? point.position : null));
  }

  // ── what was read
  // ─────────────────────────────────────────────────────────────────────────────────────────────────

  is_unread(thread: Thread): boolean {
    return this.reads_ !== null && is_unread(thread, this.reads_.value, this.me_);
  }
  get unread_count(): number {
    return this.threads_.filter((thread) => this.is_unread(thread)).length;
  }
  mark_read(thread: Thread): void {
    if (!this.reads_ || !this.is_unread(thread)) return;
    this.reads_.value = with_thread_read(this.reads_.value, thread);
    this.host_.changed();
  }
  mark_all_read(): void {
    if (!this.reads_) return;
    this.reads_.value = { upto: Math.max(0, ...this.known_.all.map(({ id }) => id)), threads: {} };
    this.host_.changed();
  }

  // ── what is written
  // ───────────────────────────────────────────────────────────────────────────────────────────────

  draft(of: DraftOf): Draft | null {
    return this.drafts_?.value[of] ?? null;
  }
  /** What is written there now; null or nothing: it is given up. */
  set_draft(of: DraftOf, change: Partial<Omit<Draft, "key">> | null): void {
    if (!this.drafts_) return;
    const { [of]: before, ...others } = this.drafts_.value;
    // Another text is another call: with the key of one that was sent it would be refused.
    const draft = change && { text: "", ...before, ...change, key: new_id() };
    const is_empty = !draft || (of !== "new" && draft.text === "");
    this.drafts_.value = is_empty ? others : { ...others, [of]: draft };
    this.host_.changed();
  }

  /** What the new thread is about; null: the place itself. */
  choose_subject(subject: number | null): void {
    const { subject: _, ...draft } = this.draft("new") ?? { text: "" };
    this.set_draft("new", null);
    this.set_draft("new", subject === null ? draft : { ...draft, subject });
  }

  /** With the new thread that was written and not sent. */
  go_on(): void {
    this.card = "new";
    this.look_again();
  }

  /**
   * A new thread begins where somebody points to. What was written elsewhere and not sent moves
   * there.
   */
  async begin({ x, y }: PointerSample): Promise<void> {
    try {
      const found = await this.api_.pick(this.model_id_, this.host_.view.camera.message(), [x, y]);
      if (found.hit && found.position && found.normal)
        this.begin_at(found.position, found.normal, this.subjects_at(found));
      else notices.show("info", words.missed);
    } catch (error) {
      notices.error(error);
    }
  }

  private begin_at(position: Vec3, normal: Vec3, subjects: Subject[]): void {
    const { subject: _, ...draft } = this.draft("new") ?? { text: "" };
    this.set_draft("new", null);
    this.set_draft("new", { ...draft, position, normal, subjects });
    this.card = "new";
    this.host_.began();
    this.look_again();
  }

  /** What is painted there, and what is painted on: a gap in it may be what a comment is about. */
  private subjects_at({ values }: SurfacePoint): Subject[] {
    const { layers, tables } = this.host_;
    const subject_of = (layer: Layer): Subject[] => {
      const here = values?.[layer.slug];
      const own: Subject = { layer: layer.id, label: label_of(layer) };
      if (!here?.valid || here.value === undefined) return layer === layers.selected ? [own] : [];
      if (layer.table === undefined || tables.lacks(layer.table, here.value)) return [own];
      const called = tables.label(layer.table, here.value) ?? texts.tables.record(here.value);
      return [
        { layer: layer.id, record: here.value, label: words.record_of(called, label_of(layer)) },
        own,
      ];
    };
    return layers.all
      .filter((layer) => layers.visible(layer))
      .reverse()
      .flatMap(subject_of);
  }

  async send_new(): Promise<void> {
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
    const made = await this.api_.create_comment(
      this.model_id_,
      { text, position: position as [number, number, number], ...about },
      key,
    );
    this.set_draft("new", null);
    this.put(made);
    if (this.card === "new") this.show(made.id);
  }

  async send_reply(thread: number): Promise<void> {
    const draft = this.draft(`reply ${thread}`);
    if (!draft) return;
    const made = await this.api_.create_reply(thread, draft.text, draft.key);
    this.set_draft(`reply ${thread}`, null);
    this.put(made);
  }

  /**
   * Of what was read: another's change in between is an ApiError of status 412, and the comment is
   * then as it is now.
   */
  async change(
    comment: Comment,
    change: { text?: string; state?: "open" | "resolved" },
  ): Promise<void> {
    await this.newest_after(comment, async () =>
      this.put(await this.api_.change_comment(comment.id, change, comment.version)),
    );
    if (change.text !== undefined) this.set_draft(`edit ${comment.id}`, null);
  }

  async remove(comment: Comment): Promise<void> {
    await this.newest_after(comment, () => this.api_.delete_comment(comment.id, comment.version));
    this.set_draft(`edit ${comment.id}`, null);
    if (comment.thread === undefined && this.find(comment.id)?.replies.length)
      this.put(await this.api_.comment(comment.id));
    else this.on_event({ op: "comment", event: "deleted", comment_id: comment.id });
  }

  private async newest_after({ id }: Comment, work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) this.put(await this.api_.comment(id));
      throw error;
    }
  }
}

const place_of = ({ first }: Thread): PinPlace => ({
  id: first.id,
  position: first.position,
  normal: first.normal,
});
