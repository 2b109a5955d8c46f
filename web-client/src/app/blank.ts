// <strata-blank>: a whole page that only says something: not found, not reachable.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { logo } from "./icons";
import { shared_styles } from "./styles";

@customElement("strata-blank")
export class StrataBlank extends LitElement {
  @property() heading = "";
  @property() lead = "";

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        place-items: center;
        min-height: 100dvh;
        padding: 24px;
        text-align: center;
      }
      div {
        display: grid;
        justify-items: center;
        gap: 14px;
        max-width: 440px;
      }
      .logo {
        width: 52px;
        height: 52px;
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
