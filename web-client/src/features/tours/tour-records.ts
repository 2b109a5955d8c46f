// <strata-tour-records>: the records at a stop of a tour: their tables, keys, columns and the
// labels of these columns.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import { labelOf } from "../../domain/cells";
import { languageInWords } from "../../core/languages";
import type { Table, TourRecords } from "../../core/protocol.gen";
import { isAbout, kMostKeys, kMostRecordTables } from "../../domain/tours";
import { addFrom, addFromStyles } from "../../ui/add-from";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import "../../ui/order/ordered-choice";
import "../../session/fields/record-chooser";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { visibilityBadge } from "../../ui/visibility";

const words = texts.tours;

@customElement("strata-tour-records")
export class StrataTourRecords extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) records: readonly TourRecords[] = [];
  /** The languages in which the user edits the labels of columns. */
  @property({ attribute: false }) languages: readonly string[] = [];
  /** The refused field, such as `records[0].keys[2]`. */
  @property() wrong = "";
  @property() problem = "";
  @state() private _tables: readonly Table[] = [];

  static override styles = [
    sharedStyles,
    addFromStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
      }
      section {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
        padding: var(--space-2) var(--space-3) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
      }
      section.wrong {
        border-color: var(--danger);
      }
      section > .row b {
        flex: 1;
        min-width: 0;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.session.tables
      .all()
      .then((tables) => (this._tables = tables))
      .catch((error: unknown) => {
        if (!(error instanceof ApiError)) throw error;
        notices.error(error);
      });
  }

  override render(): TemplateResult {
    const { records, _tables } = this;
    const others = _tables.filter(({ slug }) => !records.some(({ table }) => table === slug));
    return html`${repeat(
      records,
      ({ table }) => table,
      (each, index) => this.ofTable(each, index),
    )}
      ${
        others.length > 0 && records.length < kMostRecordTables
          ? addFrom(
              words.table_add,
              others.map((table) => ({ value: table.slug, name: labelOf(table) })),
              (table) => this.put([...records, { table, keys: [], columns: [] }]),
            )
          : nothing
      }
      ${_tables.length === 0 && records.length === 0 ? html`<p class="hint">${words.no_tables}</p>` : nothing}`;
  }

  private ofTable(each: TourRecords, index: number): TemplateResult {
    const table = this._tables.find(({ slug }) => slug === each.table);
    const name = table ? labelOf(table) : each.table;
    const wrong = this.wrong !== "" && isAbout(this.wrong, `records[${index}]`);
    const wrongColumn = /\.columns\[(\d+)\]/.exec(wrong ? this.wrong : "")?.[1];
    return html`<section class=${wrong ? "wrong" : ""} aria-label=${name}>
      <div class="row">
        <b>${name}</b>
        <button type="button" class="icon quiet" aria-label=${words.table_remove(name)} title=${words.table_remove(name)} @click=${() => this.put(this.records.filter((other) => other !== each))}>
          ${icon("close")}
        </button>
      </div>
      ${wrong ? html`<p class="error" role="alert">${this.problem}</p>` : nothing}
      ${
        table
          ? html`<strata-record-chooser
              .session=${this.session}
              .table=${table.id}
              .chosen=${each.keys}
              multiple
              .invalid=${wrong && this.wrong.includes(".keys")}
              label=${words.keys_of(name)}
              @chosen=${(event: CustomEvent<number[]>) => this.change(index, { keys: event.detail.slice(0, kMostKeys) })}
            ></strata-record-chooser>
            ${each.keys.length === 0 ? html`<p class="hint">${words.keys_none}</p>` : nothing}
            <span class="caption">${words.columns}</span>
            <strata-ordered-choice
              label=${words.columns_of(name)}
              add_label=${words.column_add}
              .things=${table.columns.map((column) => ({ value: column.slug, name: labelOf(column), badge: visibilityBadge(column.visibility) }))}
              .chosen=${each.columns.map(({ column }) => column)}
              .wrong=${wrongColumn === undefined ? [] : [each.columns[Number(wrongColumn)]?.column ?? ""]}
              .more=${(slug: string) => this.labels(index, table, slug)}
              @chosen=${(event: CustomEvent<string[]>) => this.chooseColumns(index, event.detail)}
            ></strata-ordered-choice>`
          : nothing
      }
    </section>`;
  }

  /** Renders the labels of the column on the card, in the edited languages. */
  private labels(index: number, table: Table, slug: string): TemplateResult {
    const column = table.columns.find((each) => each.slug === slug);
    const labels = this.records[index]?.columns.find((each) => each.column === slug)?.labels ?? {};
    const name = column ? labelOf(column) : slug;
    return html`${this.languages.map(
      (language) =>
        html`<input
          type="text"
          maxlength="200"
          lang=${language}
          aria-label=${words.column_label(name, languageInWords(language))}
          placeholder=${words.column_label_hint(languageInWords(language), column ? labelOf(column, [language]) : slug)}
          .value=${labels[language] ?? ""}
          @input=${(event: Event) => this.label(index, slug, language, (event.target as HTMLInputElement).value)}
        />`,
    )}`;
  }

  private label(index: number, slug: string, language: string, text: string): void {
    const columns = this.records[index]!.columns.map((each) =>
      each.column === slug ? { ...each, labels: { ...each.labels, [language]: text } } : each,
    );
    this.change(index, { columns });
  }

  private chooseColumns(index: number, slugs: readonly string[]): void {
    const { columns } = this.records[index]!;
    this.change(index, {
      columns: slugs.map((column) => columns.find((each) => each.column === column) ?? { column }),
    });
  }

  private change(index: number, change: Partial<TourRecords>): void {
    this.put(this.records.map((each, at) => (at === index ? { ...each, ...change } : each)));
  }

  private put(records: readonly TourRecords[]): void {
    this.dispatchEvent(new CustomEvent<readonly TourRecords[]>("changed", { detail: records }));
  }
}
