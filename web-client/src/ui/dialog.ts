// <strata-dialog>: a modal dialog with a heading, content and a row of buttons. The first button
// leaves the dialog. The other buttons are the actions of the dialog (slot "actions").

import { css, html, LitElement, nothing, ReactiveElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { icon } from "./icons";
import { hasFingers } from "./pointers";
import { sharedStyles } from "./styles";
import { texts } from "../texts";

const openDialogs = new Set<HTMLDialogElement>();

/**
 * Whether a modal dialog is open. Keys that reach the page in this state are not shortcuts of the
 * page.
 */
export const modalIsOpen = (): boolean => openDialogs.size > 0;

const dockedDialogs = new Set<HTMLDialogElement>();

/**
 * Whether a dialog next to the stage is open. The page stays usable, but should not distract the
 * user.
 */
export const dockedIsOpen = (): boolean => dockedDialogs.size > 0;

@customElement("strata-dialog")
export class StrataDialog extends LitElement {
  @property() heading = "";
  /**
   * The text of the button that leaves the dialog without a change. If it is empty, only the cross
   * closes the dialog.
   */
  @property({ attribute: "way_out" }) wayOut = "";
  @property({ type: Boolean, reflect: true }) wide = false;
  /** A broad dialog, for tables. */
  @property({ type: Boolean, reflect: true }) broad = false;
  /** The widest dialog, for an editor with many parts. */
  @property({ type: Boolean, reflect: true }) vast = false;
  /** For content that is mostly text, which keys also scroll. */
  @property({ type: Boolean }) prose = false;
  /** For long text, which has two columns on wall displays. */
  @property({ type: Boolean, reflect: true }) long = false;
  /** Keeps the model behind the dialog visible, for questions about it. */
  @property({ type: Boolean, reflect: true }) aside = false;
  /**
   * Places the dialog next to the stage, which is neither dimmed nor blocked, for questions about
   * the model.
   */
  @property({ type: Boolean, reflect: true }) docked = false;
  /** Keeps the dialog near the top of the window while its height changes. */
  @property({ type: Boolean, reflect: true }) top = false;
  /**
   * Called before the user closes the dialog with Escape, the cross or a click outside. Null means
   * that the dialog may always close. close() does not call this function.
   */
  @property({ attribute: false }) mayClose: (() => Promise<boolean>) | null = null;
  @state() private _acts = false; // whether the slot "actions" has buttons
  private _asking = false;
  private _closes = false; // the dialog may close without a (further) call of `mayClose`
  private _used = false; // the user has used keys or the pointer

  @query("dialog") private _dialog!: HTMLDialogElement;
  @query(".content") private _content!: HTMLElement;
  @query(".way-out") private _wayOut!: HTMLButtonElement | null;

  static override styles = [
    sharedStyles,
    css`
      dialog {
        width: min(28.75rem, calc(100vw - 1.5rem));
        max-width: none;
        max-height: calc(100dvh - 1.5rem);
        padding: 0;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-large);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
        outline: none; /* the dialog has the focus if no content is focusable */
      }
      dialog[open] {
        display: flex;
        flex-direction: column;
      }
      :host([wide]) dialog {
        width: min(40rem, calc(100vw - 1.5rem));
      }
      :host([broad]) dialog {
        width: min(51.25rem, calc(100vw - 1.5rem));
      }
      :host([vast]) dialog {
        width: min(66.25rem, calc(100vw - 1.5rem));
      }
      @media (min-width: 2560px) {
        :host([long]) dialog {
          width: 84rem;
        }
      }
      dialog::backdrop {
        background: var(--veil);
      }
      :host([aside]) dialog {
        margin: 4.125rem var(--space-3) auto auto;
      }
      :host([aside]) dialog::backdrop {
        background: transparent; /* does not dim the content behind the dialog */
      }
      :host([docked]) dialog {
        position: fixed;
        inset: 4.125rem 0.875rem auto auto;
        max-height: calc(100dvh - 5rem);
        margin: 0;
        z-index: 30;
      }
      :host([top]) dialog {
        margin-top: min(4.125rem, 8dvh);
      }
      .head {
        display: flex;
        align-items: flex-start;
        gap: var(--space-3);
        padding: var(--space-5) var(--space-3) 0 var(--space-6);
      }
      h2 {
        flex: 1;
        padding-top: var(--space-1);
        font-size: var(--text-title-2);
        text-wrap: balance;
        overflow-wrap: anywhere;
      }
      .content {
        display: grid;
        gap: var(--space-4);
        padding: var(--space-3) var(--space-6) var(--space-5);
        overflow: auto;
        outline-offset: -2px;
      }
      .content.begun:focus-visible {
        outline: none; /* after opening, the focused element is the whole content */
      }
      footer {
        display: flex;
        flex-wrap: wrap;
        justify-content: flex-end;
        gap: var(--space-2);
        padding: var(--space-3) var(--space-6) var(--space-4);
        border-top: var(--edge) solid var(--line);
      }
      footer.empty {
        display: none;
      }
      @media (max-width: 560px) {
        footer {
          gap: var(--space-2);
          padding: var(--space-3) var(--space-3) var(--space-3);
        }
        .way-out,
        ::slotted(button[slot="actions"]) {
          padding: 0 var(--space-2) !important;
        }
        dialog {
          width: 100vw;
          margin: auto 0 0;
          border-radius: var(--radius-large) var(--radius-large) 0 0;
        }
        :host([wide]) dialog,
        :host([broad]) dialog,
        :host([vast]) dialog {
          width: 100vw;
        }
        :host([aside]) dialog {
          margin: auto 0 0;
        }
        :host([top]) dialog {
          margin: 0 0 auto; /* above the on-screen keyboard */
          border-radius: 0 0 var(--radius-large) var(--radius-large);
        }
        :host([docked]) dialog {
          inset: auto 0 0 0;
          max-height: 62dvh; /* the model stays visible above the dialog */
        }
      }
    `,
  ];

  override firstUpdated(): void {
    if (this.docked) {
      this._dialog.show();
      dockedDialogs.add(this._dialog);
    } else {
      this._dialog.showModal();
      openDialogs.add(this._dialog);
    }
    void this.begin();
  }

  /**
   * Sets the initial focus: to the element that requests it, otherwise to the first control,
   * otherwise to the button that leaves the dialog. It is never on the cross, which would be the
   * browser's default.
   */
  private async begin(): Promise<void> {
    const asks = this.querySelector<HTMLElement>("[autofocus]");
    if (asks) return asks.focus();
    const first = (this.prose ? this._content : await firstStop(this._content)) ?? this._wayOut;
    if (this._used || !this._dialog.open) return;
    if (first === this._content) this._content.classList.add("begun");
    (first && !opensKeyboard(first) ? first : this._dialog).focus();
  }

  /** Sets the initial focus again, after content from the server has arrived. */
  private onContent(): void {
    if (!this._used && this._dialog.open) void this.begin();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    openDialogs.delete(this._dialog);
    dockedDialogs.delete(this._dialog);
  }

  /** Closes the dialog and fires "closed", so the owner removes the element. */
  close(): void {
    this._closes = true;
    this._dialog.close();
  }

  /** Closes the dialog as if the user had requested it. */
  async leave(): Promise<void> {
    if (this._asking) return;
    this._asking = true;
    try {
      if (!this.mayClose || (await this.mayClose())) this.close();
    } finally {
      this._asking = false;
    }
  }

  override render(): TemplateResult {
    const used = (): void => void (this._used = true);
    const onKey = (event: KeyboardEvent): void => {
      used();
      // The browser handles Escape in other dialogs.
      if (!this.docked || event.key !== "Escape" || event.defaultPrevented) return;
      event.preventDefault();
      event.stopPropagation();
      void this.leave();
    };
    return html`<dialog
      aria-labelledby="heading"
      tabindex="-1"
      autofocus
      @cancel=${this.onCancel}
      @close=${this.onClose}
      @click=${this.onClick}
      @keydown=${onKey}
      @pointerdown=${used}
      @input=${used}
    >
      <div class="head">
        <h2 id="heading">${this.heading}</h2>
        <button class="icon quiet" aria-label=${texts.close} title=${texts.close} @click=${() => void this.leave()}>
          ${icon("close")}
        </button>
      </div>
      <div
        class="content"
        tabindex=${this.prose ? 0 : nothing}
        role=${this.prose ? "region" : nothing}
        aria-labelledby=${this.prose ? "heading" : nothing}
        @blur=${() => this._content.classList.remove("begun")}
      >
        <slot @slotchange=${this.onContent}></slot>
      </div>
      <footer class=${this.wayOut || this._acts ? "" : "empty"}>
        <slot name="told"></slot>
        ${this.wayOut ? html`<button class="way-out" @click=${() => void this.leave()}>${this.wayOut}</button>` : nothing}
        <slot name="actions" @slotchange=${this.onActions}></slot>
      </footer>
    </dialog>`;
  }

  private onActions(event: Event): void {
    this._acts = (event.target as HTMLSlotElement).assignedElements().length > 0;
  }

  private onCancel(event: Event): void {
    // A file field also fires "cancel".
    if (!this.mayClose || event.target !== this._dialog) return;
    event.preventDefault();
    void this.leave();
  }

  private onClose(): void {
    if (this.mayClose && !this._closes) {
      this._dialog.showModal(); // at a second Escape, browsers always close a dialog
      void this.leave();
      return;
    }
    openDialogs.delete(this._dialog);
    dockedDialogs.delete(this._dialog);
    this.dispatchEvent(new CustomEvent("closed"));
  }

  private onClick(event: MouseEvent): void {
    // the click was on the backdrop
    if (event.target === this._dialog && !this.docked) void this.leave();
  }
}

const kStops = "a[href], button, input, select, textarea, summary, [tabindex]";

/** Returns the first control in Tab order, including those in shadow roots and slots. */
async function firstStop(root: Element): Promise<HTMLElement | null> {
  const isStop =
    root instanceof HTMLElement &&
    root.matches(kStops) &&
    root.tabIndex >= 0 &&
    !root.matches(":disabled") &&
    root.checkVisibility();
  if (isStop) return root;
  if (root instanceof ReactiveElement) await root.updateComplete;
  for (const each of root instanceof HTMLSlotElement
    ? root.assignedElements()
    : (root.shadowRoot ?? root).children) {
    const found = await firstStop(each);
    if (found) return found;
  }
  return null;
}

/** Whether the focus on an element opens an on-screen keyboard, which covers half of the dialog. */
const opensKeyboard = (element: HTMLElement): boolean =>
  hasFingers() && element.matches("input[type=text], input[type=password], textarea");

/** The dialog of ask(): a question with two answers. */
@customElement("strata-question")
class StrataQuestion extends LitElement {
  @property() heading = "";
  @property() lead = "";
  @property() yes = "";
  @property({ type: Boolean }) danger = false;
  answer: (yes: boolean) => void = () => {};

  static override styles = sharedStyles;

  @query("strata-dialog") private _dialog!: StrataDialog;
  private _answered = false;

  override render(): TemplateResult {
    return html`<strata-dialog heading=${this.heading} way_out=${texts.cancel} @closed=${() => this.finish()}>
      <p>${this.lead}</p>
      <button
        slot="actions"
        class=${this.danger ? "danger" : "primary"}
        @click=${() => {
          this._answered = true;
          this._dialog.close();
        }}
      >
        ${this.yes}
      </button>
    </strata-dialog>`;
  }

  private finish(): void {
    this.answer(this._answered);
    this.remove();
  }
}

export function ask(question: {
  heading: string;
  lead: string;
  yes: string;
  danger?: boolean;
}): Promise<boolean> {
  return new Promise((resolve) => {
    const element = new StrataQuestion();
    Object.assign(element, { danger: false, ...question, answer: resolve });
    document.body.append(element);
  });
}

/** The dialog of askText(): a question for one line of text. */
@customElement("strata-text-question")
class StrataTextQuestion extends LitElement {
  @property() heading = "";
  @property() label = "";
  @property() text = "";
  @property() yes = "";
  answer: (text: string | null) => void = () => {};

  static override styles = sharedStyles;

  @query("strata-dialog") private _dialog!: StrataDialog;
  @query("input") private _input!: HTMLInputElement;
  private _answered: string | null = null;

  override render(): TemplateResult {
    return html`<strata-dialog heading=${this.heading} way_out=${texts.cancel} @closed=${() => this.finish()}>
      <form id="question" @submit=${this.onSubmit}>
        <label class="field">
          <span>${this.label}</span>
          <input type="text" required maxlength="200" .value=${this.text} autofocus />
        </label>
      </form>
      <button slot="actions" class="primary" form="question">${this.yes}</button>
    </strata-dialog>`;
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
    this._answered = this._input.value.trim() || null;
    this._dialog.close();
  }

  private finish(): void {
    this.answer(this._answered);
    this.remove();
  }
}

/** Asks for a text. Resolves to the text, or to null if the user cancels. */
export function askText(question: {
  heading: string;
  label: string;
  text: string;
  yes: string;
}): Promise<string | null> {
  return new Promise((resolve) => {
    const element = new StrataTextQuestion();
    Object.assign(element, { ...question, answer: resolve });
    document.body.append(element);
  });
}
