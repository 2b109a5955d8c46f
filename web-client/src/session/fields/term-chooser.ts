// <strata-term-chooser>: chooses the term to paint, in a tree with search and keyboard control. The
// terms have the same colors as on the model.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { live } from "lit/directives/live.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import { colorOf, pointOf, swatchStyle } from "../../domain/palette";
import type { ListedTerm, TermTree as FoundTerms } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { followSession } from "../follow-session";
import { growth } from "../../ui/growth";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../model-session";
import { hasFingers } from "../../ui/pointers";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { foldedAtFirst, pathTo, rowsOf, treeStep, type TermRow } from "./term-rows";
import type { TermTree } from "./term-tree";
import { texts } from "../../texts";

const words = texts.terms;

const kFingers = hasFingers();
const kRowPx = Math.round((kFingers ? 44 : 30) * growth());
const kTreePx = Math.round(300 * growth());
const kIndentPx = 16;
const kAbove = 4; // rows rendered above and below the visible ones

@customElement("strata-term-chooser")
export class StrataTermChooser extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** A layer whose values are terms of a list. */
  @property({ attribute: false }) layer!: Layer;
  /** The key of the chosen term. */
  @property({ attribute: false }) chosen = 0;
  @state() private _text = "";
  @state() private _found: FoundTerms | null = null;
  @state() private _problem = "";
  // keys of folded terms in the whole tree
  @state() private _folded: ReadonlySet<number> = new Set();
  @state() private _foundFolded: ReadonlySet<number> = new Set();
  @state() private _at: number | null = null; // key of the term that Enter chooses
  @query("input") private _input!: HTMLInputElement;
  @query(".tree") private _tree!: HTMLElement | null;
  private _rows: TermRow[] = [];
  // The height of the tree without a search, which keeps the content below at its position.
  private _wholePx = 0;
  private _walks = false; // whether arrow keys move in the tree, not in the text
  private _generation = 0; // generation of the folded terms
  private _searching: Promise<void> | null = null;

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  constructor() {
    super();
    followSession(this, "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
        min-width: 0;
      }
      .now {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr);
        align-items: center;
        gap: var(--space-half) var(--space-2);
      }
      .now .above {
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
      .now b {
        font-weight: 600;
      }
      .now .hint {
        grid-column: 2;
      }
      .search {
        position: relative;
      }
      .search input {
        padding-right: var(--space-8);
      }
      .search button {
        position: absolute;
        top: 1px;
        right: 1px;
      }
      .tree {
        max-height: ${kTreePx}px;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--field);
      }
      .rows {
        position: relative;
      }
      .term {
        position: absolute;
        left: 0;
        right: 0;
        display: flex;
        align-items: center;
        gap: var(--space-2);
        height: ${kRowPx}px;
        padding-right: var(--space-2);
        font-size: var(--text-small);
        cursor: pointer;
      }
      .term:hover {
        background: var(--hover);
      }
      .term.above-found {
        color: var(--ink-soft);
      }
      .term[aria-selected="true"] {
        background: var(--accent-soft);
        font-weight: 600;
      }
      :host(:focus-within) .term.at {
        box-shadow: inset 0 0 0 2px var(--accent);
      }
      .fold {
        display: grid;
        place-items: center;
        flex: none;
        width: ${kFingers ? 2.25 : 1.5}rem;
        height: 100%;
        color: var(--ink-soft);
      }
      .fold svg.glyph {
        width: 0.875rem;
        height: 0.875rem;
      }
      .term[aria-expanded="true"] .fold svg.glyph {
        transform: rotate(90deg);
      }
      @media (max-width: 820px) {
        .tree {
          max-height: 13.75rem;
        }
      }
      .term > svg.glyph {
        width: 0.9375rem;
        height: 0.9375rem;
        margin-left: auto;
        color: var(--accent);
      }
    `,
  ];

  private get terms(): TermTree | null {
    return this.layer.table === undefined ? null : this.session.tables.terms(this.layer.table);
  }

  override willUpdate(changed: PropertyValues<this>): void {
    const { terms } = this;
    terms?.want();
    const otherList = changed.has("layer") && changed.get("layer")?.table !== this.layer.table;
    if (otherList) {
      this._text = this._problem = "";
      this._found = this._at = null;
      this._generation = 0;
    }
    if (terms && terms.generation !== this._generation) this.take(terms);
    if (changed.has("chosen") || otherList) this.reveal();
    if (!this._found) this._wholePx = Math.min(kTreePx, this._tree?.offsetHeight ?? 0);
    this._rows = this._found
      ? rowsOf(this._found.terms, this._foundFolded)
      : rowsOf(terms?.terms ?? [], this._folded);
  }

  /** Takes terms that were loaded or have changed. */
  private take(terms: TermTree): void {
    if (this._generation === 0) this._folded = foldedAtFirst(terms.terms, this.chosen);
    this._generation = terms.generation;
    this.reveal();
    if (this._text !== "") this.search();
  }

  /** Unfolds the ancestors of the chosen term and scrolls to it. */
  private reveal(): void {
    const above = pathTo(this.terms?.terms ?? [], this.chosen);
    if (above.some(({ key }) => this._folded.has(key)))
      this._folded = without(this._folded, ...above.map(({ key }) => key));
    void this.updateComplete.then(() => this.scrollToPlace(this.chosen));
  }

  override render(): TemplateResult {
    const { terms, _found: found } = this;
    if (!terms?.loaded) return html`<p class="hint" role="status">${texts.loading}</p>`;
    const problem = terms.problem || this._problem;
    return html`${this.now(terms)}
      <div class="search">
        <input
          type="text"
          role="combobox"
          aria-label=${words.choose}
          aria-expanded="true"
          aria-haspopup="tree"
          aria-controls="tree"
          aria-autocomplete="list"
          aria-activedescendant=${this._rows.some(({ term }) => term.key === this._at) ? `term-${this._at}` : nothing}
          autocomplete="off"
          spellcheck="false"
          maxlength="200"
          placeholder=${words.search}
          .value=${live(this._text)}
          @input=${this.onInput}
          @focus=${() => this._input.select()}
          @keydown=${this.onKey}
        />
        ${
          this._text === ""
            ? nothing
            : html`<button class="icon quiet" aria-label=${words.show_all} title=${words.show_all} @click=${this.clear}>${icon("close")}</button>`
        }
      </div>
      ${problem ? html`<p class="error" role="alert">${problem}</p>` : nothing}
      <div class="tree" id="tree" role="tree" tabindex="-1" aria-label=${words.tree} ${styled({ "min-height": found ? `${this._wholePx}px` : null })} @scroll=${() => this.requestUpdate()} @pointerdown=${this.keepFocus}>
        <div class="rows" role="none" ${styled({ height: `${this._rows.length * kRowPx}px` })}>
          ${repeat(
            this.inSight(),
            ([, row]) => row.term.key,
            ([index, row]) => this.row(row, index),
          )}
        </div>
      </div>
      <p class="hint" role="status" ?hidden=${this.told(terms, found) === ""}>${this.told(terms, found)}</p>`;
  }

  /**
   * Describes the brush's term in words, also for users who cannot see the tree or hover over a
   * term.
   */
  private now({ terms }: TermTree): TemplateResult {
    const { chosen, _found: found } = this;
    const known =
      [terms, found?.terms ?? []].find((some) => some.some(({ key }) => key === chosen)) ?? [];
    const term = known.find(({ key }) => key === chosen);
    const above = pathTo(known, chosen);
    // In a very large list, the chosen term may not be loaded.
    const name =
      term?.name ??
      this.session.tables.label(this.layer.table ?? 0, chosen) ??
      texts.tables.record(chosen);
    return html`<div class="now">
      ${this.swatch(chosen)}
      <span>${above.length === 0 ? nothing : html`<span class="above">${above.map((each) => `${each.name} › `)}</span>`}<b>${name}</b></span>
      ${term?.definition ? html`<span class="hint">${term.definition}</span>` : nothing}
    </div>`;
  }

  private row({ term, parent, folded, place, of }: TermRow, index: number): TemplateResult {
    const chosen = term.key === this.chosen;
    return html`<div
      class="term ${term.key === this._at ? "at" : ""} ${term.match ? "" : "above-found"}"
      id="term-${term.key}"
      role="treeitem"
      aria-level=${term.depth + 1}
      aria-setsize=${of}
      aria-posinset=${place}
      aria-expanded=${parent ? !folded : nothing}
      aria-selected=${chosen}
      title=${term.definition || term.name}
      ${styled({ top: `${index * kRowPx}px`, "padding-left": `${term.depth * kIndentPx}px` })}
      @click=${() => this.choose(term.key)}
    >
      <span class="fold" @click=${(event: Event) => this.onFold(event, term, parent, folded)}>${parent ? icon("chevron") : nothing}</span>
      ${this.swatch(term.key)}<span class="ellipsis">${term.name}</span>${chosen ? icon("check") : nothing}
    </div>`;
  }

  /**
   * Shows the term's color in this user's palette. The swatch is empty if another column sets the
   * color.
   */
  private swatch(key: number): TemplateResult {
    const palette = this.session.layers.palette(this.layer);
    const color = colorOf(palette, key);
    const point = pointOf(palette, key) ?? (color === null ? null : { color });
    return point && !palette.column
      ? html`<span class="swatch" ${styled(swatchStyle(point))}></span>`
      : html`<span></span>`;
  }

  /** Returns a note about terms that are not shown. It is empty if all terms are shown. */
  private told(terms: TermTree, found: FoundTerms | null): string {
    if (found)
      return found.total === 0
        ? words.none_found
        : found.total > found.terms.length
          ? words.more_found(found.total - found.terms.length)
          : "";
    if (terms.problem) return "";
    return terms.total === 0
      ? words.empty
      : terms.total > terms.terms.length
        ? words.more(terms.terms.length, terms.total)
        : "";
  }

  private inSight(): [number, TermRow][] {
    const { scrollTop: top = 0, clientHeight: height = kTreePx } = this._tree ?? {};
    const first = Math.max(0, Math.floor(top / kRowPx) - kAbove);
    const last = Math.ceil((top + Math.max(height, kTreePx)) / kRowPx) + kAbove;
    return this._rows.slice(first, last).map((row, index) => [first + index, row]);
  }

  private scrollToPlace(key: number): void {
    const index = this._rows.findIndex(({ term }) => term.key === key);
    const tree = this._tree;
    if (!tree || index < 0) return;
    const top = index * kRowPx;
    if (top < tree.scrollTop) tree.scrollTop = top;
    else if (top + kRowPx > tree.scrollTop + tree.clientHeight)
      tree.scrollTop = top + kRowPx - tree.clientHeight;
  }

  // ── choice ─────────────────────────────────────────────────────────────────────────────────────

  private choose(key: number): void {
    this._at = key;
    this.dispatchEvent(new CustomEvent<number>("chosen", { detail: key }));
  }

  /**
   * Keeps the focus in the field when the user presses on the tree, so the on-screen keyboard of a
   * phone stays open.
   */
  private keepFocus(event: Event): void {
    event.preventDefault();
  }

  private onFold(event: Event, term: ListedTerm, parent: boolean, folded: boolean): void {
    if (!parent) return; // for a term without children, the press selects it
    event.stopPropagation();
    this.fold(term.key, !folded);
  }

  private fold(key: number, fold: boolean): void {
    const change = (keys: ReadonlySet<number>): Set<number> =>
      fold ? new Set([...keys, key]) : without(keys, key);
    if (this._found) this._foundFolded = change(this._foundFolded);
    else this._folded = change(this._folded);
  }

  private onKey(event: KeyboardEvent): void {
    const { key } = event;
    if (key === "Enter") void this.onEnter();
    else if (key === "Escape") this.onEscape();
    else if (
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      event.shiftKey ||
      !this.onTreeKey(key)
    )
      return;
    event.preventDefault();
    event.stopPropagation();
  }

  /**
   * Handles a key of the tree. Left and right move the caret in the text until the user has moved
   * into the tree.
   */
  private onTreeKey(key: string): boolean {
    if ((key === "ArrowLeft" || key === "ArrowRight") && !this._walks && this._text !== "")
      return false;
    const at = this._rows.findIndex(({ term }) => term.key === (this._at ?? this.chosen));
    const step = treeStep(
      key,
      this._rows,
      at,
      Math.floor((this._tree?.clientHeight ?? kTreePx) / kRowPx),
    );
    if (!step) return false;
    this._walks = true;
    const next = "at" in step ? this._rows[step.at]! : this._rows[at]!;
    this._at = next.term.key;
    if ("fold" in step) this.fold(next.term.key, step.fold);
    void this.updateComplete.then(() => this.scrollToPlace(next.term.key));
    return true;
  }

  /** Chooses the current term after the search for the typed text has ended. */
  private async onEnter(): Promise<void> {
    await this._searching;
    if (this._at === null) return;
    this.choose(this._at);
    this._input.select();
  }

  private onEscape(): void {
    if (this._text === "") this._input.blur();
    else this.clear();
  }

  // ── search ─────────────────────────────────────────────────────────────────────────────────────

  private onInput(): void {
    this._text = this._input.value;
    this.search();
  }

  private readonly clear = (): void => {
    this._text = "";
    this.search();
    this._input.focus();
  };

  private search(): void {
    this._searching ??= this.find().finally(() => (this._searching = null));
  }

  /** Repeats the search until its result belongs to the current text. */
  private async find(): Promise<void> {
    for (;;) {
      const { terms } = this;
      const text = this._text.trim();
      this._problem = "";
      try {
        const found = text === "" || !terms ? null : await terms.search(text);
        if (terms !== this.terms || text !== this._text.trim()) continue;
        this.show(found);
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (terms !== this.terms || text !== this._text.trim()) continue;
        this._problem = error.message;
      }
      return;
    }
  }

  /** Shows the found terms, or the whole tree if `found` is null. */
  private show(found: FoundTerms | null): void {
    this._found = found;
    this._walks = false;
    this._at = found?.terms.find(({ match }) => match)?.key ?? null;
    this._foundFolded = new Set();
    void this.updateComplete.then(() => this.scrollToPlace(this._at ?? this.chosen));
  }
}

const without = (keys: ReadonlySet<number>, ...gone: number[]): Set<number> =>
  new Set([...keys].filter((key) => !gone.includes(key)));

declare global {
  interface HTMLElementTagNameMap {
    "strata-term-chooser": StrataTermChooser;
  }
}
