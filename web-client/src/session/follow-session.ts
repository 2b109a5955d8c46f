// Elements that show a ModelSession are drawn again when something in it changes.

import type { ReactiveController, ReactiveControllerHost } from "lit";
import type { ModelSession } from "./model-session";

/**
 * To be called in the constructor. Follows the session that the element has, for as long as the
 * element is in the page.
 */
export function follow_session(host: ReactiveControllerHost & { session: ModelSession }): void {
  host.addController(new SessionFollower(host));
}

class SessionFollower implements ReactiveController {
  private connected_ = false;
  private followed_: ModelSession | null = null;
  private unsubscribe_: (() => void) | null = null;

  constructor(private readonly host_: ReactiveControllerHost & { session: ModelSession }) {}

  hostConnected(): void {
    this.connected_ = true;
    this.host_.requestUpdate();
  }

  hostUpdate(): void {
    const { session } = this.host_;
    // an update may still be due after the element has left
    if (!this.connected_ || session === this.followed_) return;
    this.unsubscribe_?.();
    this.followed_ = session;
    this.unsubscribe_ = session.subscribe(() => this.host_.requestUpdate());
  }

  hostDisconnected(): void {
    this.connected_ = false;
    this.unsubscribe_?.();
    this.unsubscribe_ = this.followed_ = null;
  }
}
