// <strata-column-filter>: what the rows of a table must hold in one column, chosen from what there
// is: values with how many records have them, a range, a part of the text, nothing or anything.
// Tells by "filter" what the filter of the table says then.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { is_number, label_of, names_records } from "../../domain/cells";
import {
  chosen_in,
  filter_kinds,
  with_choice,
  type ColumnFilter,
  type FilterKind,
  type FilterValue,
} from "../../domain/column-filter";
import { count_values, type ValueCounts } from "../../domain/value-counts";
import { compare_words, format_count, read_number, typed_number } from "../../core/locale";
import type { Column } from "../../core/protocol.gen";
import { follow_session } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { number_input } from "../../ui/number-input";
import { form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.column_filter;
const kSearched = 8; // values from which on they are searched
const kMostShown = 300;

interface Line {
  value: FilterValue;
  text: string;
  count: number;
}

@customElement("strata-column-filter")
export class StrataColumnFilter extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) table = 0;
  @property({ attribute: false }) column!: Column;
  /** Of the table, as it is now. */
  @property({ attribute: false }) filter = "";
  @property({ attribute: false }) anchor!: HTMLElement;
  @state() private kind_: FilterKind = "one_of";
  @state() private values_ = new Set<FilterValue>();
  @state() private empty_ = false;
  @state() private from_ = "";
  @state() private to_ = "";
  @state() private text_ = "";
  @state() private search_ = "";
  @state() private counts_: ValueCounts | null = null;
  @state() private problem_ = "";
  @query(".sheet") private sheet_!: HTMLElement;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    form_styles,
    css`
      .sheet {
        position: fixed;
        inset: auto;
        box-sizing: border-box;
        width: min(19rem, calc(100vw - 1rem));
        max-height: min(28rem, calc(100dvh - 1rem));
        margin: 0;
        padding: 0.875rem;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        color: var(--ink);
        box-shadow: var(--shadow);
        font-size: 0.9rem;
      }
      h3 {
        font-size: 0.95rem;
        overflow-wrap: anywhere;
      }
      .ends {
        display: grid;
        grid-template-columns: 1fr 1fr;
        gap: 0.5rem;
      }
      .values {
        display: grid;
        gap: 1px;
        max-height: 13rem;
        margin: 0;
        padding: 2px;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        list-style: none;
      }
      .values label {
        display: flex;
        align-items: center;
        gap: 0.5rem;
        min-height: 1.875rem;
        padding: 0 0.5rem;
        border-radius: 4px;
        cursor: pointer;
      }
      .values label:hover {
        background: var(--hover);
      }
      .values .count {
        margin-left: auto;
        color: var(--ink-soft);
      }
      input[type="date"] {
        width: 100%;
        min-height: 2.375rem;
        padding: 0.375rem 0.5rem;
        border: var(--edge) solid var(--line-strong);
        border-radius: var(--radius-small);
        background: var(--raised);
      }
      .row {
        flex-wrap: wrap;
        justify-content: end;
      }
      @media (pointer: coarse) {
        .values label {
          min-height: 2.75rem;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.take(
      chosen_in(this.filter, this.column) ?? {
        is: filter_kinds(this.column)[0]!,
        values: [],
        empty: false,
        from: "",
        to: "",
        text: "",
      },
    );
    void this.count();
  }

  override firstUpdated(): void {
    this.sheet_.showPopover();
    this.place();
    this.renderRoot.querySelector<HTMLElement>("select")?.focus();
  }

  override updated(): void {
    if (this.sheet_.matches(":popover-open")) this.place();
  }

  private take(choice: ColumnFilter): void {
    this.kind_ = choice.is;
    if (choice.is === "one_of") {
      this.values_ = new Set(choice.values);
      this.empty_ = choice.empty;
    } else if (choice.is === "range") {
      const shown = (end: string): string =>
        end !== "" && is_number(this.column) ? typed_number(Number(end)) : end;
      [this.from_, this.to_] = [shown(choice.from), shown(choice.to)];
    } else if (choice.is === "contains") this.text_ = choice.text;
  }

  /** Of the records that the rest of the filter finds. */
  private async count(): Promise<void> {
    try {
      const filter = with_choice(this.filter, this.column, null);
      this.counts_ = await count_values(
        (query) => this.session.api.records({ table: this.table }, { ...query, filter }),
        this.column.slug,
      );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    }
  }

  private place(): void {
    const margin = 8;
    const at = this.anchor.getBoundingClientRect();
    const box = this.sheet_.getBoundingClientRect();
    const below = at.bottom + 4 + box.height <= innerHeight - margin;
    const top = below
      ? at.bottom + 4
      : Math.max(margin, Math.min(at.top - box.height - 4, innerHeight - box.height - margin));
    this.sheet_.style.top = `${Math.max(margin, top)}px`;
    this.sheet_.style.left = `${Math.max(margin, Math.min(at.right - box.width, innerWidth - box.width - margin))}px`;
  }

  override render(): TemplateResult {
    const kinds = filter_kinds(this.column);
    const name = label_of(this.column);
    return html`<div class="sheet" popover="auto" role="dialog" aria-labelledby="title" @toggle=${this.on_toggle} @keydown=${this.on_key}>
      <form @submit=${this.on_submit}>
        <h3 id="title">${words.title(name)}</h3>
        <label class="field">
          <span>${words.show}</span>
          <select @change=${(event: Event) => (this.kind_ = (event.target as HTMLSelectElement).value as FilterKind)}>
            ${kinds.map((kind) => html`<option value=${kind} ?selected=${kind === this.kind_}>${words.kinds[kind]}</option>`)}
          </select>
        </label>
        ${this.kind_ === "one_of" ? this.values() : this.kind_ === "range" ? this.range() : this.kind_ === "contains" ? this.part_of_text() : nothing}
        ${this.problem_ ? html`<p class="error" role="alert">${this.problem_}</p>` : nothing}
        <div class="row">
          <button type="button" ?disabled=${chosen_in(this.filter, this.column) === null} @click=${() => this.apply(null)}>${words.remove}</button>
          <button class="primary">${words.apply}</button>
        </div>
      </form>
    </div>`;
  }

  // ── values
  // ────────────────────────────────────────────────────────────────────────────────────────────────────────

  private lines(): Line[] {
    const { column, counts_: counts } = this;
    const lines = [...(counts?.of_value ?? [])].map(([value, count]) => ({
      value,
      count,
      text: this.text_of(value),
    }));
    const known = new Set(lines.map(({ value }) => value));
    // What is chosen and what could be stand there, too.
    const also = [
      ...this.values_,
      ...(column.kind === "enumeration"
        ? (column.choices ?? [])
        : column.kind === "boolean"
          ? [true, false]
          : []),
    ];
    for (const value of new Set(also))
      if (!known.has(value)) lines.push({ value, count: 0, text: this.text_of(value) });
    const by_number = is_number(column);
    return lines.sort((a, b) =>
      by_number ? Number(a.value) - Number(b.value) : compare_words(a.text, b.text),
    );
  }

  private text_of(value: FilterValue): string {
    if (names_records(this.column))
      return (
        this.session.tables.label(this.column.target ?? 0, Number(value)) ??
        texts.tables.record(Number(value))
      );
    if (typeof value === "boolean") return value ? texts.tables.yes : texts.tables.no;
    return typeof value === "number" ? typed_number(value) : value;
  }

  private values(): TemplateResult {
    const { counts_: counts } = this;
    if (!counts) return html`<p class="hint" role="status">${texts.loading}</p>`;
    const all = this.lines();
    const wanted = this.search_.trim().toLocaleLowerCase();
    const found = all.filter(({ text }) => text.toLocaleLowerCase().includes(wanted));
    const choose = (value: FilterValue) => (event: Event) => {
      const chosen = new Set(this.values_);
      if ((event.target as HTMLInputElement).checked) chosen.add(value);
      else chosen.delete(value);
      this.values_ = chosen;
    };
    return html`${
      all.length > kSearched
        ? html`<input type="text" aria-label=${words.search} placeholder=${words.search} .value=${this.search_} @input=${(event: Event) => (this.search_ = (event.target as HTMLInputElement).value)} />`
        : nothing
    }
      <ul class="values" aria-label=${words.kinds.one_of}>
        ${found.slice(0, kMostShown).map(
          ({ value, text, count }) =>
            html`<li>
              <label><input type="checkbox" .checked=${this.values_.has(value)} @change=${choose(value)} /><span class="ellipsis" title=${text}>${text}</span><span class="count numeric">${format_count(count)}</span></label>
            </li>`,
        )}
        ${
          counts.empty > 0 || this.empty_
            ? html`<li>
              <label
                ><input type="checkbox" .checked=${this.empty_} @change=${(event: Event) => (this.empty_ = (event.target as HTMLInputElement).checked)} /><span><i>${words.no_value}</i></span
                ><span class="count numeric">${format_count(counts.empty)}</span></label
              >
            </li>`
            : nothing
        }
      </ul>
      <p class="hint" role="status">
        ${found.length > kMostShown ? words.more(found.length - kMostShown) : found.length === 0 && counts.empty === 0 ? texts.tables.nothing_matches : nothing}
        ${counts.counted < counts.total ? words.counted(counts.counted, counts.total) : nothing}
      </p>`;
  }

  // ── ranges and texts
  // ──────────────────────────────────────────────────────────────────────────────────────────────

  private range(): TemplateResult {
    const { column } = this;
    const { least, greatest } = this.counts_ ?? { least: null, greatest: null };
    const shown = (value: FilterValue | null): string =>
      value === null ? "" : this.text_of(value);
    const field = (
      label: string,
      value: string,
      hint: string,
      typed: (text: string) => void,
    ): TemplateResult =>
      html`<label class="field">
        <span>${label}${column.unit ? ` (${column.unit})` : ""}</span>
        ${
          is_number(column)
            ? number_input({ value, placeholder: hint, typed })
            : html`<input
              type=${column.kind === "date" ? "date" : "text"}
              .value=${value}
              placeholder=${hint}
              @input=${(event: Event) => typed((event.target as HTMLInputElement).value)}
            />`
        }
      </label>`;
    return html`<div class="ends">
      ${field(words.from, this.from_, shown(least), (text) => (this.from_ = text))} ${field(words.to, this.to_, shown(greatest), (text) => (this.to_ = text))}
    </div>`;
  }

  private part_of_text(): TemplateResult {
    return html`<label class="field">
      <span>${words.contains}</span>
      <input type="text" .value=${this.text_} maxlength="1000" @input=${(event: Event) => (this.text_ = (event.target as HTMLInputElement).value)} />
    </label>`;
  }

  // ── what becomes of it
  // ────────────────────────────────────────────────────────────────────────────────────────────

  /** Null: an end is no number. */
  private chosen(): ColumnFilter | null {
    switch (this.kind_) {
      case "one_of":
        return { is: "one_of", values: [...this.values_], empty: this.empty_ };
      case "contains":
        return { is: "contains", text: this.text_.trim() };
      case "range": {
        const ends = [this.from_, this.to_].map((typed) =>
          typed.trim() === "" || !is_number(this.column)
            ? typed.trim()
            : String(read_number(typed)),
        );
        return ends.includes("NaN") ? null : { is: "range", from: ends[0]!, to: ends[1]! };
      }
      default:
        return { is: this.kind_ };
    }
  }

  private readonly on_submit = (event: Event): void => {
    event.preventDefault();
    const chosen = this.chosen();
    if (chosen) this.apply(chosen);
    else this.problem_ = texts.tables.bad_number;
  };

  private apply(choice: ColumnFilter | null): void {
    this.dispatchEvent(
      new CustomEvent("filter", { detail: with_choice(this.filter, this.column, choice) }),
    );
    this.sheet_.hidePopover();
  }

  /** Enter in a field chooses, Escape leaves: neither is for the page. */
  private on_key(event: KeyboardEvent): void {
    if (event.key !== "Tab") event.stopPropagation();
  }

  private on_toggle(event: ToggleEvent): void {
    if (event.newState !== "closed") return;
    const had = this.renderRoot instanceof ShadowRoot && this.renderRoot.activeElement !== null;
    if (had || document.activeElement === document.body) this.anchor.focus();
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
