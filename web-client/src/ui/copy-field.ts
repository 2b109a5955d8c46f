// <strata-copy-field>: a text to copy, with a button that copies it.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { icon } from "./icons";
import { sharedStyles } from "./styles";
import { texts } from "../texts";

@customElement("strata-copy-field")
export class StrataCopyField extends LitElement {
  @property() label = "";
  @property() text = "";
  /** Whether the field takes the initial focus, because it replaces a finished form. */
  @property({ attribute: "follows_form", type: Boolean }) followsForm = false;
  @state() private _told = "";
  @query("input") private _input!: HTMLInputElement;

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: relative; /* contains visually hidden content */
        display: flex;
        gap: var(--space-2);
      }
      input[type="text"] {
        flex: 1;
        min-width: 0;
        font: var(--text-small) var(--mono);
      }
      button {
        min-height: var(--control);
      }
    `,
  ];

  override firstUpdated(): void {
    if (this.followsForm) this._input.focus();
  }

  override render(): TemplateResult {
    return html`<input type="text" readonly aria-label=${this.label} .value=${this.text} @focus=${() => this._input.select()} />
      <button type="button" @click=${() => void this.copy()}>
        ${icon(this._told === texts.copy.copied ? "check" : "copy")}${this._told || texts.copy.button}
      </button>
      <span class="visually-hidden" role="status">${this._told}</span>`;
  }

  private async copy(): Promise<void> {
    const copied = await copyText(this.text, () => {
      this._input.select();
      return () => {}; // keeps the selection, so the user can copy it
    });
    this._told = copied ? texts.copy.copied : texts.copy.by_hand;
  }
}

/**
 * Copies a text. Returns whether it was copied. `select` selects the text in the page, and returns
 * a function that removes the selection. Copying a selection also works over plain HTTP.
 */
export async function copyText(text: string, select: () => () => void): Promise<boolean> {
  const bySelection = (): boolean => {
    const letGo = select();
    const copied = document.execCommand("copy");
    letGo();
    return copied;
  };
  return navigator.clipboard
    ? navigator.clipboard.writeText(text).then(() => true, bySelection)
    : bySelection();
}
