// Renders an element again after a change to the parts of the ModelSession that the element shows.

import type { ReactiveController, ReactiveControllerHost } from "lit";
import type { ModelSession, SessionPart } from "./model-session";

/**
 * Follows the element's session while the element is in the page. Call this in the element's
 * constructor. The display depends on `parts`. Without `parts`, every change causes a rendering.
 */
export function followSession(
  host: ReactiveControllerHost & { session: ModelSession },
  ...parts: SessionPart[]
): void {
  host.addController(new SessionFollower(host, parts));
}

class SessionFollower implements ReactiveController {
  private _connected = false;
  private _followed: ModelSession | null = null;
  private _unsubscribe: (() => void) | null = null;

  constructor(
    private readonly _host: ReactiveControllerHost & { session: ModelSession },
    private readonly _parts: readonly SessionPart[],
  ) {}

  hostConnected(): void {
    this._connected = true;
    this._host.requestUpdate();
  }

  hostUpdate(): void {
    const { session } = this._host;
    // An update may be pending after the element was removed.
    if (!this._connected || session === this._followed) return;
    this._unsubscribe?.();
    this._followed = session;
    this._unsubscribe = session.subscribe(() => this._host.requestUpdate(), this._parts);
  }

  hostDisconnected(): void {
    this._connected = false;
    this._unsubscribe?.();
    this._unsubscribe = this._followed = null;
  }
}
