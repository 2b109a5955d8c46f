// A part of the side panel that folds: a heading, whose button says with aria-expanded whether it
// is open, and what is shown then. This browser keeps which are open.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { property } from "lit/decorators.js";
import { follow_session } from "./follow-session";
import { icon } from "../ui/icons";
import { Kept } from "../core/kept";
import type { ModelSession } from "./model-session";
import { shared_styles } from "../ui/styles";

export const folding_styles = [
  shared_styles,
  css`
    :host {
      display: block;
    }
    .heading {
      display: flex;
      align-items: center;
      gap: 0.5rem;
    }
    h2 {
      flex: 1;
      font-size: 1.08rem;
    }
    h2 button {
      width: 100%;
      justify-content: flex-start;
      gap: 0.5rem;
      min-height: 2.25rem;
      margin-left: -0.5rem;
      padding: 0 0.5rem;
      font: inherit;
    }
    h2 svg.glyph {
      transform: rotate(90deg);
      transition: transform 120ms;
    }
    h2 button[aria-expanded="true"] svg.glyph {
      transform: rotate(180deg);
    }
    .number {
      font: 600 0.82rem var(--sans, inherit);
      color: var(--ink-soft);
    }
    .parts {
      display: grid;
      grid-template-columns: minmax(0, 1fr);
      gap: 0.625rem;
      margin-top: 0.5rem;
    }
    .segments {
      display: flex;
    }
  `,
];

export abstract class FoldingPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  private readonly open_: Kept<boolean>;

  /** `name`: by which the browser keeps whether it is open. */
  constructor(name: string) {
    super();
    this.open_ = new Kept(() => localStorage, `strata.${name}_panel_open`, false);
    follow_session(this);
  }

  protected abstract readonly heading: string;
  /** What is drawn only while it is open. */
  protected abstract content(): unknown;
  /** In the button, after its words. */
  protected beside_heading(): unknown {
    return nothing;
  }
  /** After the button. */
  protected tools(): unknown {
    return nothing;
  }
  protected toggled(): void {}

  get is_open(): boolean {
    return this.open_.value;
  }

  override render(): TemplateResult {
    const { is_open } = this;
    return html`<div class="heading">
        <h2>
          <button class="quiet" aria-expanded=${is_open} aria-controls="parts" @click=${this.toggle}>${icon("up")}${this.heading}${this.beside_heading()}</button>
        </h2>
        ${this.tools()}
      </div>
      <div id="parts" class="parts" ?hidden=${!is_open}>${is_open ? this.content() : nothing}</div>`;
  }

  private toggle(): void {
    this.open_.value = !this.open_.value;
    this.toggled();
    this.requestUpdate();
  }
}
