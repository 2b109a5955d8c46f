// <strata-selection-panel>: the keys of the selection, and the saved selections, in the options of
// polygon, lasso, wand and strokes. While an area is selected, also the values of the layer inside
// it.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import type { SelectionRequest } from "../../session/requests";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { selectionFacts, selectionFactStyles } from "./selection-facts";
import { selectionOf } from "./selection-of";

const words = texts.selection;

@customElement("strata-selection-panel")
export class StrataSelectionPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "tools", "layers", "tables");
  }

  static override styles = [sharedStyles, selectionFactStyles];

  override render(): TemplateResult {
    const { session } = this;
    const { measured } = selectionOf(session);
    const layer = session.layers.selected;
    const { keys } = session.tools.active === "strokes" ? texts.strokes : words;
    return html`${measured && layer ? selectionFacts(session, layer, measured) : nothing}
      <p class="hint">${keys}</p>
      <button class="quiet" @click=${this.showSaved}>${icon("layers")}${words.saved}</button>`;
  }

  private showSaved(): void {
    this.dispatchEvent(
      new CustomEvent<SelectionRequest>("request", {
        detail: { dialog: "selections" },
        bubbles: true,
        composed: true,
      }),
    );
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-selection-panel": StrataSelectionPanel;
  }
}
