// <strata-blank>: a whole page with only a message, for example if a model is not found or the
// server is unreachable.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { logo } from "./icons";
import { sharedStyles } from "./styles";

@customElement("strata-blank")
export class StrataStatusPage extends LitElement {
  @property() heading = "";
  @property() lead = "";

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        place-items: center;
        min-height: 100dvh;
        padding: var(--space-6);
        text-align: center;
      }
      div {
        display: grid;
        justify-items: center;
        gap: var(--space-3);
        max-width: 27.5rem;
      }
      .logo {
        width: 3.25rem;
        height: 3.25rem;
      }
      h1 {
        font-size: var(--text-title-2);
      }
      p {
        color: var(--ink-soft);
      }
    `,
  ];

  override render(): TemplateResult {
    return html`<div>
      ${logo()}
      <h1>${this.heading}</h1>
      <p>${this.lead}</p>
      <slot></slot>
    </div>`;
  }
}
