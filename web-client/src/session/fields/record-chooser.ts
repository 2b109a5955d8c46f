// <strata-record-chooser>: chooses one or several records of a table by their names. Terms are
// listed in the order of their term list, indented by depth.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { live } from "lit/directives/live.js";
import { followSession } from "../follow-session";
import { icon } from "../../ui/icons";
import { arrowStep } from "../../ui/keyboard";
import type { ModelSession } from "../model-session";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { termsWith } from "./term-rows";
import type { TermTree } from "./term-tree";
import { texts } from "../../texts";

/** A record that can be chosen. */
interface Option {
  key: number;
  label: string;
  depth: number; // depth in the tree
  match: boolean; // false: it is only the parent of a match
}

const kIndentPx = 16;

@customElement("strata-record-chooser")
export class StrataRecordChooser extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The id of the table. */
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) chosen: readonly number[] = [];
  @property({ type: Boolean }) multiple = false;
  @property() label = "";
  @property({ type: Boolean }) invalid = false;
  /** A key that cannot be chosen. */
  @property({ attribute: false }) without: number | null = null;
  @state() private _text = "";
  @state() private _open = false;
  @state() private _at = -1; // index in the list
  @query("input") private _input!: HTMLInputElement;
  @query(".list") private _list!: HTMLElement;

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  constructor() {
    super();
    followSession(this, "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        min-width: 0;
      }
      .field {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-1);
        min-height: 38px;
        padding: var(--space-1) var(--space-1);
        border: var(--edge) solid var(--line-strong);
        border-radius: var(--radius-small);
        background: var(--field);
      }
      .field:focus-within {
        outline: var(--focus);
      }
      .field.invalid {
        border-color: var(--danger);
      }
      :host(.in-cell) .field {
        min-height: 28px;
        padding: var(--space-half) var(--space-1);
      }
      input[type="text"] {
        flex: 1;
        width: 70px;
        min-width: 70px;
        min-height: 24px;
        padding: 0 var(--space-1);
        border: 0;
        outline: 0;
        background: none;
      }
      .chip {
        display: inline-flex;
        align-items: center;
        max-width: 100%;
        min-width: 0;
        padding-left: var(--space-2);
        border-radius: var(--radius-round);
        background: var(--accent-soft);
        font-size: var(--text-small);
      }
      .chip .ellipsis {
        min-width: 0;
      }
      .chip button {
        display: grid;
        place-items: center;
        flex: none;
        width: 24px;
        min-height: 24px;
        padding: 0;
        border: 0;
        background: none;
      }
      .chip svg.glyph {
        width: 13px;
        height: 13px;
      }
      .list {
        position: fixed;
        inset: auto;
        margin: 0;
        padding: var(--space-1);
        max-height: 260px;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--raised);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      .option {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-height: 30px;
        padding: var(--space-half) var(--space-2);
        border-radius: var(--radius-tiny);
        cursor: pointer;
        font-size: var(--text-small);
      }
      .option.at {
        background: var(--accent-soft);
      }
      .option .key {
        margin-left: auto;
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
      .option.above-found {
        color: var(--ink-soft);
      }
      .option svg.glyph {
        width: 15px;
        height: 15px;
        color: var(--accent);
      }
      .list .hint {
        padding: var(--space-1) var(--space-2);
      }
    `,
  ];

  /**
   * The terms of the list. Null if the table is not a term list, or if it has too many terms to
   * load.
   */
  private get terms(): TermTree | null {
    const terms = this.session.tables.terms(this.table);
    terms?.want();
    return terms?.loaded && terms.terms.length === terms.total ? terms : null;
  }

  private get found(): Option[] {
    const terms = this.terms;
    const found = terms
      ? termsWith(terms.terms, this._text).map(({ key, name, depth, match }) => ({
          key,
          label: name,
          depth,
          match,
        }))
      : (this.session.tables.names(this.table)?.search(this._text) ?? []).map((named) => ({
          ...named,
          depth: 0,
          match: true,
        }));
    return found.filter(({ key }) => key !== this.without);
  }

  /** Selects the first match for Enter, because records may be loaded after the user has typed. */
  override willUpdate(): void {
    if (this._open && this._text !== "" && this._at < 0)
      this._at = this.found.findIndex(({ match }) => match);
  }

  override render(): TemplateResult {
    const words = texts.tables;
    const found = this._open ? this.found : [];
    const names = this.session.tables.names(this.table);
    const tree = this.terms !== null;
    return html`<div class="field ${this.invalid ? "invalid" : ""}" @click=${this.onField}>
        ${this.chosen.map(
          (key) =>
            html`<span class="chip"
              ><span class="ellipsis">${this.session.tables.label(this.table, key) ?? words.record(key)}</span>
              <button type="button" tabindex="-1" aria-label=${words.take_out(this.nameOf(key))} @click=${() => this.toggle(key)}>${icon("close")}</button></span
            >`,
        )}
        <input
          type="text"
          role="combobox"
          aria-label=${this.label}
          aria-expanded=${this._open}
          aria-controls="list"
          aria-autocomplete="list"
          aria-activedescendant=${this._at >= 0 && found[this._at] ? `option-${this._at}` : nothing}
          autocomplete="off"
          placeholder=${this.chosen.length > 0 ? "" : this.session.tables.terms(this.table) ? texts.terms.search : words.search_records}
          .value=${live(this._text)}
          @input=${this.onInput}
          @blur=${this.hide}
          @keydown=${this.onKey}
        />
      </div>
      <div class="list" id="list" popover="manual" role="listbox" aria-label=${this.label} aria-multiselectable=${this.multiple} @pointerdown=${keepFocus}>
        ${found.map(
          ({ key, label, depth, match }, index) =>
            html`<div
              class="option ${index === this._at ? "at" : ""} ${match ? "" : "above-found"}"
              id="option-${index}"
              role="option"
              aria-selected=${this.chosen.includes(key)}
              ${styled({ "padding-left": depth > 0 ? `${8 + depth * kIndentPx}px` : null })}
              @click=${() => this.take(key)}
            >
              <span class="ellipsis">${label || words.record(key)}</span>
              ${this.chosen.includes(key) ? icon("check") : nothing}${tree ? nothing : html`<span class="key">${key}</span>`}
            </div>`,
        )}
        ${found.length === 0 ? html`<p class="hint">${names && !names.loading ? words.none_found : texts.loading}</p>` : nothing}
      </div>`;
  }

  private nameOf(key: number): string {
    return this.session.tables.label(this.table, key) ?? texts.tables.record(key);
  }

  private onInput(): void {
    this._text = this._input.value;
    this._at = this._text === "" ? -1 : this.found.findIndex(({ match }) => match);
    this.show();
  }

  /**
   * Opens the list when the user clicks on the field, but not when the form focuses its first
   * field.
   */
  private onField(event: Event): void {
    const onChip = event.composedPath().some((each) => each instanceof HTMLButtonElement);
    this._input.focus();
    if (!onChip) this.show();
  }

  /** Opens the list of records. */
  open(): void {
    this.show();
  }

  private readonly show = (): void => {
    this._open = true;
    if (!this._list.matches(":popover-open")) this._list.showPopover();
    const anchor = this.getBoundingClientRect();
    const { style } = this._list;
    style.width = `${Math.max(220, anchor.width)}px`;
    style.left = `${Math.max(8, Math.min(anchor.left, innerWidth - Math.max(220, anchor.width) - 8))}px`;
    const below = innerHeight - anchor.bottom > 280 || anchor.top < 280;
    style.top = below ? `${anchor.bottom + 3}px` : "auto";
    style.bottom = below ? "auto" : `${innerHeight - anchor.top + 3}px`;
  };

  private readonly hide = (): void => {
    this._open = false;
    this._at = -1;
    if (this._list.matches(":popover-open")) this._list.hidePopover();
  };

  /**
   * Handles a key. Other elements receive all keys that this element does not use. For example,
   * Enter without a match applies the whole field.
   */
  private onKey(event: KeyboardEvent): void {
    const { found } = this;
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      this.show();
      this._at =
        this._at < 0
          ? event.key === "ArrowDown"
            ? 0
            : found.length - 1
          : (arrowStep(event.key, this._at, found.length) ?? -1);
      void this.updateComplete.then(() =>
        this._list.querySelector(".at")?.scrollIntoView({ block: "nearest" }),
      );
    } else if (event.key === "Enter" && this._open && found[this._at]) {
      this.take(found[this._at]!.key);
    } else if (event.key === "Backspace" && this._text === "" && this.chosen.length > 0) {
      this.toggle(this.chosen[this.chosen.length - 1]!);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private take(key: number): void {
    this._text = "";
    this._at = -1;
    this.toggle(key);
  }

  private toggle(key: number): void {
    const had = this.chosen.includes(key);
    const others = this.multiple ? this.chosen.filter((each) => each !== key) : [];
    this.chosen = had ? others : [...others, key];
    this.dispatchEvent(new CustomEvent("chosen", { detail: this.chosen }));
    if (!this.multiple) this.hide();
    else void this.updateComplete.then(() => this._open && this.show()); // the field may have grown
  }
}

/** Keeps the focus in the field when the user clicks on the list. */
const keepFocus = (event: Event): void => event.preventDefault();
