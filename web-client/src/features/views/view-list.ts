// <strata-view-list>: the saved views of the model, each with a button that applies it. Part of the
// view panel.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { View } from "../../core/protocol.gen";
import { copyText } from "../../ui/copy-field";
import { ask } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/panel/empty-state";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { listHeadStyles, listRowStyles } from "../../ui/panel/panel-styles";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";
import type { ViewRequest } from "../../session/requests";

const words = texts.kept_views;
const kAtOnce = 50;

@customElement("strata-view-list")
export class StrataViewList extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _most = kAtOnce;

  constructor() {
    super();
    followSession(this, "views", "view", "layers", "appearance");
  }

  static override styles = [
    sharedStyles,
    listHeadStyles,
    listRowStyles,
    css`
      button.go {
        grid-template-columns: 4rem minmax(0, 1fr);
        align-items: start;
        gap: var(--space-2);
      }
      ul {
        margin: 0;
      }
      li {
        border-radius: var(--radius-small);
      }
      li:has(> .go[aria-current="true"]) {
        background: var(--accent-soft);
      }
      /* no background under the pointer either, because text is hard to read on two tints */
      li button.go[aria-current="true"]:not(:disabled) {
        background: none;
      }
      strata-thumbnail {
        border-radius: var(--radius-tiny);
      }
      .words {
        display: grid;
        gap: var(--space-half);
      }
      button.go .hint {
        display: -webkit-box;
        -webkit-box-orient: vertical;
        -webkit-line-clamp: 2;
        overflow: hidden;
        overflow-wrap: anywhere;
        unicode-bidi: plaintext;
      }
      button.go[aria-current="true"] .hint {
        -webkit-line-clamp: 12;
        white-space: pre-line;
      }
      .back {
        position: sticky;
        bottom: 0;
        padding: var(--space-half) 0;
        background: var(--surface);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const { views } = session;
    return html`<div class="row">
        <h3>${words.title}</h3>
        ${session.canPaint ? html`<button class="quiet" @click=${() => this.request(null)}>${icon("plus")}${words.keep}</button>` : nothing}
      </div>
      ${views.failed ? this.failure() : this.list()}
      ${views.leadsBack ? html`<div class="back"><button class="link" @click=${() => views.goBack()}>${words.back}</button></div>` : nothing}`;
  }

  private failure(): TemplateResult {
    return html`<p class="error" role="alert">${words.failed}</p>
      <div><button @click=${() => void this.session.views.load()}>${texts.try_again}</button></div>`;
  }

  private list(): TemplateResult {
    const { views, canPaint } = this.session;
    const { all, current } = views;
    if (!views.loaded) return html`<p class="hint">${texts.loading}</p>`;
    if (all.length === 0)
      return html`<strata-empty line=${words.none} more=${canPaint ? words.none_more : words.none_viewer}></strata-empty>`;
    return html`<ul>
        ${repeat(
          all.slice(0, this._most),
          ({ id }) => id,
          (view) => this.row(view, view === current),
        )}
      </ul>
      ${all.length > this._most ? html`<button @click=${() => (this._most += kAtOnce)}>${words.more(all.length - this._most)}</button>` : nothing}`;
  }

  private row(view: View, isCurrent: boolean): TemplateResult {
    const { api, model, views, canPaint } = this.session;
    const mayChange = canPaint && views.mayChange(view);
    return html`<li>
      <button class="quiet go" data-view=${view.id} aria-current=${isCurrent} title=${view.text || nothing} @click=${() => views.goTo(view)}>
        ${model ? html`<strata-thumbnail .api=${api} .model=${model} .view=${view}></strata-thumbnail>` : nothing}
        <span class="words">
          <b>${view.name}</b>
          ${view.text ? html`<span class="hint">${view.text}</span>` : nothing}
        </span>
      </button>
      <strata-menu label=${texts.layers.options(view.name)}>
        <button class="quiet" role="menuitem" @click=${() => void this.copyLink(view)}>${icon("link")}${words.copy_link}</button>
        <button class="quiet" role="menuitem" @click=${() => this.request(view, "figure")}>${icon("measure")}${texts.figures.of_view}</button>
        ${
          mayChange
            ? html`<button class="quiet" role="menuitem" @click=${() => this.request(view)}>${icon("edit")}${words.describe}</button>
              <button class="quiet" role="menuitem" @click=${() => this.change(views.replace(view))}>${icon("eye")}${words.replace}</button>
              <hr />
              <button class="quiet" role="menuitem" @click=${() => void this.deleteView(view)}>${icon("trash")}${texts.layers.delete}</button>`
            : nothing
        }
      </strata-menu>
    </li>`;
  }

  private request(view: View | null, dialog: ViewRequest["dialog"] = "view"): void {
    this.dispatchEvent(new CustomEvent<ViewRequest>("request", { detail: { dialog, view } }));
  }

  private async copyLink(view: View): Promise<void> {
    const link = this.session.views.linkTo(view);
    if (await copyText(link, () => selectHidden(link))) notices.show("success", words.copied, link);
    else notices.show("info", words.copy_by_hand, link);
  }

  private async deleteView(view: View): Promise<void> {
    const question = {
      heading: words.delete_title(view.name),
      lead: words.delete_lead,
      yes: texts.delete,
      danger: true,
    };
    if (await ask(question)) this.change(this.session.views.remove(view));
  }

  private change(work: Promise<void>): void {
    work.catch((error: unknown) => notices.error(error));
  }
}

/**
 * Selects a text that is not visible on the page, and keeps the keyboard focus. Returns a function
 * that removes the selection.
 */
function selectHidden(text: string): () => void {
  const span = document.createElement("span");
  span.textContent = text;
  Object.assign(span.style, { position: "fixed", clipPath: "inset(50%)" });
  document.body.append(span);
  getSelection()?.selectAllChildren(span);
  return () => span.remove();
}
