// <strata-made-link>: shows a new link or secret once, so the user can copy it. Slotted content is
// below it. The button with the text `done` fires "done".

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import "./copy-field";
import { sharedStyles } from "./styles";

@customElement("strata-made-link")
export class StrataMadeLink extends LitElement {
  @property() heading = "";
  @property() lead = "";
  @property() text = "";
  @property() done = "";

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      div[role] {
        display: grid;
        gap: var(--space-3);
        padding: var(--space-3);
        border-radius: var(--radius);
        background: var(--calm-soft);
        overflow-wrap: anywhere;
      }
      button {
        justify-self: start;
      }
    `,
  ];

  override render(): TemplateResult {
    return html`<div role="status">
      <div>
        <b>${this.heading}</b>
        ${this.lead ? html`<p>${this.lead}</p>` : nothing}
      </div>
      <strata-copy-field follows_form label=${this.heading} .text=${this.text}></strata-copy-field>
      <slot></slot>
      ${this.done ? html`<button @click=${() => this.dispatchEvent(new CustomEvent("done"))}>${this.done}</button>` : nothing}
    </div>`;
  }
}
