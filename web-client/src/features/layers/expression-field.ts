// <strata-expression-field>: an expression over layers, records and the surface, with completion of
// names. During typing it shows the matching area, or the problem. Fires `input` and, on Enter,
// `submitted`.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { labelOf } from "../../domain/cells";
import {
  complete,
  markedAt,
  nameInText,
  type Completion,
  type Suggestion,
} from "../../domain/completion";
import { formatArea } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.expressions;
const kPause = 350; // ms after the last key press
const kSurface = ["x", "y", "z", "area", "nx", "ny", "nz", "height", "slope", "curvature"] as const;
const kNone: Completion = { from: 0, suggestions: [] };

@customElement("strata-expression-field")
export class StrataExpressionField extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property() label = "";
  @property() placeholder = "";
  /** Whether the expression may also be a number; then it may contain normals and similar names. */
  @property({ type: Boolean }) computes = false;
  @property() initial = "";

  @state() private _completion = kNone;
  @state() private _chosen = 0;
  @state() private _told = "";
  @state() private _problem: { text: string; offset: number | null; message: string } | null = null;
  @query("textarea") private _field!: HTMLTextAreaElement;
  private _timer = 0;
  private _asked = 0;

  constructor() {
    super();
    followSession(this, "layers", "tables");
  }

  static override styles = [
    sharedStyles,
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
      ul {
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
      li {
        display: flex;
        justify-content: space-between;
        gap: var(--space-4);
        padding: var(--space-1) var(--space-2);
        border-radius: var(--radius-small);
        font-size: var(--text-small);
        cursor: pointer;
      }
      li[aria-selected="true"] {
        background: var(--accent-soft);
      }
      li b {
        font: var(--text-small) var(--mono);
      }
      li span {
        color: var(--ink-soft);
        white-space: nowrap;
        overflow: hidden;
        text-overflow: ellipsis;
      }
      pre {
        margin: 0;
        padding: var(--space-2) var(--space-2);
        white-space: pre-wrap;
        word-break: break-word;
        font: var(--text-small) var(--mono);
        border-radius: var(--radius-small);
        background: var(--calm-soft);
      }
      mark {
        background: none;
        color: inherit;
        text-decoration: underline wavy var(--danger) 2px;
        white-space: pre;
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
    ++this._asked;
  }

  override render(): TemplateResult {
    const { suggestions } = this._completion;
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
            placeholder=${this.placeholder}
            .value=${this.initial}
            role="combobox"
            aria-expanded=${suggestions.length > 0 ? "true" : "false"}
            aria-controls="names"
            aria-activedescendant=${suggestions.length > 0 ? `name-${this._chosen}` : ""}
            aria-invalid=${this._problem ? "true" : "false"}
            @input=${this.onInput}
            @keydown=${this.onKey}
            @blur=${() => (this._completion = kNone)}
          ></textarea>
        </label>
        ${
          suggestions.length === 0
            ? nothing
            : html`<ul id="names" role="listbox" aria-label=${words.names}>
              ${suggestions.map(
                ({ text, hint }, index) =>
                  html`<li
                    id="name-${index}"
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
      <p class="hint" role="status" ?hidden=${this._told === ""}>${this._told}</p>`;
  }

  private toldProblem({
    text,
    offset,
    message,
  }: {
    text: string;
    offset: number | null;
    message: string;
  }): TemplateResult {
    const [before, at, after] = markedAt(text, offset ?? 0);
    return html`${offset === null ? nothing : html`<pre aria-hidden="true">${before}<mark>${at}</mark>${after}</pre>`}
      <p class="error" role="alert">${message}</p>`;
  }

  /** Shows a problem that the server reported for the whole text. */
  refuse(error: ApiError): void {
    this._problem = {
      text: this.value,
      offset: error.problem.offset ?? null,
      message: error.message,
    };
    this._told = "";
    this.focus();
  }

  private names(): Suggestion[] {
    const names: Suggestion[] = [];
    for (const layer of this.session.layers.all) {
      const slug = nameInText(layer.slug);
      names.push({ text: slug, hint: layer.name });
      if (layer.table === undefined) continue;
      for (const column of this.session.tables.find(layer.table)?.columns ?? [])
        names.push({
          text: `${slug}.${nameInText(column.slug)}`,
          hint: words.column(labelOf(column), layer.name),
        });
    }
    const surface = this.computes ? kSurface : kSurface.slice(0, 4);
    for (const name of surface) names.push({ text: name, hint: words.surface[name] });
    for (const [text, hint] of words.functions) names.push({ text, hint });
    return names;
  }

  private onInput(event: Event): void {
    event.stopPropagation();
    this._completion = complete(this._field.value, this._field.selectionStart, this.names());
    this._chosen = 0;
    this._problem = null;
    window.clearTimeout(this._timer);
    this._timer = window.setTimeout(() => void this.preview(), kPause);
    this.dispatchEvent(new CustomEvent("input"));
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

  /** Asks the server for the area where the text is true; for a number, where it has a value. */
  private async preview(): Promise<void> {
    const text = this.value;
    const asked = ++this._asked;
    this._told = "";
    if (text === "") return;
    let tried = await this.tryOut(text, words.holds, 0);
    if (this.computes && tried.error?.message.startsWith(kWantsCondition))
      tried = await this.tryOut(`(${text}) is not null`, words.known, 1);
    if (asked !== this._asked) return;
    const { error, told, before } = tried;
    this._told = told;
    if (!error || error.status !== 422 || (this.computes && isForComputing(error))) return;
    const { offset } = error.problem;
    const message = error.message.replace(
      /\(at character (\d+)\)/,
      (_, n: string) => `(at character ${Number(n) - before})`,
    );
    this._problem = {
      text,
      offset: offset === undefined ? null : Math.max(0, offset - before),
      message,
    };
  }

  /** `before`: number of characters before the person's own text. */
  private async tryOut(
    where: string,
    inWords: (area: string) => string,
    before: number,
  ): Promise<{ error?: ApiError; told: string; before: number }> {
    const { api, modelId } = this.session;
    try {
      return {
        told: inWords(
          formatArea(
            (
              await api.json("POST /models/{model}/select", {
                path: { model: modelId },
                body: { where },
              })
            ).area_m2,
          ),
        ),
        before,
      };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return { error, told: "", before };
    }
  }
}

const kWantsCondition = "Expected a condition, not a number";
/** Names that only computed layers can use cannot be tried out before the layer exists. */
const isForComputing = (error: ApiError): boolean =>
  kSurface.slice(4).some((name) => error.message.startsWith(`'${name}' of the surface`));
