// <strata-dialog>: a modal sheet with a heading, content and a row of buttons (slot "actions").

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { icon } from "./icons";
import { shared_styles } from "./styles";
import { texts } from "./texts";

const open_dialogs = new Set<HTMLDialogElement>();

/** Keys that reach the page while a dialog is open, because nothing in it has the focus, are not for the page. */
export const modal_is_open = (): boolean => open_dialogs.size > 0;

@customElement("strata-dialog")
export class StrataDialog extends LitElement {
  @property() heading = "";
  @property({ type: Boolean, reflect: true }) wide = false;
  /** For tables. */
  @property({ type: Boolean, reflect: true }) broad = false;
  /** For an editor of many parts. */
  @property({ type: Boolean, reflect: true }) vast = false;
  /** Holds words to read and hardly a control: it is scrolled by keys as well. */
  @property({ type: Boolean }) prose = false;
  /** Leaves the picture behind it visible: for questions about what is seen. */
  @property({ type: Boolean, reflect: true }) aside = false;
  /** Asked before a person closes it by Escape, its cross or beside it; null: it closes. close() does not ask. */
  @property({ attribute: false }) may_close: (() => Promise<boolean>) | null = null;
  private asking_ = false;
  private closes_ = false; // what closes it was asked, or need not ask

  @query("dialog") private dialog_!: HTMLDialogElement;

  static override styles = [
    shared_styles,
    css`
      dialog {
        width: min(460px, calc(100vw - 24px));
        max-width: none;
        max-height: calc(100dvh - 24px);
        padding: 0;
        border: var(--edge) solid var(--line);
        border-radius: 14px;
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      dialog[open] {
        display: flex;
        flex-direction: column;
      }
      :host([wide]) dialog {
        width: min(640px, calc(100vw - 24px));
      }
      :host([broad]) dialog {
        width: min(820px, calc(100vw - 24px));
      }
      :host([vast]) dialog {
        width: min(1060px, calc(100vw - 24px));
      }
      dialog::backdrop {
        background: var(--veil);
      }
      :host([aside]) dialog {
        margin: 66px 14px auto auto;
      }
      :host([aside]) dialog::backdrop {
        background: var(--thin-veil);
      }
      .head {
        display: flex;
        align-items: flex-start;
        gap: 12px;
        padding: 20px 14px 0 24px;
      }
      h2 {
        flex: 1;
        padding-top: 3px;
        font-size: 1.3rem;
        text-wrap: balance;
        overflow-wrap: anywhere;
      }
      .content {
        display: grid;
        gap: 16px;
        padding: 14px 24px 20px;
        overflow: auto;
        outline-offset: -3px;
      }
      footer {
        display: flex;
        flex-wrap: wrap;
        justify-content: flex-end;
        gap: 10px;
        padding: 14px 24px 18px;
        border-top: var(--edge) solid var(--line);
      }
      footer.empty {
        display: none;
      }
      @media (max-width: 560px) {
        dialog {
          width: 100vw;
          margin: auto 0 0;
          border-radius: 16px 16px 0 0;
        }
        :host([wide]) dialog,
        :host([broad]) dialog,
        :host([vast]) dialog {
          width: 100vw;
        }
        :host([aside]) dialog {
          margin: auto 0 0;
        }
      }
    `,
  ];

  override firstUpdated(): void {
    this.dialog_.showModal();
    open_dialogs.add(this.dialog_);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    open_dialogs.delete(this.dialog_);
  }

  /** Closes and tells: the owner removes the element on "closed". */
  close(): void {
    this.closes_ = true;
    this.dialog_.close();
  }

  /** As a person closes it. */
  async leave(): Promise<void> {
    if (this.asking_) return;
    this.asking_ = true;
    try {
      if (!this.may_close || (await this.may_close())) this.close();
    } finally {
      this.asking_ = false;
    }
  }

  override render(): TemplateResult {
    return html`<dialog aria-labelledby="heading" @cancel=${this.on_cancel} @close=${this.on_close} @click=${this.on_click}>
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
      >
        <slot></slot>
      </div>
      <footer class="empty"><slot name="actions" @slotchange=${this.on_actions}></slot></footer>
    </dialog>`;
  }

  private on_actions(event: Event): void {
    const slot = event.target as HTMLSlotElement;
    slot.parentElement?.classList.toggle("empty", slot.assignedElements().length === 0);
  }

  private on_cancel(event: Event): void {
    if (!this.may_close || event.target !== this.dialog_) return; // a file field, too, tells that nothing was chosen
    event.preventDefault();
    void this.leave();
  }

  private on_close(): void {
    if (this.may_close && !this.closes_) {
      this.dialog_.showModal(); // browsers close it at a second Escape whatever the page says
      void this.leave();
      return;
    }
    open_dialogs.delete(this.dialog_);
    this.dispatchEvent(new CustomEvent("closed"));
  }

  private on_click(event: MouseEvent): void {
    if (event.target === this.dialog_) void this.leave(); // the backdrop
  }
}

/** A question with two answers; asked by ask(). */
@customElement("strata-question")
class StrataQuestion extends LitElement {
  @property() heading = "";
  @property() lead = "";
  @property() yes = "";
  @property({ type: Boolean }) danger = false;
  answer: (yes: boolean) => void = () => {};

  static override styles = shared_styles;

  @query("strata-dialog") private dialog_!: StrataDialog;
  private answered_ = false;

  override render(): TemplateResult {
    return html`<strata-dialog heading=${this.heading} @closed=${() => this.finish()}>
      <p>${this.lead}</p>
      <button slot="actions" @click=${() => this.dialog_.close()}>${texts.cancel}</button>
      <button
        slot="actions"
        class=${this.danger ? "danger" : "primary"}
        @click=${() => {
          this.answered_ = true;
          this.dialog_.close();
        }}
      >
        ${this.yes}
      </button>
    </strata-dialog>`;
  }

  private finish(): void {
    this.answer(this.answered_);
    this.remove();
  }
}

export function ask(question: { heading: string; lead: string; yes: string; danger?: boolean }): Promise<boolean> {
  return new Promise((resolve) => {
    const element = new StrataQuestion();
    Object.assign(element, { danger: false, ...question, answer: resolve });
    document.body.append(element);
  });
}

/** A question for one line of text; asked by ask_text(). */
@customElement("strata-text-question")
class StrataTextQuestion extends LitElement {
  @property() heading = "";
  @property() label = "";
  @property() text = "";
  @property() yes = "";
  answer: (text: string | null) => void = () => {};

  static override styles = shared_styles;

  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("input") private input_!: HTMLInputElement;
  private answered_: string | null = null;

  override render(): TemplateResult {
    return html`<strata-dialog heading=${this.heading} @closed=${() => this.finish()}>
      <form id="question" @submit=${this.on_submit}>
        <label class="field">
          <span>${this.label}</span>
          <input type="text" required maxlength="200" .value=${this.text} autofocus />
        </label>
      </form>
      <button slot="actions" @click=${() => this.dialog_.close()}>${texts.cancel}</button>
      <button slot="actions" class="primary" form="question">${this.yes}</button>
    </strata-dialog>`;
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    this.answered_ = this.input_.value.trim() || null;
    this.dialog_.close();
  }

  private finish(): void {
    this.answer(this.answered_);
    this.remove();
  }
}

/** The text; null: none was given. */
export function ask_text(question: { heading: string; label: string; text: string; yes: string }): Promise<string | null> {
  return new Promise((resolve) => {
    const element = new StrataTextQuestion();
    Object.assign(element, { ...question, answer: resolve });
    document.body.append(element);
  });
}
