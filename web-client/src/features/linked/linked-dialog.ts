// <strata-linked-dialog>: the stable addresses of the model for catalogs and viewers.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../ui/copy-field";
import "../../ui/dialog";
import { icon } from "../../ui/icons";
import { saveFrom } from "../../ui/save-from";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.linked_dialog;

/** Returns the address that stays the same when names change. */
export const linkedAddress = (model: number, part = ""): string => `/id/models/${model}${part}`;

@customElement("strata-linked-dialog")
export class StrataLinkedDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "session");
  }

  static override styles = [
    sharedStyles,
    css`
      .content,
      .group {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-4);
      }
      .group {
        gap: var(--space-2);
      }
      .group button,
      a {
        justify-self: start;
      }
    `,
  ];

  override render(): TemplateResult {
    const { model } = this.session;
    return html`<strata-dialog
      heading=${words.title}
      way_out=${texts.close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${model ? this.addresses(model.id, model.slug) : ""}
    </strata-dialog>`;
  }

  private addresses(id: number, slug: string): TemplateResult {
    const save = (): void => saveFrom(linkedAddress(id, "?f=turtle"), `${slug}.ttl`);
    return html`<div class="content">
      <p>${words.lead}</p>
      ${this.address(words.model, linkedAddress(id), words.model_hint)}
      ${this.address(words.manifest, linkedAddress(id, "/manifest"), words.manifest_hint)}
      ${this.address(words.annotations, linkedAddress(id, "/annotations"), words.annotations_hint)}
      ${this.address(words.catalog, "/id", words.catalog_hint)}
      <div class="group">
        <button type="button" @click=${save}>${icon("document")}${words.save}</button>
        <a target="_blank" rel="noopener" href=${linkedAddress(id, "?f=html")}>${words.show}</a>
      </div>
    </div>`;
  }

  private address(label: string, path: string, hint: string): TemplateResult {
    return html`<div class="group">
      <span class="caption">${label}</span>
      <strata-copy-field label=${label} .text=${location.origin + path}></strata-copy-field>
      <p class="hint">${hint}</p>
    </div>`;
  }
}
