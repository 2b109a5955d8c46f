// <strata-labels-field>: the names of an item in other languages, with one row for each language.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import {
  descriptionsOf,
  kCommonLanguages,
  labelsOf,
  nameOfLanguage,
  rowsOf,
  wellWrittenTag,
  type LabelRow,
} from "../core/languages";
import { compareWords } from "../core/locale";
import type { Labels } from "../core/protocol.gen";
import { icon } from "./icons";
import { sharedStyles } from "./styles";
import { texts } from "../texts";

const words = texts.labels;
const offered = kCommonLanguages
  .map((tag) => ({ tag, name: nameOfLanguage(tag) }))
  .sort((a, b) => compareWords(a.name, b.name));

@customElement("strata-labels-field")
export class StrataLabelsField extends LitElement {
  /** The initial labels. The field itself stores later input. */
  @property({ attribute: false }) labels: Labels = {};
  /** The initial descriptions, for items with a description in each language. */
  @property({ attribute: false }) descriptions: Labels | null = null;
  @state() private _rows: LabelRow[] = [];
  @state() private _problem = "";
  @state() private _wrong: number[] = []; // indexes of the invalid rows

  static override styles = [
    sharedStyles,
    css`
      :host,
      .rows {
        display: grid;
        gap: var(--space-2);
      }
      .rows > div {
        display: grid;
        grid-template-columns: 6.5rem minmax(0, 1fr) auto;
        gap: var(--space-2);
      }
      textarea {
        grid-column: 2;
        min-height: var(--control-touch);
      }
      button.add {
        justify-self: start;
        min-height: 2rem;
      }
      .caption {
        margin-bottom: calc(-1 * var(--space-half));
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("labels") || changed.has("descriptions"))
      this._rows = rowsOf(this.labels, this.descriptions ?? {});
  }

  override render(): TemplateResult {
    return html`<span class="caption" id="caption">${words.title}</span>
      <div class="rows" role="group" aria-labelledby="caption" ?hidden=${this._rows.length === 0}>${this._rows.map((row, index) => this.row(row, index))}</div>
      ${this._problem ? html`<span class="error" id="problem" role="alert">${this._problem}</span>` : nothing}
      <button type="button" class="add" @click=${() => void this.add()}>${icon("plus")}${words.add}</button>
      <datalist id="languages">${offered.map(({ tag, name }) => html`<option value=${tag} label=${name}></option>`)}</datalist>`;
  }

  private row({ language, label, description = "" }: LabelRow, index: number): TemplateResult {
    const name = nameOfLanguage(language);
    const wrong = this._wrong.includes(index);
    return html`<div>
      <input
        type="text"
        class="language"
        list="languages"
        maxlength="35"
        spellcheck="false"
        autocapitalize="off"
        aria-label=${words.language(index + 1)}
        aria-invalid=${wrong ? "true" : "false"}
        aria-describedby=${wrong ? "problem" : nothing}
        placeholder=${words.language_example}
        title=${name}
        .value=${language}
        @input=${(event: Event) => this.change(index, { language: (event.target as HTMLInputElement).value })}
        @change=${() => this.change(index, { language: wellWrittenTag(this._rows[index]!.language.trim()) ?? this._rows[index]!.language.trim() })}
      />
      <input
        type="text"
        maxlength="200"
        lang=${name ? language : nothing}
        aria-label=${words.label(name || language || words.language(index + 1))}
        placeholder=${name}
        .value=${label}
        @input=${(event: Event) => this.change(index, { label: (event.target as HTMLInputElement).value })}
      />
      <button type="button" class="icon quiet" aria-label=${words.remove(name || language)} title=${words.remove(name || language)} @click=${() => this.removeRow(index)}>
        ${icon("close")}
      </button>
      ${
        this.descriptions === null
          ? nothing
          : html`<textarea
            rows="2"
            maxlength="10000"
            lang=${name ? language : nothing}
            aria-label=${words.description(name || language || words.language(index + 1))}
            placeholder=${words.description(name || language || words.language(index + 1))}
            .value=${description}
            @input=${(event: Event) => this.change(index, { description: (event.target as HTMLTextAreaElement).value })}
          ></textarea>`
      }
    </div>`;
  }

  /** The descriptions for the labels of read(). */
  get writtenDescriptions(): Labels {
    return descriptionsOf(this._rows);
  }

  /** Returns the labels. If a row is invalid, shows the problem and returns null. */
  read(): Labels | null {
    this.tell("", []);
    const read = labelsOf(this._rows);
    if ("labels" in read) return read.labels;
    this.tell(words[read.wrong], [read.row]);
    return null;
  }

  /**
   * Shows the server's problem and marks the rows with an invalid language tag, because the server
   * refuses these tags.
   */
  refuse(problem: string): void {
    this.tell(
      problem,
      this._rows.flatMap(({ language, label }, index) =>
        label.trim() !== "" && !wellWrittenTag(language.trim()) ? index : [],
      ),
    );
  }

  private tell(problem: string, rows: number[]): void {
    this._problem = problem;
    this._wrong = rows;
    const [first] = rows;
    if (first !== undefined) this.languageInput(first)?.focus();
  }

  private languageInput(row: number): HTMLInputElement | null {
    return this.renderRoot.querySelectorAll<HTMLInputElement>("input.language")[row] ?? null;
  }

  private change(index: number, change: Partial<LabelRow>): void {
    if (this._wrong.includes(index)) this.tell("", []);
    this._rows = this._rows.map((row, at) => (at === index ? { ...row, ...change } : row));
  }

  private removeRow(index: number): void {
    this.tell("", []);
    this._rows = this._rows.filter((_, at) => at !== index);
  }

  private async add(): Promise<void> {
    this._rows = [...this._rows, { language: "", label: "" }];
    await this.updateComplete;
    this.languageInput(this._rows.length - 1)?.focus();
  }
}
