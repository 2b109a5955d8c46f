// <strata-copy-field>: a text to be taken along, with a button that copies it.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { icon } from "./icons";
import { shared_styles } from "./styles";
import { texts } from "../texts";

@customElement("strata-copy-field")
export class StrataCopyField extends LitElement {
  @property() label = "";
  @property() text = "";
  /** Takes the keyboard as it comes: it stands where a form was that is done. */
  @property({ type: Boolean }) follows_form = false;
  @state() private told_ = "";
  @query("input") private input_!: HTMLInputElement;

  static override styles = [
    shared_styles,
    css`
      :host {
        position: relative; /* of what is hidden for eyes */
        display: flex;
        gap: 0.5rem;
      }
      input[type="text"] {
        flex: 1;
        min-width: 0;
        font: 0.84rem var(--mono);
      }
      button {
        min-height: 2.375rem;
      }
    `,
  ];

  override firstUpdated(): void {
    if (this.follows_form) this.input_.focus();
  }

  override render(): TemplateResult {
    return html`<input type="text" readonly aria-label=${this.label} .value=${this.text} @focus=${() => this.input_.select()} />
      <button type="button" @click=${() => void this.copy()}>
        ${icon(this.told_ === texts.copy.copied ? "check" : "copy")}${this.told_ || texts.copy.button}
      </button>
      <span class="visually-hidden" role="status">${this.told_}</span>`;
  }

  private async copy(): Promise<void> {
    const copied = await copy_text(this.text, () => {
      this.input_.select();
      return () => {}; // it stays selected for who copies by hand
    });
    this.told_ = copied ? texts.copy.copied : texts.copy.by_hand;
  }
}

/**
 * Returns whether the browser took it. `select`: selects the text in the page, which also works
 * where the page came by plain HTTP; returns what lets go of it.
 */
export async function copy_text(text: string, select: () => () => void): Promise<boolean> {
  const by_selection = (): boolean => {
    const let_go = select();
    const copied = document.execCommand("copy");
    let_go();
    return copied;
  };
  return navigator.clipboard
    ? navigator.clipboard.writeText(text).then(() => true, by_selection)
    : by_selection();
}
