// <strata-naming-dialog>: asks what something is called, and what there is to say about it.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, new_id } from "../net/api";
import "./dialog";
import type { StrataDialog } from "./dialog";
import { form_styles, shared_styles } from "./styles";
import { texts } from "../texts";

export interface Called {
  name: string;
  text: string;
}

/** Something that is so or not, beside name and text. */
export interface NamingOption {
  label: string;
  hint: string;
  checked: boolean;
}

/** What the fields are called, and what is said where there is no name. */
export interface NamingWords {
  name: string;
  name_hint: string;
  name_empty: string;
  text: string;
  text_hint?: string;
}

const option_field = ({ label, hint, checked }: NamingOption): TemplateResult =>
  html`<label class="check"><input type="checkbox" aria-describedby="option-hint" .defaultChecked=${checked} />${label}</label>
    <p class="hint" id="option-hint">${hint}</p>`;

@customElement("strata-naming-dialog")
export class StrataNamingDialog extends LitElement {
  @property() heading = "";
  @property() lead = "";
  /** On the button. */
  @property() yes = "";
  /** As of <strata-dialog>. */
  @property({ type: Boolean }) aside = false;
  @property({ attribute: false }) words!: NamingWords;
  /** What it is called so far; null: it is new. */
  @property({ attribute: false }) called: Called | null = null;
  @property({ attribute: false }) option: NamingOption | null = null;
  /**
   * Answers what is wrong; nothing: it is done, and the dialog closes. `key` is the same for each
   * attempt at the same words.
   */
  @property({ attribute: false }) save!: (
    called: Called,
    key: string,
    checked: boolean,
  ) => Promise<string>;
  @state() private problem_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("form") private form_!: HTMLFormElement;
  @query("input") private name_!: HTMLInputElement;
  @query("textarea") private text_!: HTMLTextAreaElement;
  @query("input[type=checkbox]") private option_!: HTMLInputElement | null;
  private key_ = new_id();

  static override styles = [
    shared_styles,
    form_styles,
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
      <form @submit=${this.on_submit} @input=${this.on_input}>
        <label class="field">
          <span>${words.name}</span>
          <input type="text" required maxlength="200" autocomplete="off" autofocus .defaultValue=${called?.name ?? ""} placeholder=${called ? "" : words.name_hint} />
        </label>
        <label class="field">
          <span>${words.text}</span>
          <textarea maxlength="10000" .defaultValue=${called?.text ?? ""} placeholder=${words.text_hint ?? ""}></textarea>
        </label>
        ${this.option ? option_field(this.option) : nothing}
      </form>
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => this.form_.requestSubmit()}>${this.yes}</button>
    </strata-dialog>`;
  }

  private readonly on_input = (): void => {
    this.key_ = new_id();
    this.problem_ = "";
  };

  private readonly on_submit = (event: Event): void => {
    event.preventDefault();
    const called = { name: this.name_.value.trim(), text: this.text_.value.trim() };
    if (called.name === "") {
      this.problem_ = this.words.name_empty;
      this.name_.focus();
    } else if (!this.busy_) {
      void this.attempt(called);
    }
  };

  private async attempt(called: Called): Promise<void> {
    this.busy_ = true;
    try {
      this.problem_ = await this.save(called, this.key_, this.option_?.checked ?? false);
      if (this.problem_ === "") this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
