// A folding part of the side panel: a heading with a button, whose aria-expanded has the state, and
// the content. This browser keeps which parts are open.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { property } from "lit/decorators.js";
import { followSession } from "./follow-session";
import { icon } from "../ui/icons";
import { Kept } from "../core/kept";
import type { ModelSession, SessionPart } from "./model-session";
import { sharedStyles } from "../ui/styles";

export const foldingStyles = [
  sharedStyles,
  css`
    :host {
      display: block;
    }
    .heading {
      display: flex;
      align-items: center;
      gap: var(--space-2);
    }
    h2 {
      flex: 1;
      font-size: var(--text-large);
    }
    h2 button {
      width: 100%;
      justify-content: flex-start;
      gap: var(--space-2);
      min-height: var(--control);
      margin-left: calc(-1 * var(--space-2));
      padding: 0 var(--space-2);
      font: inherit;
    }
    h2 svg.glyph {
      width: 1rem;
      height: 1rem;
      color: var(--ink-soft);
      transition: transform var(--fast);
    }
    h2 button[aria-expanded="true"] svg.glyph {
      transform: rotate(90deg);
    }
    .number {
      font: 600 var(--text-small) var(--sans, inherit);
      color: var(--ink-soft);
    }
    .parts {
      display: grid;
      grid-template-columns: minmax(0, 1fr);
      gap: var(--space-2);
      margin-top: var(--space-2);
    }
    .segments {
      display: flex;
    }
  `,
];

export abstract class FoldingPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  private readonly _open: Kept<boolean>;

  /** `name`: key of the stored state. `parts`: of the session, as in followSession(). */
  constructor(name: string, ...parts: SessionPart[]) {
    super();
    this._open = new Kept(() => localStorage, `strata.${name}_panel_open`, false);
    followSession(this, ...parts);
  }

  protected abstract readonly heading: string;
  /** Rendered only while open. */
  protected abstract content(): unknown;
  /** In the button, after its text. */
  protected besideHeading(): unknown {
    return nothing;
  }
  /** After the button. */
  protected tools(): unknown {
    return nothing;
  }
  protected toggled(): void {}

  get isOpen(): boolean {
    return this._open.value;
  }

  override render(): TemplateResult {
    const { isOpen } = this;
    return html`<div class="heading">
        <h2>
          <button class="quiet" aria-expanded=${isOpen} aria-controls="parts" @click=${this.toggle}>${icon("chevron")}${this.heading}${this.besideHeading()}</button>
        </h2>
        ${this.tools()}
      </div>
      <div id="parts" class="parts" ?hidden=${!isOpen}>${isOpen ? this.content() : nothing}</div>`;
  }

  private toggle(): void {
    this._open.value = !this._open.value;
    this.toggled();
    this.requestUpdate();
  }
}
