// <strata-blank>: a whole page with only a message: not found, unreachable.

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
        padding: 1.5rem;
        text-align: center;
      }
      div {
        display: grid;
        justify-items: center;
        gap: 0.875rem;
        max-width: 27.5rem;
      }
      .logo {
        width: 3.25rem;
        height: 3.25rem;
      }
      h1 {
        font-size: 1.45rem;
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
