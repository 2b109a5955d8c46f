// <strata-notices>: messages at the bottom of the page.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { icon } from "../ui/icons";
import { notices, type Notice, type NoticeLink } from "../ui/notices";
import { follow } from "../ui/routes";
import { sharedStyles } from "../ui/styles";
import { texts } from "../texts";

@customElement("strata-notices")
export class StrataNotices extends LitElement {
  @state() private _shown: readonly Notice[] = [];
  private _unsubscribe: (() => void) | null = null;

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: fixed;
        z-index: 50;
        left: 4.75rem; /* right of the tools and above the scale bar */
        /* plus the height of the content below the stage */
        bottom: calc(4.75rem + var(--beneath, 0px));
        display: grid;
        gap: var(--space-2);
        width: min(27.5rem, calc(100vw - 5.5rem));
        pointer-events: none;
      }
      @media (max-width: 820px) {
        :host {
          left: 0.75rem;
          bottom: calc(4.25rem + var(--beneath, 0px) + env(safe-area-inset-bottom));
          width: calc(100vw - 1.5rem);
        }
      }
      .notice {
        display: flex;
        align-items: flex-start;
        gap: var(--space-2);
        padding: var(--space-3) var(--space-2) var(--space-3) var(--space-3);
        border: var(--edge) solid var(--line);
        border-left: 4px solid var(--calm);
        border-radius: var(--radius);
        background: var(--raised);
        box-shadow: var(--shadow);
        pointer-events: auto;
        animation: rise var(--fast) ease-out;
      }
      .notice.problem {
        border-left-color: var(--danger);
      }
      .notice.info {
        border-left-color: var(--line-strong);
      }
      .words {
        flex: 1;
        min-width: 0;
        padding-top: var(--space-half);
        overflow-wrap: anywhere;
      }
      .words strong {
        font-weight: 600;
      }
      .words p {
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
      button.icon {
        width: 1.75rem;
        min-height: var(--control-small);
      }
      button svg.glyph {
        width: 1rem;
        height: 1rem;
      }
      @keyframes rise {
        from {
          opacity: 0;
          transform: translateY(0.5rem);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._unsubscribe = notices.subscribe((shown) => (this._shown = shown));
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._unsubscribe?.();
  }

  override render(): TemplateResult {
    return html`${repeat(
      this._shown,
      (notice) => notice.id,
      (
        notice,
      ) => html`<div class="notice ${notice.kind}" role=${notice.kind === "problem" ? "alert" : "status"}>
        <div class="words">
          <strong>${notice.title}</strong>
          ${notice.detail ? html`<p>${notice.detail}</p>` : ""}
          ${notice.link ? linkOf(notice, notice.link) : ""}
        </div>
        <button
          class="icon quiet"
          aria-label=${texts.close}
          @click=${() => notices.dismiss(notice.id)}
        >
          ${icon("close")}
        </button>
      </div>`,
    )}`;
  }
}

function linkOf({ id }: Notice, link: NoticeLink): TemplateResult {
  if ("href" in link)
    return html`<a class="text" href=${link.href} @click=${follow}>${link.label}</a>`;
  const act = (): void => {
    notices.dismiss(id);
    link.act();
  };
  return html`<button class="link" @click=${act}>${link.label}</button>`;
}
