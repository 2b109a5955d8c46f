// <strata-view-dialog>: keeps what this person sees under a name, or with `view` names and describes one anew.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, new_id } from "../core/api";
import type { View } from "../core/protocol.gen";
import type { ViewContent } from "../core/views";
import "./dialog";
import type { StrataDialog } from "./dialog";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { form_styles, shared_styles } from "./styles";
import { texts } from "./texts";

const words = texts.kept_views;

@customElement("strata-view-dialog")
export class StrataViewDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) view: View | null = null;
  @state() private problem_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("form") private form_!: HTMLFormElement;
  @query("input") private name_!: HTMLInputElement;
  @query("textarea") private text_!: HTMLTextAreaElement;
  private base_: View | null = null; // the view as this person knows it
  private content_: ViewContent | null = null; // of a new one: what was seen when this was opened
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

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.view) this.base_ = this.view;
    else this.content_ = this.session.views.content();
  }

  override render(): TemplateResult {
    const { view } = this;
    return html`<strata-dialog
      aside
      heading=${view ? words.describe_title(view.name) : words.keep_title}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${view ? nothing : html`<p class="hint">${words.keep_lead}</p>`}
      <form @submit=${this.on_submit} @input=${() => (this.key_ = new_id())}>
        <label class="field">
          <span>${words.name}</span>
          <input type="text" required maxlength="200" autocomplete="off" autofocus .defaultValue=${view?.name ?? ""} placeholder=${view ? "" : words.name_hint} />
        </label>
        <label class="field">
          <span>${words.text}</span>
          <textarea maxlength="10000" .defaultValue=${view?.text ?? ""}></textarea>
        </label>
      </form>
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button slot="actions" @click=${() => this.dialog_.close()}>${texts.cancel}</button>
      <button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => this.form_.requestSubmit()}>
        ${view ? texts.save : words.keep_yes}
      </button>
    </strata-dialog>`;
  }

  private readonly on_submit = (event: Event): void => {
    event.preventDefault();
    const called = { name: this.name_.value.trim(), text: this.text_.value.trim() };
    if (called.name === "") {
      this.problem_ = words.name_empty;
      this.name_.focus();
    } else if (!this.busy_) {
      void this.save(called);
    }
  };

  private async save(called: { name: string; text: string }): Promise<void> {
    const { views } = this.session;
    this.busy_ = true;
    try {
      if (this.base_) await views.describe(this.base_, called);
      else if (this.content_) await views.keep(called, this.content_, this.key_);
      if (!this.view) notices.show("success", words.kept(called.name));
      this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const newest = error.status === 412 && this.base_ ? views.find(this.base_.id) : null;
      this.base_ = newest ?? this.base_;
      this.problem_ = newest ? words.changed(newest.name) : error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
