// <strata-bill-tree>: the groups and positions of a bill. Arrow keys move the selection and open or
// close groups. Events: "choose" with the index of the selected item, "open" after a click on it,
// "edit", "insert" and "remove".

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { BillItem, BillQuantities } from "../../core/protocol.gen";
import { isGroup, levelOf, parentOf, shownDecimal, visibleItems } from "../../domain/bills";
import { icon } from "../../ui/icons";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.bills;

@customElement("strata-bill-tree")
export class StrataBillTree extends LitElement {
  @property({ attribute: false }) items: readonly BillItem[] = [];
  @property({ attribute: false }) chosen: number | null = null;
  @property({ attribute: false }) quantities: BillQuantities | null = null;
  /** Whether the quantities are out of date. */
  @property({ type: Boolean }) stale = false;
  @state() private _collapsed: ReadonlySet<string> = new Set();

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        min-width: 0;
      }
      .item {
        display: grid;
        grid-template-columns: 1.25rem minmax(0, 1fr) auto;
        gap: 0 var(--space-1);
        padding: var(--space-1) var(--space-2) var(--space-1)
          calc(var(--space-1) + (var(--level) - 1) * var(--space-3));
        border-radius: var(--radius-small);
        cursor: pointer;
        scroll-margin: var(--space-2);
        content-visibility: auto;
        contain-intrinsic-size: auto 2.75rem;
      }
      .item:hover {
        background: var(--hover);
      }
      .item[aria-selected="true"] {
        background: var(--accent-soft);
        box-shadow: inset 3px 0 0 var(--accent);
      }
      .item:focus-visible {
        outline-offset: -2px;
      }
      .number {
        font: var(--text-tiny) var(--mono);
        color: var(--ink-soft);
      }
      .item[aria-selected="true"] .number,
      .item[aria-selected="true"] .sum {
        color: var(--ink);
      }
      .name {
        display: grid;
        min-width: 0;
      }
      .group .text {
        font-weight: 600;
      }
      .text {
        overflow-wrap: anywhere;
        font-size: var(--text-small);
      }
      .sum {
        align-self: end;
        font-size: var(--text-small);
        white-space: nowrap;
      }
      .sum.stale {
        color: var(--ink-soft);
      }
      .turn {
        display: grid;
        place-items: center;
        color: var(--ink-soft);
      }
      .turn svg.glyph {
        width: 1rem;
        height: 1rem;
        transition: rotate var(--fast);
      }
      [aria-expanded="true"] .turn svg.glyph {
        rotate: 90deg;
      }
    `,
  ];

  override render(): TemplateResult {
    const visible = visibleItems(this.items, this._collapsed);
    const stop = this.chosen !== null && visible.includes(this.chosen) ? this.chosen : visible[0];
    const sums = new Map(
      this.quantities?.positions.map(({ number, quantity }) => [number, quantity]) ?? [],
    );
    return html`<div role="tree" aria-label=${words.items} @keydown=${this.onKey}>
      ${visible.map((index) => this.row(this.items[index]!, index, index === stop, sums))}
    </div>`;
  }

  private row(
    item: BillItem,
    index: number,
    isStop: boolean,
    sums: ReadonlyMap<string, string>,
  ): TemplateResult {
    const group = isGroup(item);
    const sum = sums.get(item.number);
    return html`<div
      class="item ${group ? "group" : ""}"
      role="treeitem"
      data-index=${index}
      ${styled({ "--level": levelOf(item.number) })}
      tabindex=${isStop ? 0 : -1}
      aria-level=${levelOf(item.number)}
      aria-selected=${index === this.chosen}
      aria-expanded=${group ? String(!this._collapsed.has(item.number)) : nothing}
      @click=${() => {
        this.choose(index);
        this.tell("open");
      }}
      @dblclick=${() => this.tell("edit")}
    >
      <span class="turn" @click=${(event: Event) => group && this.onTurn(event, item.number)}>${group ? icon("chevron") : nothing}</span>
      <span class="name">
        <span class="number">${item.number}</span>
        <span class="text">${item.short_text || texts.unnamed}</span>
      </span>
      ${
        group
          ? html`<span></span>`
          : html`<span class="sum ${this.stale ? "stale" : ""}">${sum === undefined ? "" : shownDecimal(sum)} ${item.unit ?? ""}</span>`
      }
    </div>`;
  }

  private onTurn(event: Event, number: string): void {
    event.stopPropagation();
    this.collapse(number, !this._collapsed.has(number));
  }

  private collapse(number: string, collapsed: boolean): void {
    const next = new Set(this._collapsed);
    if (collapsed) next.add(number);
    else next.delete(number);
    this._collapsed = next;
  }

  private tell(name: "open" | "edit" | "insert" | "remove"): void {
    this.dispatchEvent(new CustomEvent(name));
  }

  private choose(index: number): void {
    this.dispatchEvent(new CustomEvent("choose", { detail: index }));
  }

  private readonly onKey = (event: KeyboardEvent): void => {
    const handled = this.onPlainKey(event);
    if (!handled) return;
    event.preventDefault();
    event.stopPropagation();
  };

  /** Returns whether the key has an effect. */
  private onPlainKey({ key, ctrlKey, metaKey, altKey }: KeyboardEvent): boolean {
    if (ctrlKey || metaKey || altKey) return false;
    const visible = visibleItems(this.items, this._collapsed);
    const at = visible.indexOf(this.chosen ?? -1);
    const move = (to: number | undefined): boolean => {
      if (to === undefined) return false;
      this.choose(to);
      void this.updateComplete.then(() => this.focusChosen());
      return true;
    };
    const item = this.chosen === null ? undefined : this.items[this.chosen];
    switch (key) {
      case "ArrowDown":
        return move(visible[at + 1]);
      case "ArrowUp":
        return move(visible[Math.max(0, at - 1)]);
      case "Home":
        return move(visible[0]);
      case "End":
        return move(visible.at(-1));
      case "ArrowRight":
        if (!item || !isGroup(item)) return false;
        if (!this._collapsed.has(item.number)) return move(visible[at + 1]);
        this.collapse(item.number, false);
        return true;
      case "ArrowLeft":
        if (!item) return false;
        if (isGroup(item) && !this._collapsed.has(item.number)) {
          this.collapse(item.number, true);
          return true;
        }
        return move(visible.find((index) => this.items[index]!.number === parentOf(item.number)));
      case "Enter":
      case "F2":
        this.tell("edit");
        return item !== undefined;
      case "Insert":
        this.tell("insert");
        return true;
      case "Delete":
        this.tell("remove");
        return item !== undefined;
      default:
        return false;
    }
  }

  /** Moves the focus to the selected item, and scrolls to it. */
  focusChosen(): void {
    const row = this.renderRoot.querySelector<HTMLElement>(`[data-index="${this.chosen}"]`);
    row?.focus();
    row?.scrollIntoView({ block: "nearest" });
  }
}
