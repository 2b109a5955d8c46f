// <strata-save-selection-dialog>: saves the current selection under a name, for this user or for
// everyone.

import { html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import type { Within } from "../../core/protocol.gen";
import type { ModelSession } from "../../session/model-session";
import { savedSelectionsOf } from "../../session/saved-selections-of";
import "../../ui/naming-dialog";
import type { Called } from "../../ui/naming-dialog";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";
import { selectionOf } from "./selection-of";

const words = texts.saved_selections;

@customElement("strata-save-selection-dialog")
export class StrataSaveSelectionDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  private _within: Within | null = null; // the selection when the dialog opened

  override connectedCallback(): void {
    super.connectedCallback();
    this._within = selectionOf(this.session).within;
  }

  override render(): TemplateResult {
    return html`<strata-naming-dialog
      aside
      heading=${words.save_title}
      lead=${words.save_lead}
      yes=${texts.save}
      .words=${words.fields}
      .option=${{ label: words.for_everyone, hint: words.for_everyone_hint, checked: false }}
      .save=${this.save}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    ></strata-naming-dialog>`;
  }

  private readonly save = async (
    called: Called,
    key: string,
    everyone: boolean,
  ): Promise<string> => {
    const within = this._within;
    if (!within) return texts.selection.nothing;
    const audience = everyone ? "everyone" : "personal";
    await savedSelectionsOf(this.session).create({ ...called, audience, within }, key);
    notices.show("success", words.kept(called.name));
    return "";
  };
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-save-selection-dialog": StrataSaveSelectionDialog;
  }
}
