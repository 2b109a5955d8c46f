// Following other participants: the participants at the model, the followed camera, invitations,
// and the presence messages of this connection.

import { called } from "../../domain/people";
import { followersOf, leadsBack, peopleHere, type PersonHere } from "../../domain/people-here";
import type { Picked, PresenceUpdate, PresenceUser, ProblemMessage } from "../../core/protocol.gen";
import { notices } from "../../ui/notices";
import { PickProbe } from "../../session/pick-probe";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";

/** The pixel under this user's pointer, and the radius of the brush there. */
export type Shown = Pick<PresenceUpdate, "pointer" | "radius">;

export interface TogetherHost {
  session(): string; // the id of this connection's session
  ready(): boolean;
  send(shown: Omit<PresenceUpdate, "op">): void;
  readonly view: Pick<ViewControl, "camera" | "gliding" | "lookAlong" | "lookAlone" | "turnAround">;
  /** Requests the surface position at a pixel of the window. */
  ask(id: string, x: number, y: number): void;
  changed(): void;
}

export class Together {
  viewers: PresenceUser[] = []; // includes this connection; empty while disconnected
  people: PersonHere[] = [];
  leading = false;
  /** The followed participant, in the latest state. */
  followed: PresenceUser | null = null;

  // The server has reported that this connection follows `followed`.
  private _followsNow = false;
  private _told = ""; // `viewers` as text, without their pointers and cameras
  private _shown: Shown = { pointer: null };
  private _seen = ""; // the camera of the last `look_along` message, as text
  // ids of notices, by the leader's session
  private readonly _invitations = new Map<string, number>();
  private readonly _middle: PickProbe;

  constructor(private readonly _host: TogetherHost) {
    this._middle = new PickProbe({
      ready: () => _host.ready(),
      ask: (id, { x, y }) => _host.ask(id, x, y),
      answered: (message) => this.onMiddle(message),
    });
  }

  /** Returns the name of a present or former participant. The default is the user name. */
  nameOf(user: string): string {
    const here = this.people.find((person) => person.user === user);
    return called(here ?? { user });
  }

  get followers(): PersonHere[] {
    return followersOf(this.people, this._host.session());
  }

  /**
   * Returns whether this user can follow the participant. The participant's window must not follow
   * this one.
   */
  canFollow({ viewer }: PersonHere): boolean {
    return viewer !== null && !leadsBack(this.viewers, viewer.session, this._host.session());
  }

  follow(viewer: PresenceUser): void {
    this.withdraw(viewer.session);
    if (this.followed?.session === viewer.session) return;
    this.followed = viewer;
    this._followsNow = false;
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
    // pointers and cameras change all the time, so such changes alone do not redraw the page
    const told = JSON.stringify(viewers, (name, value: unknown) =>
      name === "pointer" || name === "camera" ? undefined : value,
    );
    if (told !== this._told) this._host.changed();
    this._told = told;
  }

  /** Call this after a connection or reconnection. The server has no state of this page yet. */
  connected(): void {
    this._followsNow = false;
    this._seen = "";
    if (this.leading || this.followed) this.send();
  }
  disconnected(): void {
    this.viewers = this.people = [];
    this._told = "";
    this._middle.reset();
  }
  /** Call this when the page closes. */
  stop(): void {
    this.followed = null;
    this.leading = false;
    this._shown = { pointer: null };
    for (const notice of this._invitations.values()) notices.dismiss(notice);
    this._middle.stop();
  }

  /**
   * A camera has a direction but no target. This requests the position in the middle, so the user
   * can rotate the camera around it after following.
   */
  cameToRest(): void {
    const { width, height } = this._host.view.camera;
    if (this.followed) this._middle.ask({ x: width / 2, y: height / 2 });
  }
  /** Returns true if the message is the response to one of these requests. */
  answer(message: Picked): boolean {
    return this._middle.answer(message);
  }

  /**
   * Handles the problem if the server refused a request of this class, or a request to follow a
   * participant. Returns whether it handled the problem.
   */
  refused({ ref, field, status, detail }: Omit<ProblemMessage, "op">): boolean {
    if (this._middle.refused(ref)) return true;
    if (field !== "follow") return false;
    const { followed } = this;
    this.stopFollowing();
    if (!followed) return true; // this user had already stopped following
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
    // People at two nodes began to follow each other, so the server ended it.
    const own = this.viewers.find(({ session }) => session === this._host.session());
    const followsNow = own?.following === followed.session;
    if (this._followsNow && !followsNow) {
      this.stopFollowing();
      notices.show("info", texts.together.ended(nameOf(followed)));
      return;
    }
    this._followsNow = followsNow;
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

  /** Shows a notice for each invitation. */
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
