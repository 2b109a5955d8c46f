// <strata-name-list>: the names that an expression can contain, in groups, with a search field. A
// click or Enter fires "insert" with a name. Escape fires "closed".

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { foundIn, type Name, type NameGroup } from "./expression-names";

const words = texts.expressions;

@customElement("strata-name-list")
export class StrataNameList extends LitElement {
  @property({ attribute: false }) groups: readonly NameGroup[] = [];
  @state() private _search = "";
  @state() private _active = 0;
  @query("input") private _input!: HTMLInputElement;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
        padding: var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--paper);
      }
      .list {
        max-height: 13rem;
        overflow: auto;
        overscroll-behavior: contain;
      }
      h4 {
        position: sticky;
        top: 0;
        margin: 0;
        padding: var(--space-2) var(--space-2) var(--space-1);
        background: var(--paper);
        color: var(--ink-soft);
        font-size: var(--text-tiny);
        font-weight: 600;
      }
      .option {
        display: grid;
        grid-template-columns: minmax(0, auto) minmax(0, 1fr) minmax(0, auto);
        align-items: baseline;
        gap: var(--space-3);
        padding: var(--space-1) var(--space-2);
        border-radius: var(--radius-small);
        font-size: var(--text-small);
        cursor: pointer;
      }
      .option:hover {
        background: var(--hover);
      }
      .option[aria-selected="true"] {
        background: var(--accent-soft);
      }
      .option code {
        font: var(--text-small) var(--mono);
        overflow-wrap: anywhere;
      }
      .option small {
        max-width: 11rem;
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
      @media (pointer: coarse) {
        .option {
          padding: var(--space-3) var(--space-2);
        }
      }
    `,
  ];

  override focus(): void {
    this._input.focus();
  }

  override render(): TemplateResult {
    const groups = foundIn(this.groups, this._search);
    const count = groups.reduce((sum, { names }) => sum + names.length, 0);
    const active = Math.min(this._active, count - 1);
    let index = 0;
    return html`<input
        type="text"
        role="combobox"
        aria-expanded="true"
        aria-controls="names"
        aria-activedescendant=${count > 0 ? `name-${active}` : ""}
        aria-label=${words.search}
        placeholder=${words.search}
        autocomplete="off"
        spellcheck="false"
        .value=${this._search}
        @input=${(event: Event) => {
          event.stopPropagation();
          this._search = (event.target as HTMLInputElement).value;
          this._active = 0;
        }}
        @keydown=${(event: KeyboardEvent) => this.onKey(event, groups, count)}
      />
      <div class="list" id="names" role="listbox" aria-label=${words.names}>
        ${groups.map(
          ({ title, names }, at) =>
            html`<div role="group" aria-labelledby="group-${at}">
              <h4 id="group-${at}">${title}</h4>
              ${names.map((name) => this.option(name, index++, active))}
            </div>`,
        )}
      </div>
      <p class="hint" role="status" ?hidden=${count > 0}>${words.no_name}</p>`;
  }

  private option(name: Name, index: number, active: number): TemplateResult {
    const { text, label, hint } = name;
    return html`<div
      class="option"
      id="name-${index}"
      role="option"
      aria-selected=${index === active ? "true" : "false"}
      @pointerdown=${(event: Event) => event.preventDefault()}
      @click=${() => this.insert(name)}
    >
      <code>${text}</code><span class="ellipsis">${label ?? ""}</span><small class="ellipsis" title=${hint}>${hint}</small>
    </div>`;
  }

  private insert(name: Name): void {
    this.dispatchEvent(new CustomEvent<Name>("insert", { detail: name }));
  }

  private onKey(event: KeyboardEvent, groups: readonly NameGroup[], count: number): void {
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 };
    const step = steps[event.key];
    if (event.key === "Escape") {
      this.dispatchEvent(new CustomEvent("closed"));
    } else if (event.key === "Enter") {
      const name = groups.flatMap(({ names }) => names)[Math.min(this._active, count - 1)];
      if (name) this.insert(name);
    } else if (step !== undefined && count > 0) {
      const next = this._active + step;
      this._active =
        Math.abs(step) === 1 ? (next + count) % count : Math.max(0, Math.min(count - 1, next));
      void this.updateComplete.then(() =>
        this.renderRoot
          .querySelector(`#name-${this._active}`)
          ?.scrollIntoView({ block: "nearest" }),
      );
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }
}
