// <strata-selections-dialog>: the saved selections of the model. A click loads one, as the next part
// of the selection, and closes the dialog.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { SavedSelection } from "../../core/protocol.gen";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import type { SelectionRequest } from "../../session/requests";
import { savedSelectionsOf } from "../../session/saved-selections-of";
import { ask, type StrataDialog } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import "../../ui/naming-dialog";
import type { Called } from "../../ui/naming-dialog";
import { notices } from "../../ui/notices";
import { listRowStyles } from "../../ui/panel/panel-styles";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { selectionOf } from "./selection-of";

const words = texts.saved_selections;
const kAtOnce = 50;

@customElement("strata-selections-dialog")
export class StrataSelectionsDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _most = kAtOnce;
  @state() private _renamed: SavedSelection | null = null;
  @query("strata-dialog") private _dialog!: StrataDialog;

  constructor() {
    super();
    followSession(this, "painting");
  }

  static override styles = [
    sharedStyles,
    listRowStyles,
    css`
      ul {
        display: grid;
        gap: var(--space-half);
        margin-block: 0;
        padding: 0;
        list-style: none;
      }
      .go {
        display: grid;
        justify-items: start;
        gap: 0;
      }
      .go > * {
        max-width: 100%;
      }
      small {
        color: var(--ink-soft);
        font-size: var(--text-tiny);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void savedSelectionsOf(this.session).load();
  }

  override render(): TemplateResult {
    const { session } = this;
    const empty = selectionOf(session).isEmpty;
    return html`<strata-dialog docked heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
        ${this.list()}
        ${empty || !session.canPaint ? nothing : html`<button slot="actions" @click=${this.save}>${icon("plus")}${texts.selection.save}</button>`}
      </strata-dialog>
      ${this._renamed ? this.naming(this._renamed) : nothing}`;
  }

  private list(): TemplateResult {
    const saved = savedSelectionsOf(this.session);
    if (saved.failed)
      return html`<p class="error" role="alert">${words.failed}</p>
        <div><button @click=${() => void saved.load()}>${texts.try_again}</button></div>`;
    if (!saved.loaded) return html`<p class="hint" role="status">${texts.loading}</p>`;
    const { all } = saved;
    if (all.length === 0) return html`<p class="hint">${words.none}</p>`;
    return html`<p class="hint">${words.lead}</p>
      <ul aria-label=${words.title}>
        ${repeat(
          all.slice(0, this._most),
          ({ id }) => id,
          (each) => this.row(each),
        )}
      </ul>
      ${all.length > this._most ? html`<button @click=${() => (this._most += kAtOnce)}>${words.show_more(all.length - this._most)}</button>` : nothing}`;
  }

  private row(saved: SavedSelection): TemplateResult {
    const { session } = this;
    const mayChange = session.canPaint && savedSelectionsOf(session).mayChange(saved);
    const details = saved.within ? words.audiences[saved.audience] : words.unusable;
    return html`<li>
      <button class="quiet go" data-selection=${saved.id} title=${saved.text || nothing} ?disabled=${!saved.within} @click=${(event: MouseEvent) => this.take(saved, event)}>
        <b class="ellipsis">${saved.name}</b>
        <small class="ellipsis">${[details, saved.text].filter(Boolean).join(" · ")}</small>
      </button>
      ${mayChange ? this.menu(saved) : nothing}
    </li>`;
  }

  private menu(saved: SavedSelection): TemplateResult {
    const everyone = saved.audience === "everyone";
    const audience = everyone ? "personal" : "everyone";
    return html`<strata-menu label=${texts.layers.options(saved.name)}>
      <button class="quiet" role="menuitem" @click=${() => (this._renamed = saved)}>${icon("edit")}${words.rename}</button>
      <button class="quiet" role="menuitem" ?disabled=${selectionOf(this.session).isEmpty} @click=${() => this.report(this.replace(saved))}>${icon("check")}${words.replace}</button>
      <button class="quiet" role="menuitem" @click=${() => this.report(savedSelectionsOf(this.session).change(saved, { audience }))}>${icon(everyone ? "eye_off" : "eye")}${words.make[audience]}</button>
      <hr />
      <button class="quiet" role="menuitem" @click=${() => void this.delete(saved)}>${icon("trash")}${texts.layers.delete}</button>
    </strata-menu>`;
  }

  private naming(saved: SavedSelection): TemplateResult {
    return html`<strata-naming-dialog
      heading=${words.rename_title(saved.name)}
      yes=${texts.save}
      .words=${words.fields}
      .called=${saved}
      .save=${async (called: Called): Promise<string> => {
        await savedSelectionsOf(this.session).change(saved, called);
        return "";
      }}
      @closed=${() => (this._renamed = null)}
    ></strata-naming-dialog>`;
  }

  private take({ within }: SavedSelection, { shiftKey, altKey }: MouseEvent): void {
    if (!within) return;
    selectionOf(this.session).addSaved(within, { shift: shiftKey, alt: altKey });
    this._dialog.close();
  }

  private save(): void {
    this.dispatchEvent(
      new CustomEvent<SelectionRequest>("request", { detail: { dialog: "save-selection" } }),
    );
  }

  /** Saves the current selection under the existing name. The notice can restore the old one. */
  private async replace(saved: SavedSelection): Promise<void> {
    const { within } = selectionOf(this.session);
    if (!within) return;
    const list = savedSelectionsOf(this.session);
    const changed = await list.change(saved, { within });
    const { within: before } = saved;
    const undo = before && {
      label: words.undo,
      act: (): void => this.report(list.change(changed, { within: before })),
    };
    notices.show("success", words.replaced(saved.name), "", undo);
  }

  private async delete(saved: SavedSelection): Promise<void> {
    const question = {
      heading: words.delete_title(saved.name),
      lead: words.delete_lead[saved.audience],
      yes: texts.delete,
      danger: true,
    };
    if (await ask(question)) this.report(savedSelectionsOf(this.session).remove(saved));
  }

  private report(work: Promise<unknown>): void {
    work.catch((error: unknown) => notices.error(error));
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-selections-dialog": StrataSelectionsDialog;
  }
}
