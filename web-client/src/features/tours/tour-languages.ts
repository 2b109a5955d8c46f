// <strata-tour-languages>: the languages of a tour. The first one is the default.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { kCommonLanguages, languageInWords } from "../../core/languages";
import { compareWords } from "../../core/locale";
import { kMostLanguages } from "../../domain/tours";
import { addFrom, addFromStyles } from "../../ui/add-from";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tours;
const offered = kCommonLanguages
  .map((tag) => ({ value: tag, name: languageInWords(tag) }))
  .sort((a, b) => compareWords(a.name, b.name));

@customElement("strata-tour-languages")
export class StrataTourLanguages extends LitElement {
  @property({ attribute: false }) languages: readonly string[] = [];

  static override styles = [
    sharedStyles,
    addFromStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
      }
      ul {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: inline-flex;
        align-items: center;
        gap: var(--space-1);
        padding-left: var(--space-3);
        border-radius: var(--radius-round);
        background: var(--accent-soft);
        font-size: var(--text-small);
      }
      li:only-child {
        padding: var(--space-2) var(--space-3);
      }
      li small {
        color: var(--ink-soft);
      }
      li button.icon {
        width: 1.875rem;
        min-height: var(--control-small);
        border-radius: 50%;
      }
      .add select {
        flex: 0 1 15rem;
      }
      @media (pointer: coarse) {
        li button.icon {
          width: 2.5rem;
          min-height: 2.5rem;
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { languages } = this;
    const others = offered.filter(({ value }) => !languages.includes(value));
    return html`<span class="caption" id="caption">${words.languages}</span>
      <ul aria-labelledby="caption">
        ${languages.map((tag, index) => this.chip(tag, index))}
      </ul>
      ${
        languages.length < kMostLanguages
          ? addFrom(words.language_add, others, (tag) => this.put([...languages, tag]))
          : nothing
      }`;
  }

  private chip(tag: string, index: number): TemplateResult {
    const name = languageInWords(tag);
    if (this.languages.length === 1) return html`<li>${name}</li>`;
    return html`<li>
      ${name}
      ${
        index === 0
          ? html`<small>${words.first_language}</small>`
          : html`<button type="button" class="icon quiet" aria-label=${words.make_first(name)} title=${words.make_first(name)} @click=${() => this.put([tag, ...this.languages.filter((each) => each !== tag)])}>
            ${icon("up")}
          </button>`
      }
      <button type="button" class="icon quiet" aria-label=${words.language_remove(name)} title=${words.language_remove(name)} @click=${() => this.dispatchEvent(new CustomEvent<string>("remove", { detail: tag }))}>
        ${icon("close")}
      </button>
    </li>`;
  }

  private put(languages: readonly string[]): void {
    this.dispatchEvent(new CustomEvent<readonly string[]>("chosen", { detail: languages }));
  }
}
