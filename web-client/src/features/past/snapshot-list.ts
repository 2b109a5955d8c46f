// <strata-snapshot-list>: the snapshots of the model, each with a button that shows its state. Part
// of the history.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { Snapshot } from "../../core/protocol.gen";
import { toldTime } from "../../domain/times";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { ask } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import "../../ui/naming-dialog";
import type { Called } from "../../ui/naming-dialog";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { Snapshots } from "./snapshots";

const words = texts.snapshots;

@customElement("strata-snapshot-list")
export class StrataSnapshotList extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The same object after each change, so Lit cannot detect changes by comparison. */
  @property({ attribute: false, hasChanged: () => true }) snapshots!: Snapshots;
  /** The snapshot that the user is naming; "new" for the displayed state. */
  @state() private _naming: Snapshot | "new" | null = null;
  private _at: number | null = null; // the state that the user is naming

  constructor() {
    super();
    followSession(this, "past", "saving");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-1);
        max-height: min(14rem, 34dvh);
        padding: var(--space-2);
        overflow-y: auto;
        border-radius: var(--radius-small);
        background: var(--paper);
      }
      p {
        margin: 0;
      }
      ul {
        display: grid;
        grid-template-columns: repeat(auto-fill, minmax(min(100%, 19rem), 1fr));
        gap: var(--space-1);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: flex;
        align-items: center;
        min-width: 0;
        border-radius: var(--radius-small);
      }
      li:has([aria-current="true"]) {
        background: var(--accent-soft);
      }
      .go {
        display: grid;
        flex: 1;
        justify-content: start;
        justify-items: start;
        gap: 0;
        min-width: 0;
        padding: var(--space-1) var(--space-2);
        text-align: start;
      }
      .go > * {
        max-width: 100%;
      }
      small {
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session, snapshots } = this;
    return html`${
      session.canPaint
        ? html`<div><button @click=${() => this.name("new")}>${icon("plus")}${session.past.isActive ? words.name_then : words.name_now}</button></div>`
        : nothing
    }
      ${
        snapshots.failed
          ? html`<p class="error" role="alert">${words.failed}</p>
            <div><button @click=${() => void snapshots.load()}>${texts.try_again}</button></div>`
          : !snapshots.loaded
            ? html`<p class="hint" role="status">${texts.loading}</p>`
            : snapshots.all.length === 0
              ? html`<p class="hint">${words.none}</p>`
              : html`<ul aria-label=${words.title}>
                ${repeat(
                  snapshots.all,
                  ({ id }) => id,
                  (snapshot) => this.row(snapshot),
                )}
              </ul>`
      }
      ${this._naming ? this.dialog(this._naming) : nothing}`;
  }

  private row(snapshot: Snapshot): TemplateResult {
    const { session, snapshots } = this;
    const { past } = session;
    const mayChange = session.canPaint && snapshots.mayChange(snapshot);
    const time =
      snapshot.state_time === undefined ? texts.past.before_first : toldTime(snapshot.state_time);
    return html`<li>
      <button class="quiet go" data-snapshot=${snapshot.id} aria-current=${past.at === snapshot.sequence} title=${snapshot.text || nothing} @click=${() => past.goTo(snapshot.sequence)}>
        <b class="ellipsis">${snapshot.name}</b>
        <small class="ellipsis">${[time, snapshot.text].filter(Boolean).join(" · ")}</small>
      </button>
      <strata-menu label=${texts.layers.options(snapshot.name)}>
        <button class="quiet" role="menuitem" @click=${() => void past.compareWith(snapshot.sequence)}>${icon("swipe")}${words.compare}</button>
        ${
          mayChange
            ? html`<button class="quiet" role="menuitem" @click=${() => this.name(snapshot)}>${icon("edit")}${words.rename}</button>
              <hr />
              <button class="quiet" role="menuitem" @click=${() => void this.delete(snapshot)}>${icon("trash")}${texts.layers.delete}</button>`
            : nothing
        }
      </strata-menu>
    </li>`;
  }

  private dialog(naming: Snapshot | "new"): TemplateResult {
    const isNew = naming === "new";
    return html`<strata-naming-dialog
      heading=${isNew ? words.new_title : words.rename_title}
      lead=${isNew ? words.new_lead : ""}
      yes=${isNew ? words.save : texts.save}
      .words=${words.fields}
      .called=${isNew ? null : naming}
      .save=${async (called: Called, key: string): Promise<string> => {
        await (isNew
          ? this.snapshots.create(called, this._at, key)
          : this.snapshots.rename(naming, called));
        return "";
      }}
      @closed=${() => (this._naming = null)}
    ></strata-naming-dialog>`;
  }

  private name(what: Snapshot | "new"): void {
    const { session } = this;
    if (what === "new" && !session.past.isActive && session.saving.waiting > 0) {
      notices.show("info", texts.past.saving_first);
      return;
    }
    this._at = session.past.at;
    this._naming = what;
  }

  private async delete(snapshot: Snapshot): Promise<void> {
    const question = {
      heading: words.delete_title(snapshot.name),
      lead: words.delete_lead,
      yes: texts.delete,
      danger: true,
    };
    if (await ask(question))
      this.snapshots.remove(snapshot).catch((error: unknown) => notices.error(error));
  }
}
