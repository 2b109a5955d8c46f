// <strata-term-chooser>: which term of a list is painted: a tree that is searched by typing and
// gone through by keys, as it is coloured on the model.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { live } from "lit/directives/live.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api";
import { color_of, point_of, swatch_style } from "../../domain/palette";
import type { ListedTerm, TermTree as FoundTerms } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { follow_session } from "../follow-session";
import { growth } from "../../ui/growth";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../model-session";
import { has_fingers } from "../../ui/pointers";
import { shared_styles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { folded_at_first, path_to, rows_of, tree_step, type TermRow } from "./term-rows";
import type { TermTree } from "./term-tree";
import { texts } from "../../texts";

const words = texts.terms;

const kFingers = has_fingers();
const kRow_px = Math.round((kFingers ? 44 : 30) * growth());
const kTree_px = Math.round(300 * growth());
const kIndent_px = 16;
const kAbove = 4; // rows drawn beyond those in sight

@customElement("strata-term-chooser")
export class StrataTermChooser extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Of a list of terms. */
  @property({ attribute: false }) layer!: Layer;
  /** Key of a term. */
  @property({ attribute: false }) chosen = 0;
  @state() private text_ = "";
  @state() private found_: FoundTerms | null = null;
  @state() private problem_ = "";
  @state() private folded_: ReadonlySet<number> = new Set(); // in the whole tree
  @state() private found_folded_: ReadonlySet<number> = new Set();
  @state() private at_: number | null = null; // key of the term that Enter chooses
  @query("input") private input_!: HTMLInputElement;
  @query(".tree") private tree_!: HTMLElement | null;
  private rows_: TermRow[] = [];
  // height of the tree without a search: what lies below does not jump while one types
  private whole_px_ = 0;
  private walks_ = false; // the arrow keys go through the tree, and not through the text
  private generation_ = 0; // of the terms that were folded
  private searching_: Promise<void> | null = null;

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        gap: 0.4375rem;
        min-width: 0;
      }
      .now {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr);
        align-items: center;
        gap: 2px 0.5625rem;
      }
      .now .above {
        color: var(--ink-soft);
        font-size: 0.86rem;
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
        padding-right: 2.5rem;
      }
      .search button {
        position: absolute;
        top: 1px;
        right: 1px;
      }
      .tree {
        max-height: ${kTree_px}px;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--raised);
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
        gap: 0.5rem;
        height: ${kRow_px}px;
        padding-right: 0.5rem;
        font-size: 0.92rem;
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
    const other_list = changed.has("layer") && changed.get("layer")?.table !== this.layer.table;
    if (other_list) {
      this.text_ = this.problem_ = "";
      this.found_ = this.at_ = null;
      this.generation_ = 0;
    }
    if (terms && terms.generation !== this.generation_) this.take(terms);
    if (changed.has("chosen") || other_list) this.reveal();
    if (!this.found_) this.whole_px_ = Math.min(kTree_px, this.tree_?.offsetHeight ?? 0);
    this.rows_ = this.found_
      ? rows_of(this.found_.terms, this.found_folded_)
      : rows_of(terms?.terms ?? [], this.folded_);
  }

  /** The terms are here, or have changed. */
  private take(terms: TermTree): void {
    if (this.generation_ === 0) this.folded_ = folded_at_first(terms.terms, this.chosen);
    this.generation_ = terms.generation;
    this.reveal();
    if (this.text_ !== "") this.search();
  }

  /** The chosen one is brought into sight, where it is. */
  private reveal(): void {
    const above = path_to(this.terms?.terms ?? [], this.chosen);
    if (above.some(({ key }) => this.folded_.has(key)))
      this.folded_ = without(this.folded_, ...above.map(({ key }) => key));
    void this.updateComplete.then(() => this.scroll_to(this.chosen));
  }

  override render(): TemplateResult {
    const { terms, found_: found } = this;
    if (!terms?.loaded) return html`<p class="hint" role="status">${texts.loading}</p>`;
    const problem = terms.problem || this.problem_;
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
          aria-activedescendant=${this.rows_.some(({ term }) => term.key === this.at_) ? `term-${this.at_}` : nothing}
          autocomplete="off"
          spellcheck="false"
          maxlength="200"
          placeholder=${words.search}
          .value=${live(this.text_)}
          @input=${this.on_input}
          @focus=${() => this.input_.select()}
          @keydown=${this.on_key}
        />
        ${
          this.text_ === ""
            ? nothing
            : html`<button class="icon quiet" aria-label=${words.show_all} title=${words.show_all} @click=${this.clear}>${icon("close")}</button>`
        }
      </div>
      ${problem ? html`<p class="error" role="alert">${problem}</p>` : nothing}
      <div class="tree" id="tree" role="tree" tabindex="-1" aria-label=${words.tree} ${styled({ "min-height": found ? `${this.whole_px_}px` : null })} @scroll=${() => this.requestUpdate()} @pointerdown=${this.keep_focus}>
        <div class="rows" role="none" ${styled({ height: `${this.rows_.length * kRow_px}px` })}>
          ${repeat(
            this.in_sight(),
            ([, row]) => row.term.key,
            ([index, row]) => this.row(row, index),
          )}
        </div>
      </div>
      <p class="hint" role="status" ?hidden=${this.told(terms, found) === ""}>${this.told(terms, found)}</p>`;
  }

  /**
   * What the brush has now, in words also for those who do not see the tree, and cannot point at a
   * term to read about it.
   */
  private now({ terms }: TermTree): TemplateResult {
    const { chosen, found_: found } = this;
    const known =
      [terms, found?.terms ?? []].find((some) => some.some(({ key }) => key === chosen)) ?? [];
    const term = known.find(({ key }) => key === chosen);
    const above = path_to(known, chosen);
    // of a very large list
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
      class="term ${term.key === this.at_ ? "at" : ""} ${term.match ? "" : "above-found"}"
      id="term-${term.key}"
      role="treeitem"
      aria-level=${term.depth + 1}
      aria-setsize=${of}
      aria-posinset=${place}
      aria-expanded=${parent ? !folded : nothing}
      aria-selected=${chosen}
      title=${term.definition || term.name}
      ${styled({ top: `${index * kRow_px}px`, "padding-left": `${term.depth * kIndent_px}px` })}
      @click=${() => this.choose(term.key)}
    >
      <span class="fold" @click=${(event: Event) => this.on_fold(event, term, parent, folded)}>${parent ? icon("chevron") : nothing}</span>
      ${this.swatch(term.key)}<span class="ellipsis">${term.name}</span>${chosen ? icon("check") : nothing}
    </div>`;
  }

  /**
   * As the layer draws it for this person; nothing where something else than the term says its
   * colour.
   */
  private swatch(key: number): TemplateResult {
    const palette = this.session.layers.palette(this.layer);
    const color = color_of(palette, key);
    const point = point_of(palette, key) ?? (color === null ? null : { color });
    return point && !palette.column
      ? html`<span class="swatch" ${styled(swatch_style(point))}></span>`
      : html`<span></span>`;
  }

  /** How much of the list is not shown; empty: all of it is. */
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

  private in_sight(): [number, TermRow][] {
    const { scrollTop: top = 0, clientHeight: height = kTree_px } = this.tree_ ?? {};
    const first = Math.max(0, Math.floor(top / kRow_px) - kAbove);
    const last = Math.ceil((top + Math.max(height, kTree_px)) / kRow_px) + kAbove;
    return this.rows_.slice(first, last).map((row, index) => [first + index, row]);
  }

  private scroll_to(key: number): void {
    const index = this.rows_.findIndex(({ term }) => term.key === key);
    const tree = this.tree_;
    if (!tree || index < 0) return;
    const top = index * kRow_px;
    if (top < tree.scrollTop) tree.scrollTop = top;
    else if (top + kRow_px > tree.scrollTop + tree.clientHeight)
      tree.scrollTop = top + kRow_px - tree.clientHeight;
  }

  // ── choosing
  // ──────────────────────────────────────────────────────────────────────────────────────────────────────

  private choose(key: number): void {
    this.at_ = key;
    this.dispatchEvent(new CustomEvent<number>("chosen", { detail: key }));
  }

  /** A press on the tree leaves the focus, and the keyboard of a phone, as they are. */
  private keep_focus(event: Event): void {
    event.preventDefault();
  }

  private on_fold(event: Event, term: ListedTerm, parent: boolean, folded: boolean): void {
    if (!parent) return; // a press before its name is one on the term
    event.stopPropagation();
    this.fold(term.key, !folded);
  }

  private fold(key: number, fold: boolean): void {
    const change = (keys: ReadonlySet<number>): Set<number> =>
      fold ? new Set([...keys, key]) : without(keys, key);
    if (this.found_) this.found_folded_ = change(this.found_folded_);
    else this.folded_ = change(this.folded_);
  }

  private on_key(event: KeyboardEvent): void {
    const { key } = event;
    if (key === "Enter") void this.on_enter();
    else if (key === "Escape") this.on_escape();
    else if (
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      event.shiftKey ||
      !this.on_tree_key(key)
    )
      return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Left and right are for the text until the arrows have gone into the tree. */
  private on_tree_key(key: string): boolean {
    if ((key === "ArrowLeft" || key === "ArrowRight") && !this.walks_ && this.text_ !== "")
      return false;
    const at = this.rows_.findIndex(({ term }) => term.key === (this.at_ ?? this.chosen));
    const step = tree_step(
      key,
      this.rows_,
      at,
      Math.floor((this.tree_?.clientHeight ?? kTree_px) / kRow_px),
    );
    if (!step) return false;
    this.walks_ = true;
    const next = "at" in step ? this.rows_[step.at]! : this.rows_[at]!;
    this.at_ = next.term.key;
    if ("fold" in step) this.fold(next.term.key, step.fold);
    void this.updateComplete.then(() => this.scroll_to(next.term.key));
    return true;
  }

  /** What was typed may still be looked for. */
  private async on_enter(): Promise<void> {
    await this.searching_;
    if (this.at_ === null) return;
    this.choose(this.at_);
    this.input_.select();
  }

  private on_escape(): void {
    if (this.text_ === "") this.input_.blur();
    else this.clear();
  }

  // ── searching
  // ─────────────────────────────────────────────────────────────────────────────────────────────────────

  private on_input(): void {
    this.text_ = this.input_.value;
    this.search();
  }

  private readonly clear = (): void => {
    this.text_ = "";
    this.search();
    this.input_.focus();
  };

  private search(): void {
    this.searching_ ??= this.find().finally(() => (this.searching_ = null));
  }

  /** Until what was found is what is asked for now. */
  private async find(): Promise<void> {
    for (;;) {
      const { terms } = this;
      const text = this.text_.trim();
      this.problem_ = "";
      try {
        const found = text === "" || !terms ? null : await terms.search(text);
        if (terms !== this.terms || text !== this.text_.trim()) continue;
        this.show(found);
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (terms !== this.terms || text !== this.text_.trim()) continue;
        this.problem_ = error.message;
      }
      return;
    }
  }

  /** Null: the whole tree again. */
  private show(found: FoundTerms | null): void {
    this.found_ = found;
    this.walks_ = false;
    this.at_ = found?.terms.find(({ match }) => match)?.key ?? null;
    this.found_folded_ = new Set();
    void this.updateComplete.then(() => this.scroll_to(this.at_ ?? this.chosen));
  }
}

const without = (keys: ReadonlySet<number>, ...gone: number[]): Set<number> =>
  new Set([...keys].filter((key) => !gone.includes(key)));

declare global {
  interface HTMLElementTagNameMap {
    "strata-term-chooser": StrataTermChooser;
  }
}
