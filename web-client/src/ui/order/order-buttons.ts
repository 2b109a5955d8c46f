// The buttons that move an item of a list up or down. The focus stays on the button of the moved
// item, so the user can move it several times by keyboard.

import { html, type LitElement, type ReactiveController, type TemplateResult } from "lit";
import { texts } from "../../texts";
import { icon, type IconName } from "../icons";

const words = texts.ordered_choice;

export class OrderButtons implements ReactiveController {
  private _pressed: { id: string; glyph: IconName } | null = null;

  constructor(private readonly _host: LitElement) {
    _host.addController(this);
  }

  /** `id` is the id of the item. `move` moves the item to another index. */
  buttons(
    { id, name, index, count }: { id: string; name: string; index: number; count: number },
    move: (to: number) => void,
  ): TemplateResult {
    const button = (glyph: "up" | "down", to: number): TemplateResult =>
      html`<button
        type="button"
        class="icon quiet"
        data-order="${glyph}:${id}"
        aria-label=${words[glyph](name)}
        title=${words[glyph](name)}
        ?disabled=${to < 0 || to >= count}
        @click=${() => {
          this._pressed = { id, glyph };
          move(to);
        }}
      >
        ${icon(glyph)}
      </button>`;
    return html`${button("up", index - 1)}${button("down", index + 1)}`;
  }

  hostUpdated(): void {
    const pressed = this._pressed;
    if (!pressed) return;
    this._pressed = null;
    const find = (glyph: string): HTMLButtonElement | undefined =>
      [...this._host.renderRoot.querySelectorAll<HTMLButtonElement>("[data-order]")].find(
        (button) => button.dataset["order"] === `${glyph}:${pressed.id}` && !button.disabled,
      );
    // at an end of the list, the pressed button is disabled and cannot have the focus
    (find(pressed.glyph) ?? find(pressed.glyph === "up" ? "down" : "up"))?.focus();
  }
}
