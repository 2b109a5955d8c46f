// A part of the side panel: a heading, its tools, and the content. The page shows each part in a
// tab.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { property } from "lit/decorators.js";
import { followSession } from "./follow-session";
import type { ModelSession, SessionPart } from "./model-session";
import { panelHeadingStyles } from "../ui/panel/panel-styles";
import { sharedStyles } from "../ui/styles";

export const sidePanelStyles = [
  sharedStyles,
  panelHeadingStyles,
  css`
    :host {
      display: block;
    }
    .number {
      font: 600 var(--text-small) var(--sans, inherit);
      color: var(--ink-soft);
    }
    .parts {
      display: grid;
      grid-template-columns: minmax(0, 1fr);
      gap: var(--space-2);
    }
    .segments {
      display: flex;
    }
  `,
];

export abstract class SidePanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  /** `parts` are parts of the session, as in followSession(). */
  constructor(...parts: SessionPart[]) {
    super();
    followSession(this, ...parts);
  }

  protected abstract readonly heading: string;
  protected abstract content(): unknown;
  /** The content after the text of the heading. */
  protected besideHeading(): unknown {
    return nothing;
  }
  /** The tools after the heading. */
  protected tools(): unknown {
    return nothing;
  }

  override render(): TemplateResult {
    return html`<div class="heading">
        <h2>${this.heading}${this.besideHeading()}</h2>
        ${this.tools()}
      </div>
      <div class="parts">${this.content()}</div>`;
  }
}
