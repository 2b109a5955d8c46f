// <strata-expression-field>: an expression over layers, records and the surface. It has a list of
// names to insert, and completes typed names.
// While the user types, it shows the matching area, or the problem with its position and
// corrections. With `lights` it also highlights the area in the 3D view.
// It fires `input`, `submitted` on Enter, and `measured` with the area or null.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { SelectResponse } from "../../core/protocol.gen";
import { formatPercent } from "../../core/locale";
import {
  classNumbers,
  complete,
  corrected,
  type Completion,
  type Mistake,
} from "../../domain/completion";
import { formatArea } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import {
  expressionProblem,
  expressionProblemStyles,
  type Correction,
} from "../../session/fields/expression-problem";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import {
  examplesFor,
  nameGroups,
  namedClasses,
  withName,
  type Example,
  type Name,
  type NameGroup,
} from "./expression-names";
import "./name-list";
import type { StrataNameList } from "./name-list";

const words = texts.expressions;
const kPause = 350; // milliseconds after the last key press
const kNone: Completion = { from: 0, suggestions: [] };

interface Problem {
  text: string;
  message: string;
  mistake: Mistake | null;
}

@customElement("strata-expression-field")
export class StrataExpressionField extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property() label = "";
  /**
   * Whether the expression may also be a number. If so, it can also use the names that work only in
   * computed layers, such as normals.
   */
  @property({ type: Boolean }) computes = false;
  @property() initial = "";
  /** Whether the area is highlighted in the 3D view. */
  @property({ type: Boolean }) lights = false;

  @state() private _completion = kNone;
  @state() private _chosen = 0;
  @state() private _told = "";
  @state() private _problem: Problem | null = null;
  @state() private _listed = false;
  @query("textarea") private _field!: HTMLTextAreaElement;
  @query("strata-name-list") private _list!: StrataNameList | null;
  private _timer = 0;
  private _running: AbortController | null = null;

  constructor() {
    super();
    followSession(this, "layers", "tables", "lit");
  }

  static override styles = [
    sharedStyles,
    expressionProblemStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
      }
      .editor {
        position: relative;
      }
      textarea {
        font: var(--text-body) var(--mono);
        resize: vertical;
      }
      .editor ul {
        position: absolute;
        z-index: 3;
        inset: 100% 0 auto 0;
        margin: var(--space-half) 0 0;
        padding: var(--space-1);
        list-style: none;
        border: var(--edge) solid var(--line-strong);
        border-radius: var(--radius-small);
        background: var(--paper);
        box-shadow: var(--shadow);
      }
      .editor li {
        display: flex;
        justify-content: space-between;
        gap: var(--space-4);
        padding: var(--space-1) var(--space-2);
        border-radius: var(--radius-small);
        font-size: var(--text-small);
        cursor: pointer;
      }
      .editor li[aria-selected="true"] {
        background: var(--accent-soft);
      }
      .editor li b {
        font: var(--text-small) var(--mono);
      }
      .editor li span {
        color: var(--ink-soft);
        white-space: nowrap;
        overflow: hidden;
        text-overflow: ellipsis;
      }
      .tools {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-2) var(--space-3);
      }
      .tools button .glyph {
        transition: rotate var(--fast);
      }
      .tools button[aria-expanded="true"] .glyph {
        rotate: 90deg;
      }
      .examples {
        display: grid;
        gap: var(--space-half);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      .examples button {
        display: grid;
        grid-template-columns: minmax(0, 2fr) minmax(0, 3fr);
        gap: var(--space-1) var(--space-4);
        width: 100%;
        min-height: 0;
        padding: var(--space-1) var(--space-2);
        text-align: left;
        white-space: normal;
        justify-content: stretch;
        align-items: baseline;
        font-size: var(--text-small);
      }
      .examples code {
        font: var(--text-small) var(--mono);
        overflow-wrap: anywhere;
      }
      .examples span {
        color: var(--ink-soft);
      }
      @media (pointer: coarse) {
        .examples button {
          padding: var(--space-3) var(--space-2);
        }
      }
    `,
  ];

  get value(): string {
    return this._field?.value.trim() ?? "";
  }

  override focus(): void {
    this._field.focus();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    window.clearTimeout(this._timer);
    this._running?.abort();
    if (this.lights) this.session.lit.clear();
  }

  override render(): TemplateResult {
    const { suggestions } = this._completion;
    const examples = examplesFor(this.namesOf, this.session.model);
    return html`<div class="editor">
        <label class="field">
          <span>${this.label}</span>
          <textarea
            rows="2"
            maxlength="4096"
            required
            spellcheck="false"
            autocapitalize="off"
            autocomplete="off"
            placeholder=${examples[0]?.text ?? ""}
            .value=${this.initial}
            role="combobox"
            aria-expanded=${suggestions.length > 0 ? "true" : "false"}
            aria-controls="completions"
            aria-activedescendant=${suggestions.length > 0 ? `completion-${this._chosen}` : ""}
            aria-invalid=${this._problem ? "true" : "false"}
            @input=${this.onInput}
            @keydown=${this.onKey}
            @blur=${() => (this._completion = kNone)}
          ></textarea>
        </label>
        ${
          suggestions.length === 0
            ? nothing
            : html`<ul id="completions" role="listbox" aria-label=${words.names}>
              ${suggestions.map(
                ({ text, hint }, index) =>
                  html`<li
                    id="completion-${index}"
                    role="option"
                    aria-selected=${index === this._chosen ? "true" : "false"}
                    @pointerdown=${(event: Event) => {
                      event.preventDefault();
                      this.accept(index);
                    }}
                  >
                    <b>${text}</b><span>${hint}</span>
                  </li>`,
              )}
            </ul>`
        }
      </div>
      ${this._problem ? this.toldProblem(this._problem) : nothing}
      <p class="hint" role="status" ?hidden=${this._told === ""}>${this._told}</p>
      <div class="tools">
        <button type="button" aria-expanded=${this._listed ? "true" : "false"} @click=${() => void this.toggleList()}>
          ${icon("chevron")}${words.insert}
        </button>
      </div>
      ${
        this._listed
          ? html`<strata-name-list
            .groups=${this.groups()}
            @insert=${(event: CustomEvent<Name>) => this.insert(event.detail)}
            @closed=${() => {
              this._listed = false;
              this.focus();
            }}
          ></strata-name-list>`
          : this.examples(examples)
      }`;
  }

  private examples(examples: readonly Example[]): TemplateResult {
    return html`<div>
      <p class="caption" id="examples">${words.examples.title}</p>
      <ul class="examples" aria-labelledby="examples">
        ${examples.map(
          ({ text, does }) =>
            html`<li>
              <button type="button" class="quiet" title=${words.examples.take} @click=${() => this.put(text, text.length)}>
                <code>${text}</code><span>${does}</span>
              </button>
            </li>`,
        )}
      </ul>
    </div>`;
  }

  private toldProblem({ text, message, mistake }: Problem): TemplateResult {
    return expressionProblem({
      text,
      message,
      mistake,
      corrections: mistake ? this.corrections(text, mistake) : [],
      correct: (by) => {
        // the problem refers to the text without leading and trailing spaces
        const fixed = mistake ? corrected(text, mistake, by) : text;
        this.put(fixed, fixed.length);
      },
    });
  }

  private corrections(text: string, mistake: Mistake): Correction[] {
    const suggested = (mistake.suggestions ?? []).map((each) => ({ text: each }));
    if (suggested.length > 0) return suggested;
    return classNumbers(text, mistake, namedClasses(this.session.layers.all)).map(
      ({ value, label }) => ({ text: String(value), hint: label }),
    );
  }

  /** Shows a problem that the server reported for the whole text. */
  refuse(error: ApiError): void {
    this._problem = this.problemOf(error);
    this._told = "";
    this.focus();
  }

  private problemOf({ message, problem }: ApiError, text = this.value): Problem {
    const { offset, length, suggestions } = problem;
    return {
      text,
      message,
      mistake: offset === undefined ? null : { offset, length, suggestions },
    };
  }

  private get namesOf(): Parameters<typeof nameGroups>[0] {
    const { layers, tables } = this.session;
    return { layers: layers.all, table: (id) => tables.find(id), computes: this.computes };
  }

  private groups(): NameGroup[] {
    return nameGroups(this.namesOf);
  }

  private async toggleList(): Promise<void> {
    this._listed = !this._listed;
    await this.updateComplete;
    if (this._listed) this._list?.focus();
    else this.focus();
  }

  private insert(name: Name): void {
    const { value, selectionStart, selectionEnd } = this._field;
    const { text, caret } = withName(value, [selectionStart, selectionEnd], name);
    this.put(text, caret);
  }

  private put(text: string, caret: number): void {
    this._field.value = text;
    this.focus();
    this._field.setSelectionRange(caret, caret);
    this.textChanged();
    this._completion = kNone;
  }

  private onInput(event: Event): void {
    event.stopPropagation();
    const names = this.groups().flatMap((group) =>
      group.names.map(({ text, label, hint }) => ({
        text,
        hint: [label, hint].filter(Boolean).join(" · "),
      })),
    );
    this._completion = complete(this._field.value, this._field.selectionStart, names);
    this._chosen = 0;
    this.textChanged();
  }

  private textChanged(): void {
    this._problem = null;
    window.clearTimeout(this._timer);
    this._timer = window.setTimeout(() => void this.preview(), kPause);
    this.dispatchEvent(new CustomEvent("input"));
    this.tellMeasured(null);
  }

  private tellMeasured(measured: SelectResponse | null): void {
    this.dispatchEvent(new CustomEvent<SelectResponse | null>("measured", { detail: measured }));
  }

  private onKey(event: KeyboardEvent): void {
    const count = this._completion.suggestions.length;
    if (count > 0 && (event.key === "ArrowDown" || event.key === "ArrowUp")) {
      this._chosen = (this._chosen + (event.key === "ArrowDown" ? 1 : count - 1)) % count;
    } else if (count > 0 && (event.key === "Tab" || event.key === "Enter")) {
      this.accept(this._chosen);
    } else if (count > 0 && event.key === "Escape") {
      event.stopPropagation();
      this._completion = kNone;
    } else if (event.key === "Enter" && !event.shiftKey) {
      this.dispatchEvent(new CustomEvent("submitted"));
    } else {
      return;
    }
    event.preventDefault();
  }

  private accept(index: number): void {
    const suggestion = this._completion.suggestions[index];
    if (!suggestion) return;
    this._field.setRangeText(
      suggestion.text,
      this._completion.from,
      this._field.selectionStart,
      "end",
    );
    this._field.dispatchEvent(new Event("input"));
    this._completion = kNone;
    this.focus();
  }

  /** Requests the area where a condition is true, or where a number has a value. */
  private async preview(): Promise<void> {
    const text = this.value;
    this._running?.abort();
    const running = (this._running = new AbortController());
    this._told = "";
    if (text === "") {
      if (this.lights) this.session.lit.clear();
      return;
    }
    try {
      const { area, told } = await this.measure(text, running.signal);
      if (running.signal.aborted) return;
      this._told = told(formatArea(area.area_m2), formatPercent(area.share));
      this.tellMeasured(area);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (running.signal.aborted || error.status === 499) return;
      // the server cannot test names that are only for computed layers before the layer exists
      const unknown = this.computes && error.problem.reason === "computed_layers_only";
      if (!unknown) this._problem = this.problemOf(error, text);
    }
  }

  private async measure(
    text: string,
    signal: AbortSignal,
  ): Promise<{ area: SelectResponse; told: (area: string, share: string) => string }> {
    try {
      return { area: await this.select(text, signal), told: words.holds };
    } catch (error) {
      const isNumber =
        error instanceof ApiError && error.problem.reason === "expects_condition" && this.computes;
      if (!isNumber) throw error;
      // the text is added at the end, so the positions of mistakes do not change
      return { area: await this.select(`${text}\nis not null`, signal), told: words.known };
    }
  }

  private select(where: string, signal: AbortSignal): Promise<SelectResponse> {
    const { api, modelId, lit } = this.session;
    if (this.lights) return lit.show({ where });
    return api.json("POST /models/{model}/select", {
      path: { model: modelId },
      body: { where },
      signal,
    });
  }
}
