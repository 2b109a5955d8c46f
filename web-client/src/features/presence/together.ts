// Looking together: who is at the model, whom this person looks with, who is asked to look with
// them, and what the others are told of all that.

import { called } from "../../domain/people";
import { followers_of, leads_back, people_here, type PersonHere } from "../../domain/people-here";
import type { Picked, PresenceUpdate, PresenceUser, ProblemMessage } from "../../core/protocol.gen";
import { notices } from "../../ui/notices";
import { PickProbe } from "../../session/pick-probe";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";

/** The pixel that this person points at, and the brush that they have in hand there. */
export type Shown = Pick<PresenceUpdate, "pointer" | "radius">;

export interface TogetherHost {
  session(): string; // this connection
  ready(): boolean;
  send(shown: Omit<PresenceUpdate, "op">): void;
  readonly view: Pick<
    ViewControl,
    "camera" | "gliding" | "look_along" | "look_alone" | "turn_around"
  >;
  /** What is seen at a pixel of the window? */
  ask(id: string, x: number, y: number): void;
  changed(): void;
}

export class Together {
  viewers: PresenceUser[] = []; // everybody here, this connection too; nobody while it is lost
  people: PersonHere[] = [];
  leading = false;
  /** The viewer that this person looks with, as last seen. */
  followed: PresenceUser | null = null;

  private told_ = ""; // `viewers` as text, without what only moves
  private shown_: Shown = { pointer: null };
  private seen_ = ""; // the camera that `look_along` was called with, as text
  private readonly invitations_ = new Map<string, number>(); // notices by session of who leads
  private readonly middle_: PickProbe;

  constructor(private readonly host_: TogetherHost) {
    this.middle_ = new PickProbe({
      ready: () => host_.ready(),
      ask: (id, { x, y }) => host_.ask(id, x, y),
      answered: (message) => this.on_middle(message),
    });
  }

  /**
   * What somebody is called who is here, or was: by their account's name where nothing else is
   * known.
   */
  name_of(user: string): string {
    const here = this.people.find((person) => person.user === user);
    return called(here ?? { user });
  }

  get followers(): PersonHere[] {
    return followers_of(this.people, this.host_.session());
  }

  /**
   * Whether this person may look with somebody: there is a window of theirs, and it does not follow
   * this one.
   */
  can_follow({ viewer }: PersonHere): boolean {
    return viewer !== null && !leads_back(this.viewers, viewer.session, this.host_.session());
  }

  follow(viewer: PresenceUser): void {
    this.withdraw(viewer.session);
    if (this.followed?.session === viewer.session) return;
    this.followed = viewer;
    this.seen_ = "";
    this.leading = false;
    this.tell();
  }

  stop_following(): void {
    if (!this.followed) return;
    this.forget_followed();
    this.tell();
  }

  lead(leading: boolean): void {
    if (leading) this.forget_followed();
    this.leading = leading;
    this.tell();
  }

  show(shown: Shown): void {
    this.shown_ = shown;
    this.send();
  }

  receive(viewers: PresenceUser[]): void {
    this.viewers = viewers;
    this.people = people_here(viewers, this.host_.session());
    this.keep_up();
    this.hear_invitations();
    // Pointers and cameras move all the time: only for them the page need not be drawn again.
    const told = JSON.stringify(viewers, (name, value: unknown) =>
      name === "pointer" || name === "camera" ? undefined : value,
    );
    if (told !== this.told_) this.host_.changed();
    this.told_ = told;
  }

  /** The connection is there, again: the server knows nothing of what was told it before. */
  connected(): void {
    this.seen_ = "";
    if (this.leading || this.followed) this.send();
  }
  disconnected(): void {
    this.viewers = this.people = [];
    this.told_ = "";
    this.middle_.reset();
  }
  /** The page is gone. */
  stop(): void {
    this.followed = null;
    this.leading = false;
    this.shown_ = { pointer: null };
    for (const notice of this.invitations_.values()) notices.dismiss(notice);
    this.middle_.stop();
  }

  /**
   * A camera says where it looks, not at what. Who goes on from here alone will turn around what
   * they see.
   */
  came_to_rest(): void {
    const { width, height } = this.host_.view.camera;
    if (this.followed) this.middle_.ask({ x: width / 2, y: height / 2 });
  }
  /** True when it was the answer to a question of this. */
  answer(message: Picked): boolean {
    return this.middle_.answer(message);
  }

  /**
   * True when the refusal is of a question of this, or about whom this person follows; then all is
   * said and done.
   */
  refused({ ref, field, status, detail }: Omit<ProblemMessage, "op">): boolean {
    if (this.middle_.refused(ref)) return true;
    if (field !== "follow") return false;
    const { followed } = this;
    this.stop_following();
    if (!followed) return true; // they were left meanwhile
    if (status === 404) notices.show("info", texts.together.left(name_of(followed)));
    else notices.show("problem", texts.together.refused(name_of(followed)), detail);
    return true;
  }

  private keep_up(): void {
    const { followed } = this;
    if (!followed) return;
    const now = this.viewers.find(({ session }) => session === followed.session);
    if (!now) {
      this.stop_following();
      notices.show("info", texts.together.left(name_of(followed)));
      return;
    }
    this.followed = now;
    const seen = now.camera && JSON.stringify(now.camera);
    if (!now.camera || !seen || seen === this.seen_) return;
    this.seen_ = seen;
    this.host_.view.look_along(now.camera);
  }

  private on_middle({ hit, position }: Picked): void {
    const { view } = this.host_;
    if (!this.followed || view.gliding || !hit || !position) return;
    const depth = view.camera.depth_of(position);
    if (depth > 0) view.turn_around(depth);
  }

  /** Who asks to look with them is told of once. */
  private hear_invitations(): void {
    const leaders = this.viewers.filter(
      ({ leading, session }) => leading && session !== this.host_.session(),
    );
    for (const session of this.invitations_.keys())
      if (!leaders.some((leader) => leader.session === session)) this.withdraw(session, true);
    for (const leader of leaders) {
      if (this.invitations_.has(leader.session)) continue;
      const words = texts.together;
      const link = { label: words.accept, act: () => this.follow(leader) };
      const known = leader.session === this.followed?.session;
      this.invitations_.set(
        leader.session,
        known ? 0 : notices.show("info", words.invites(name_of(leader)), "", link),
      );
    }
  }

  private withdraw(session: string, forget = false): void {
    notices.dismiss(this.invitations_.get(session) ?? 0);
    if (forget) this.invitations_.delete(session);
  }

  private forget_followed(): void {
    if (!this.followed) return;
    this.followed = null;
    this.host_.view.look_alone();
  }

  private tell(): void {
    this.send();
    this.host_.changed();
  }

  private send(): void {
    const { leading, followed, shown_: shown } = this;
    this.host_.send({
      ...shown,
      ...(leading ? { leading } : {}),
      ...(followed ? { follow: followed.session } : {}),
    });
  }
}

export const name_of = ({ name, full_name }: PresenceUser): string =>
  called({ user: name, full_name: full_name ?? "" });
