// <strata-empty>: one line in place of an empty list. An (i) button explains the purpose of the
// list.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { icon } from "../icons";
import { sharedStyles } from "../styles";
import { texts } from "../../texts";

@customElement("strata-empty")
export class StrataEmpty extends LitElement {
  @property() line = "";
  /** The explanation. If it is empty, there is no (i) button. */
  @property() more = "";
  @state() private _open = false;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      .row {
        gap: var(--space-half);
      }
      button.icon {
        width: 1.75rem;
        min-height: var(--control-small);
        color: var(--ink-soft);
      }
      button.icon svg.glyph {
        width: 1.0625rem;
        height: 1.0625rem;
      }
    `,
  ];

  override render(): TemplateResult {
    const { line, more, _open } = this;
    return html`<div class="row">
        <p class="hint">${line}</p>
        ${
          more
            ? html`<button
              class="icon quiet"
              aria-expanded=${_open}
              aria-controls="more"
              aria-label=${texts.more_info(line)}
              title=${texts.more_info(line)}
              @click=${() => (this._open = !_open)}
            >
              ${icon("info")}
            </button>`
            : nothing
        }
      </div>
      <p id="more" class="hint" ?hidden=${!_open}>${more}</p>`;
  }
}
