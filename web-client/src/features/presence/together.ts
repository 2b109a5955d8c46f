// Looking together: who is at the model, whom this person looks with, who is asked to look with
// them, and what the others are told of all that.

import { called } from "../../domain/people";
import { followersOf, leadsBack, peopleHere, type PersonHere } from "../../domain/people-here";
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
  readonly view: Pick<ViewControl, "camera" | "gliding" | "lookAlong" | "lookAlone" | "turnAround">;
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

  private _told = ""; // `viewers` as text, without what only moves
  private _shown: Shown = { pointer: null };
  private _seen = ""; // the camera that `look_along` was called with, as text
  private readonly _invitations = new Map<string, number>(); // notices by session of who leads
  private readonly _middle: PickProbe;

  constructor(private readonly _host: TogetherHost) {
    this._middle = new PickProbe({
      ready: () => _host.ready(),
      ask: (id, { x, y }) => _host.ask(id, x, y),
      answered: (message) => this.onMiddle(message),
    });
  }

  /**
   * What somebody is called who is here, or was: by their account's name where nothing else is
   * known.
   */
  nameOf(user: string): string {
    const here = this.people.find((person) => person.user === user);
    return called(here ?? { user });
  }

  get followers(): PersonHere[] {
    return followersOf(this.people, this._host.session());
  }

  /**
   * Whether this person may look with somebody: there is a window of theirs, and it does not follow
   * this one.
   */
  canFollow({ viewer }: PersonHere): boolean {
    return viewer !== null && !leadsBack(this.viewers, viewer.session, this._host.session());
  }

  follow(viewer: PresenceUser): void {
    this.withdraw(viewer.session);
    if (this.followed?.session === viewer.session) return;
    this.followed = viewer;
    this._seen = "";
    this.leading = false;
    this.tell();
  }

  stopFollowing(): void {
    if (!this.followed) return;
    this.forgetFollowed();
    this.tell();
  }

  lead(leading: boolean): void {
    if (leading) this.forgetFollowed();
    this.leading = leading;
    this.tell();
  }

  show(shown: Shown): void {
    this._shown = shown;
    this.send();
  }

  receive(viewers: PresenceUser[]): void {
    this.viewers = viewers;
    this.people = peopleHere(viewers, this._host.session());
    this.keepUp();
    this.hearInvitations();
    // Pointers and cameras move all the time: only for them the page need not be drawn again.
    const told = JSON.stringify(viewers, (name, value: unknown) =>
      name === "pointer" || name === "camera" ? undefined : value,
    );
    if (told !== this._told) this._host.changed();
    this._told = told;
  }

  /** The connection is there, again: the server knows nothing of what was told it before. */
  connected(): void {
    this._seen = "";
    if (this.leading || this.followed) this.send();
  }
  disconnected(): void {
    this.viewers = this.people = [];
    this._told = "";
    this._middle.reset();
  }
  /** The page is gone. */
  stop(): void {
    this.followed = null;
    this.leading = false;
    this._shown = { pointer: null };
    for (const notice of this._invitations.values()) notices.dismiss(notice);
    this._middle.stop();
  }

  /**
   * A camera says where it looks, not at what. Who goes on from here alone will turn around what
   * they see.
   */
  cameToRest(): void {
    const { width, height } = this._host.view.camera;
    if (this.followed) this._middle.ask({ x: width / 2, y: height / 2 });
  }
  /** True when it was the answer to a question of this. */
  answer(message: Picked): boolean {
    return this._middle.answer(message);
  }

  /**
   * True when the refusal is of a question of this, or about whom this person follows; then all is
   * said and done.
   */
  refused({ ref, field, status, detail }: Omit<ProblemMessage, "op">): boolean {
    if (this._middle.refused(ref)) return true;
    if (field !== "follow") return false;
    const { followed } = this;
    this.stopFollowing();
    if (!followed) return true; // they were left meanwhile
    if (status === 404) notices.show("info", texts.together.left(nameOf(followed)));
    else notices.show("problem", texts.together.refused(nameOf(followed)), detail);
    return true;
  }

  private keepUp(): void {
    const { followed } = this;
    if (!followed) return;
    const now = this.viewers.find(({ session }) => session === followed.session);
    if (!now) {
      this.stopFollowing();
      notices.show("info", texts.together.left(nameOf(followed)));
      return;
    }
    this.followed = now;
    const seen = now.camera && JSON.stringify(now.camera);
    if (!now.camera || !seen || seen === this._seen) return;
    this._seen = seen;
    this._host.view.lookAlong(now.camera);
  }

  private onMiddle({ hit, position }: Picked): void {
    const { view } = this._host;
    if (!this.followed || view.gliding || !hit || !position) return;
    const depth = view.camera.depthOf(position);
    if (depth > 0) view.turnAround(depth);
  }

  /** Who asks to look with them is told of once. */
  private hearInvitations(): void {
    const leaders = this.viewers.filter(
      ({ leading, session }) => leading && session !== this._host.session(),
    );
    for (const session of this._invitations.keys())
      if (!leaders.some((leader) => leader.session === session)) this.withdraw(session, true);
    for (const leader of leaders) {
      if (this._invitations.has(leader.session)) continue;
      const words = texts.together;
      const link = { label: words.accept, act: () => this.follow(leader) };
      const known = leader.session === this.followed?.session;
      this._invitations.set(
        leader.session,
        known ? 0 : notices.show("info", words.invites(nameOf(leader)), "", link),
      );
    }
  }

  private withdraw(session: string, forget = false): void {
    notices.dismiss(this._invitations.get(session) ?? 0);
    if (forget) this._invitations.delete(session);
  }

  private forgetFollowed(): void {
    if (!this.followed) return;
    this.followed = null;
    this._host.view.lookAlone();
  }

  private tell(): void {
    this.send();
    this._host.changed();
  }

  private send(): void {
    const { leading, followed, _shown: shown } = this;
    this._host.send({
      ...shown,
      ...(leading ? { leading } : {}),
      ...(followed ? { follow: followed.session } : {}),
    });
  }
}

export const nameOf = ({ name, full_name: fullName }: PresenceUser): string =>
  called({ user: name, full_name: fullName ?? "" });
