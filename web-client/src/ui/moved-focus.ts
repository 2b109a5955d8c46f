// Moves the focus from a button that has disappeared or cannot be pressed now to another one.

import type { ReactiveController, ReactiveControllerHost } from "lit";

export class MovedFocus implements ReactiveController {
  private _hadFocus = false;

  /** `buttons` selects the buttons among which the focus moves. */
  constructor(
    private readonly _host: ReactiveControllerHost & { readonly shadowRoot: ShadowRoot | null },
    private readonly _buttons: string,
  ) {
    _host.addController(this);
  }

  hostUpdate(): void {
    this._hadFocus = this._host.shadowRoot?.activeElement?.matches(this._buttons) ?? false;
  }

  hostUpdated(): void {
    const root = this._host.shadowRoot;
    if (!root || !this._hadFocus || root.activeElement?.matches(":enabled")) return;
    [...root.querySelectorAll<HTMLElement>(this._buttons)]
      .find((button) => button.matches(":enabled"))
      ?.focus();
  }
}
