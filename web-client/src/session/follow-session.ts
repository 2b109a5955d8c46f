// Elements that show a ModelSession are drawn again when something in it changes.

import type { ReactiveController, ReactiveControllerHost } from "lit";
import type { ModelSession } from "./model-session";

/**
 * To be called in the constructor. Follows the session that the element has, for as long as the
 * element is in the page.
 */
export function followSession(host: ReactiveControllerHost & { session: ModelSession }): void {
  host.addController(new SessionFollower(host));
}

class SessionFollower implements ReactiveController {
  private _connected = false;
  private _followed: ModelSession | null = null;
  private _unsubscribe: (() => void) | null = null;

  constructor(private readonly _host: ReactiveControllerHost & { session: ModelSession }) {}

  hostConnected(): void {
    this._connected = true;
    this._host.requestUpdate();
  }

  hostUpdate(): void {
    const { session } = this._host;
    // an update may still be due after the element has left
    if (!this._connected || session === this._followed) return;
    this._unsubscribe?.();
    this._followed = session;
    this._unsubscribe = session.subscribe(() => this._host.requestUpdate());
  }

  hostDisconnected(): void {
    this._connected = false;
    this._unsubscribe?.();
    this._unsubscribe = this._followed = null;
  }
}
