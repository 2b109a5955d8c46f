// <strata-column-filter>: filters the rows of a table by one column. The filter can be a set of
// values with their number of records, a range, a part of the text, or empty or filled cells. The
// event "filter" contains the table's new filter.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { readRecords } from "../../net/records";
import { isNumber, labelOf, namesRecords } from "../../domain/cells";
import {
  chosenIn,
  filterKinds,
  withChoice,
  type ColumnFilter,
  type FilterKind,
  type FilterValue,
} from "../../domain/column-filter";
import { countValues, type ValueCounts } from "../../domain/value-counts";
import { compareWords, formatCount, readNumber, typedNumber } from "../../core/locale";
import type { Column } from "../../core/protocol.gen";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { numberInput } from "../../ui/number-input";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.column_filter;
const kSearched = 8; // a search field appears for at least this number of values
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
  /** The current filter of the table. */
  @property({ attribute: false }) filter = "";
  @property({ attribute: false }) anchor!: HTMLElement;
  @state() private _kind: FilterKind = "one_of";
  @state() private _values = new Set<FilterValue>();
  @state() private _empty = false;
  @state() private _from = "";
  @state() private _to = "";
  @state() private _text = "";
  @state() private _search = "";
  @state() private _counts: ValueCounts | null = null;
  @state() private _problem = "";
  @query(".sheet") private _sheet!: HTMLElement;

  constructor() {
    super();
    followSession(this, "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      .sheet {
        position: fixed;
        inset: auto;
        box-sizing: border-box;
        width: min(19rem, calc(100vw - 1rem));
        max-height: min(28rem, calc(100dvh - 1rem));
        margin: 0;
        padding: var(--space-3);
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        color: var(--ink);
        box-shadow: var(--shadow);
        font-size: var(--text-small);
      }
      h3 {
        font-size: var(--text-body);
        overflow-wrap: anywhere;
      }
      .ends {
        display: grid;
        grid-template-columns: 1fr 1fr;
        gap: var(--space-2);
      }
      .values {
        display: grid;
        gap: var(--space-half);
        max-height: 13rem;
        margin: 0;
        padding: var(--space-half);
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        list-style: none;
      }
      .values label {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-height: var(--control-small);
        padding: 0 var(--space-2);
        border-radius: var(--radius-tiny);
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
        min-height: var(--control);
        padding: var(--space-2) var(--space-2);
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
          min-height: var(--control-touch);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.take(
      chosenIn(this.filter, this.column) ?? {
        is: filterKinds(this.column)[0]!,
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
    this._sheet.showPopover();
    this.place();
    this.renderRoot.querySelector<HTMLElement>("select")?.focus();
  }

  override updated(): void {
    if (this._sheet.matches(":popover-open")) this.place();
  }

  private take(choice: ColumnFilter): void {
    this._kind = choice.is;
    if (choice.is === "one_of") {
      this._values = new Set(choice.values);
      this._empty = choice.empty;
    } else if (choice.is === "range") {
      const shown = (end: string): string =>
        end !== "" && isNumber(this.column) ? typedNumber(Number(end)) : end;
      [this._from, this._to] = [shown(choice.from), shown(choice.to)];
    } else if (choice.is === "contains") this._text = choice.text;
  }

  /** Counts the values in the records that match the rest of the filter. */
  private async count(): Promise<void> {
    try {
      const filter = withChoice(this.filter, this.column, null);
      this._counts = await countValues(
        (query) => readRecords(this.session.api, { table: this.table }, { ...query, filter }),
        this.column.slug,
      );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  private place(): void {
    const margin = 8;
    const at = this.anchor.getBoundingClientRect();
    const box = this._sheet.getBoundingClientRect();
    const below = at.bottom + 4 + box.height <= innerHeight - margin;
    const top = below
      ? at.bottom + 4
      : Math.max(margin, Math.min(at.top - box.height - 4, innerHeight - box.height - margin));
    this._sheet.style.top = `${Math.max(margin, top)}px`;
    this._sheet.style.left = `${Math.max(margin, Math.min(at.right - box.width, innerWidth - box.width - margin))}px`;
  }

  override render(): TemplateResult {
    const kinds = filterKinds(this.column);
    const name = labelOf(this.column);
    return html`<div class="sheet" popover="auto" role="dialog" aria-labelledby="title" @toggle=${this.onToggle} @keydown=${this.onKey}>
      <form @submit=${this.onSubmit}>
        <h3 id="title">${words.title(name)}</h3>
        <label class="field">
          <span>${words.show}</span>
          <select @change=${(event: Event) => (this._kind = (event.target as HTMLSelectElement).value as FilterKind)}>
            ${kinds.map((kind) => html`<option value=${kind} ?selected=${kind === this._kind}>${words.kinds[kind]}</option>`)}
          </select>
        </label>
        ${this._kind === "one_of" ? this.values() : this._kind === "range" ? this.range() : this._kind === "contains" ? this.partOfText() : nothing}
        ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
        <div class="row">
          <button type="button" ?disabled=${chosenIn(this.filter, this.column) === null} @click=${() => this.apply(null)}>${words.remove}</button>
          <button class="primary">${words.apply}</button>
        </div>
      </form>
    </div>`;
  }

  // ── values ─────────────────────────────────────────────────────────────────────────────────────

  private lines(): Line[] {
    const { column, _counts: counts } = this;
    const lines = [...(counts?.ofValue ?? [])].map(([value, count]) => ({
      value,
      count,
      text: this.textOf(value),
    }));
    const known = new Set(lines.map(({ value }) => value));
    // also lists selected values and possible values that no record has
    const also = [
      ...this._values,
      ...(column.kind === "enumeration"
        ? (column.choices ?? [])
        : column.kind === "boolean"
          ? [true, false]
          : []),
    ];
    for (const value of new Set(also))
      if (!known.has(value)) lines.push({ value, count: 0, text: this.textOf(value) });
    const byNumber = isNumber(column);
    return lines.sort((a, b) =>
      byNumber ? Number(a.value) - Number(b.value) : compareWords(a.text, b.text),
    );
  }

  private textOf(value: FilterValue): string {
    if (namesRecords(this.column))
      return (
        this.session.tables.label(this.column.target ?? 0, Number(value)) ??
        texts.tables.record(Number(value))
      );
    if (typeof value === "boolean") return value ? texts.tables.yes : texts.tables.no;
    return typeof value === "number" ? typedNumber(value) : value;
  }

  private values(): TemplateResult {
    const { _counts: counts } = this;
    if (!counts) return html`<p class="hint" role="status">${texts.loading}</p>`;
    const all = this.lines();
    const wanted = this._search.trim().toLocaleLowerCase();
    const found = all.filter(({ text }) => text.toLocaleLowerCase().includes(wanted));
    // the rows change immediately, and the sheet stays open
    const choose = (value: FilterValue) => (event: Event) => {
      const chosen = new Set(this._values);
      if ((event.target as HTMLInputElement).checked) chosen.add(value);
      else chosen.delete(value);
      this._values = chosen;
      this.tell({ is: "one_of", values: [...chosen], empty: this._empty });
    };
    const chooseEmpty = (event: Event): void => {
      this._empty = (event.target as HTMLInputElement).checked;
      this.tell({ is: "one_of", values: [...this._values], empty: this._empty });
    };
    return html`${
      all.length > kSearched
        ? html`<input type="text" aria-label=${words.search} placeholder=${words.search} .value=${this._search} @input=${(event: Event) => (this._search = (event.target as HTMLInputElement).value)} />`
        : nothing
    }
      <ul class="values" aria-label=${words.kinds.one_of}>
        ${found.slice(0, kMostShown).map(
          ({ value, text, count }) =>
            html`<li>
              <label><input type="checkbox" .checked=${this._values.has(value)} @change=${choose(value)} /><span class="ellipsis" title=${text}>${text}</span><span class="count">${formatCount(count)}</span></label>
            </li>`,
        )}
        ${
          counts.empty > 0 || this._empty
            ? html`<li>
              <label
                ><input type="checkbox" .checked=${this._empty} @change=${chooseEmpty} /><span><i>${words.no_value}</i></span
                ><span class="count">${formatCount(counts.empty)}</span></label
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

  // ── ranges and texts ───────────────────────────────────────────────────────────────────────────

  private range(): TemplateResult {
    const { column } = this;
    const { least, greatest } = this._counts ?? { least: null, greatest: null };
    const shown = (value: FilterValue | null): string => (value === null ? "" : this.textOf(value));
    const field = (
      label: string,
      value: string,
      hint: string,
      typed: (text: string) => void,
    ): TemplateResult =>
      html`<label class="field">
        <span>${label}${column.unit ? ` (${column.unit})` : ""}</span>
        ${
          isNumber(column)
            ? numberInput({ value, placeholder: hint, typed })
            : html`<input
              type=${column.kind === "date" ? "date" : "text"}
              .value=${value}
              placeholder=${hint}
              @input=${(event: Event) => typed((event.target as HTMLInputElement).value)}
            />`
        }
      </label>`;
    return html`<div class="ends">
      ${field(words.from, this._from, shown(least), (text) => (this._from = text))} ${field(words.to, this._to, shown(greatest), (text) => (this._to = text))}
    </div>`;
  }

  private partOfText(): TemplateResult {
    return html`<label class="field">
      <span>${words.contains}</span>
      <input type="text" .value=${this._text} maxlength="1000" @input=${(event: Event) => (this._text = (event.target as HTMLInputElement).value)} />
    </label>`;
  }

  // ── result ─────────────────────────────────────────────────────────────────────────────────────

  /** Returns null if a limit of the range is not a number. */
  private chosen(): ColumnFilter | null {
    switch (this._kind) {
      case "one_of":
        return { is: "one_of", values: [...this._values], empty: this._empty };
      case "contains":
        return { is: "contains", text: this._text.trim() };
      case "range": {
        const ends = [this._from, this._to].map((typed) =>
          typed.trim() === "" || !isNumber(this.column) ? typed.trim() : String(readNumber(typed)),
        );
        return ends.includes("NaN") ? null : { is: "range", from: ends[0]!, to: ends[1]! };
      }
      default:
        return { is: this._kind };
    }
  }

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    const chosen = this.chosen();
    if (chosen) this.apply(chosen);
    else this._problem = texts.tables.bad_number;
  };

  private tell(choice: ColumnFilter | null): void {
    this.dispatchEvent(
      new CustomEvent("filter", { detail: withChoice(this.filter, this.column, choice) }),
    );
  }

  private apply(choice: ColumnFilter | null): void {
    this.tell(choice);
    this._sheet.hidePopover();
  }

  /**
   * Enter in a field applies the filter, and Escape closes the sheet. The page must not handle
   * these keys.
   */
  private onKey(event: KeyboardEvent): void {
    if (event.key !== "Tab") event.stopPropagation();
  }

  private onToggle(event: ToggleEvent): void {
    if (event.newState !== "closed") return;
    const had = this.renderRoot instanceof ShadowRoot && this.renderRoot.activeElement !== null;
    if (had || document.activeElement === document.body) this.anchor.focus();
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
