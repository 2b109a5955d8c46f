// <strata-view-dialog>: saves the current view under a name or, with `view`, changes its name and
// text.

import { html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { View } from "../../core/protocol.gen";
import type { ViewContent } from "../../domain/views";
import type { ModelSession } from "../../session/model-session";
import "../../ui/naming-dialog";
import type { Called } from "../../ui/naming-dialog";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";

const words = texts.kept_views;

@customElement("strata-view-dialog")
export class StrataViewDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) view: View | null = null;
  private _base: View | null = null; // the version that this user has seen
  private _content: ViewContent | null = null; // the state when the dialog opened, for a new view

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.view) this._base = this.view;
    else this._content = this.session.views.content();
  }

  override render(): TemplateResult {
    const { view } = this;
    return html`<strata-naming-dialog
      aside
      heading=${view ? words.describe_title(view.name) : words.keep_title}
      lead=${view ? "" : words.keep_lead}
      yes=${view ? texts.save : words.keep_yes}
      .words=${words}
      .called=${view}
      .save=${this.save}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    ></strata-naming-dialog>`;
  }

  private readonly save = async (called: Called, key: string): Promise<string> => {
    const { views } = this.session;
    try {
      if (this._base) await views.describe(this._base, called);
      else if (this._content) await views.keep(called, this._content, key);
    } catch (error) {
      const newest =
        error instanceof ApiError && error.status === 412 && this._base
          ? views.find(this._base.id)
          : null;
      if (!newest) throw error;
      this._base = newest;
      return words.changed(newest.name);
    }
    if (!this.view) notices.show("success", words.kept(called.name));
    return "";
  };
}
