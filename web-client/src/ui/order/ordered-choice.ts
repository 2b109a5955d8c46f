// <strata-ordered-choice>: a choice of items in an order that the user sets. The owner can provide
// further content for each item.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { moved } from "../../domain/tours";
import { addFrom, addFromStyles } from "../add-from";
import { icon } from "../icons";
import { OrderButtons } from "./order-buttons";
import { sharedStyles } from "../styles";
import { texts } from "../../texts";

export interface OrderedThing {
  value: string;
  name: string;
  badge?: unknown;
}

const words = texts.ordered_choice;

@customElement("strata-ordered-choice")
export class StrataOrderedChoice extends LitElement {
  @property() label = "";
  /** The text of the button. */
  @property({ attribute: "add_label" }) addLabel = "";
  @property({ attribute: false }) things: readonly OrderedThing[] = [];
  @property({ attribute: false }) chosen: readonly string[] = [];
  @property({ type: Number }) most = Infinity;
  /** The values with a problem. */
  @property({ attribute: false }) wrong: readonly string[] = [];
  /** Returns the content below the name of a chosen item. */
  @property({ attribute: false }) more: ((value: string) => unknown) | null = null;
  private readonly _order = new OrderButtons(this);

  static override styles = [
    sharedStyles,
    addFromStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr); /* narrower than the longest name of a choice */
        gap: var(--space-2);
        min-width: 0;
      }
      ol {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-1);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: minmax(0, 1fr) auto;
        align-items: center;
        gap: var(--space-half) var(--space-2);
        padding: var(--space-half) var(--space-half) var(--space-half) var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--raised);
      }
      li.wrong {
        border-color: var(--danger);
      }
      .name {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
        font-size: var(--text-body);
        overflow-wrap: anywhere;
      }
      .buttons {
        display: flex;
      }
      .buttons button.icon {
        width: 2rem;
        min-height: 2rem;
      }
      .seen-by {
        display: grid;
        color: var(--ink-soft);
      }
      .more {
        grid-column: 1 / -1;
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(min(100%, 9.375rem), 1fr));
        gap: var(--space-2);
        padding: 0 var(--space-2) var(--space-2) 0;
      }
      .more input[type="text"] {
        min-height: 2.125rem;
        font-size: var(--text-small);
      }
      @media (pointer: coarse) {
        .buttons button.icon {
          width: 2.5rem;
          min-height: var(--control-touch);
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { chosen, things } = this;
    const others = things.filter(({ value }) => !chosen.includes(value));
    return html`${
      chosen.length === 0
        ? nothing
        : html`<ol aria-label=${this.label}>
            ${repeat(
              chosen,
              (value) => value,
              (value, index) => this.row(value, index),
            )}
          </ol>`
    }
      ${
        others.length > 0 && chosen.length < this.most
          ? addFrom(this.addLabel, others, (value) => this.put([...chosen, value]))
          : nothing
      }`;
  }

  private row(value: string, index: number): TemplateResult {
    const { chosen } = this;
    const thing = this.things.find((each) => each.value === value);
    const name = thing?.name ?? words.gone(value);
    const more = this.more?.(value);
    return html`<li class=${this.wrong.includes(value) ? "wrong" : ""}>
      <span class="name">${name}${thing?.badge ?? nothing}</span>
      <span class="buttons">
        ${
          chosen.length > 1
            ? this._order.buttons({ id: value, name, index, count: chosen.length }, (to) =>
                this.put(moved(chosen, index, to)),
              )
            : nothing
        }
        <button type="button" class="icon quiet" aria-label=${words.remove(name)} title=${words.remove(name)} @click=${() => this.put(chosen.filter((each) => each !== value))}>${icon("close")}</button>
      </span>
      ${more ? html`<div class="more">${more}</div>` : nothing}
    </li>`;
  }

  private put(chosen: readonly string[]): void {
    this.dispatchEvent(new CustomEvent<readonly string[]>("chosen", { detail: chosen }));
  }
}
