// <strata-naming-dialog>: asks for a name and a description.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../net/api-error";
import { newId } from "../core/ids";
import "./dialog";
import type { StrataDialog } from "./dialog";
import { formStyles, sharedStyles } from "./styles";
import { texts } from "../texts";

export interface Called {
  name: string;
  text: string;
}

/** A checkbox in addition to the name and the text. */
export interface NamingOption {
  label: string;
  hint: string;
  checked: boolean;
}

/** The labels of the fields, and the message for a missing name. */
export interface NamingWords {
  name: string;
  name_hint: string;
  name_empty: string;
  text: string;
  text_hint?: string;
}

const optionField = ({ label, hint, checked }: NamingOption): TemplateResult =>
  html`<label class="check"><input type="checkbox" aria-describedby="option-hint" .defaultChecked=${checked} />${label}</label>
    <p class="hint" id="option-hint">${hint}</p>`;

@customElement("strata-naming-dialog")
export class StrataNamingDialog extends LitElement {
  @property() heading = "";
  @property() lead = "";
  /** The text of the button. */
  @property() yes = "";
  /** As in <strata-dialog>. */
  @property({ type: Boolean }) aside = false;
  @property({ attribute: false }) words!: NamingWords;
  /** The current name and text. Null for a new item. */
  @property({ attribute: false }) called: Called | null = null;
  @property({ attribute: false }) option: NamingOption | null = null;
  /**
   * Saves the input. Returns the problem, or an empty text after success, which closes the dialog.
   * `key` is the idempotency key, which is the same for all attempts with the same input.
   */
  @property({ attribute: false }) save!: (
    called: Called,
    key: string,
    checked: boolean,
  ) => Promise<string>;
  @state() private _problem = "";
  @state() private _busy = false;
  @query("strata-dialog") private _dialog!: StrataDialog;
  @query("form") private _form!: HTMLFormElement;
  @query("input") private _name!: HTMLInputElement;
  @query("textarea") private _text!: HTMLTextAreaElement;
  @query("input[type=checkbox]") private _option!: HTMLInputElement | null;
  private _key = newId();

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      textarea {
        min-height: 96px;
      }
    `,
  ];

  override render(): TemplateResult {
    const { words, called } = this;
    return html`<strata-dialog ?aside=${this.aside} heading=${this.heading} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${this.lead ? html`<p class="hint">${this.lead}</p>` : nothing}
      <form @submit=${this.onSubmit} @input=${this.onInput}>
        <label class="field">
          <span>${words.name}</span>
          <input type="text" required maxlength="200" autocomplete="off" autofocus .defaultValue=${called?.name ?? ""} placeholder=${called ? "" : words.name_hint} />
        </label>
        <label class="field">
          <span>${words.text}</span>
          <textarea maxlength="10000" .defaultValue=${called?.text ?? ""} placeholder=${words.text_hint ?? ""}></textarea>
        </label>
        ${this.option ? optionField(this.option) : nothing}
      </form>
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <button slot="actions" class="primary" ?disabled=${this._busy} @click=${() => this._form.requestSubmit()}>${this.yes}</button>
    </strata-dialog>`;
  }

  private readonly onInput = (): void => {
    this._key = newId();
    this._problem = "";
  };

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    const called = { name: this._name.value.trim(), text: this._text.value.trim() };
    if (called.name === "") {
      this._problem = this.words.name_empty;
      this._name.focus();
    } else if (!this._busy) {
      void this.attempt(called);
    }
  };

  private async attempt(called: Called): Promise<void> {
    this._busy = true;
    try {
      this._problem = await this.save(called, this._key, this._option?.checked ?? false);
      if (this._problem === "") this._dialog.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}
