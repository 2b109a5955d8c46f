// <strata-face-hint>: instructions over the model while the user picks a face and the dialog is
// hidden.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.figures;

@customElement("strata-face-hint")
export class StrataFaceHint extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @query("button") private _first!: HTMLButtonElement;

  static override styles = [
    sharedStyles,
    css`
      section {
        position: fixed;
        z-index: 30;
        left: 50%;
        /* below the header, because notices and, on phones, the panel are at the bottom */
        top: 66px;
        transform: translateX(-50%);
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-2) var(--space-3);
        width: min(560px, calc(100vw - 24px));
        padding: var(--space-3) var(--space-4);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-large);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      p {
        flex: 1 1 240px;
      }
    `,
  ];

  override firstUpdated(): void {
    this._first.focus();
  }

  override render(): TemplateResult {
    const { face } = this.session;
    return html`<section aria-label=${words.pick_title} @keydown=${this.onKey}>
      <p role="status">${words.pick_lead}</p>
      <button @click=${() => face.takeInMiddle()}>${words.pick_middle}</button>
      <button @click=${() => face.giveUp()}>${texts.cancel}</button>
    </section>`;
  }

  private onKey(event: KeyboardEvent): void {
    if (event.key !== "Escape") return;
    event.preventDefault();
    this.session.face.giveUp();
  }
}
