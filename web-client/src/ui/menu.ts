// <strata-menu>: a button that opens a list of commands. The commands are slotted buttons. Content
// in the slot "face" replaces the button's icon.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { icon, type IconName } from "./icons";
import { sharedStyles } from "./styles";

@customElement("strata-menu")
export class StrataMenu extends LitElement {
  @property() label = "";
  @property() glyph: IconName = "more";
  @property({ type: Boolean }) quiet = true;
  @property({ type: Boolean, reflect: true }) small = false;
  /** Whether the button is as wide as its face. */
  @property({ type: Boolean, reflect: true }) wide = false;
  @property() side: "below" | "right" = "below";

  @query("button") private _button!: HTMLButtonElement;
  @query(".list") private _list!: HTMLElement;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: inline-block;
      }
      .list {
        position: fixed;
        inset: auto;
        margin: 0;
        padding: var(--space-1);
        width: max-content;
        min-width: 11.25rem;
        max-height: calc(100dvh - 1rem);
        max-width: calc(100vw - 1rem);
        overflow-y: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      :host([small]) {
        display: inline-flex;
      }
      :host([small]) button.icon {
        width: 1.625rem;
        min-height: 1.625rem;
      }
      :host([wide]) button.icon {
        width: auto;
      }
      ::slotted(button) {
        display: flex !important;
        width: 100%;
        justify-content: flex-start !important;
        text-align: start;
        white-space: normal !important;
      }
      ::slotted([slot="face"]) {
        pointer-events: none; /* the button receives the clicks */
      }
      ::slotted(hr) {
        margin: var(--space-1) 0;
        border: 0;
        border-top: var(--edge) solid var(--line);
      }
    `,
  ];

  override render(): TemplateResult {
    return html`<button
        class="icon ${this.quiet ? "quiet" : ""}"
        aria-haspopup="menu"
        aria-label=${this.label}
        title=${this.label}
        @click=${this.open}
      >
        <slot name="face">${icon(this.glyph)}</slot>
      </button>
      <div class="list" popover="auto" role="menu" @click=${this._closing} @keydown=${this.onKey} @beforetoggle=${this.onBeforeToggle} @toggle=${this.onToggle}>
        <slot @click=${(event: Event) => event.stopPropagation()}></slot>
      </div>`;
  }

  constructor() {
    super();
    // The browser closes the list. Escape must not also close elements behind it.
    this.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this._list.matches(":popover-open")) event.stopPropagation();
    });
  }

  private open(event: Event): void {
    event.stopPropagation();
    this._list.showPopover();
    this.place();
    addEventListener("resize", this.place);
    this._grown.observe(this._list);
  }

  private readonly place = (): void => {
    const anchor = this._button.getBoundingClientRect();
    const box = this._list.getBoundingClientRect();
    const margin = 8;
    const left = this.side === "right" ? anchor.right + 6 : anchor.right - box.width;
    const top = this.side === "right" ? anchor.top : anchor.bottom + 4;
    this._list.style.left = `${Math.max(margin, Math.min(left, innerWidth - box.width - margin))}px`;
    this._list.style.top = `${Math.max(margin, Math.min(top, innerHeight - box.height - margin))}px`;
  };

  /**
   * Positions the list again when its commands change. In a narrower window, the menu contains more
   * commands.
   */
  private readonly _grown = new ResizeObserver(this.place);

  /**
   * Closes the list before the command's handler runs. The menu's button then has the focus, and a
   * dialog that the command opens later returns the focus to the button.
   */
  private readonly _closing = { handleEvent: (): void => this._list.hidePopover(), capture: true };

  private items(): HTMLButtonElement[] {
    return [...this.querySelectorAll("button")].filter((button) => !button.disabled);
  }

  /**
   * Returns the focus to the button. The browser does not do this for slotted buttons, because they
   * are not descendants of the list.
   */
  private onBeforeToggle(event: ToggleEvent): void {
    if (event.newState === "closed" && this.items().some((item) => item.matches(":focus")))
      this._button.focus();
  }

  private onToggle(event: ToggleEvent): void {
    if (event.newState === "open") this.items()[0]?.focus();
    else this.stay();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stay();
  }

  private stay(): void {
    removeEventListener("resize", this.place);
    this._grown.disconnect();
  }

  private onKey(event: KeyboardEvent): void {
    const items = this.items();
    const at = items.indexOf(
      document.activeElement?.shadowRoot?.activeElement as HTMLButtonElement,
    );
    const focused = at >= 0 ? at : items.findIndex((item) => item.matches(":focus"));
    const step = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
    if (step === 0) return;
    event.preventDefault();
    event.stopPropagation();
    items[(focused + step + items.length) % items.length]?.focus();
  }
}
