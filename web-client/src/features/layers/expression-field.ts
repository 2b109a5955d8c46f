// <strata-expression-field>: a formula over layers, records and the surface, with completion of
// names and, while one writes, what it holds for or what is wrong with it. Fires `input` and, on
// Enter, `submitted`.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { label_of } from "../../domain/cells";
import {
  complete,
  marked_at,
  name_in_text,
  type Completion,
  type Suggestion,
} from "../../domain/completion";
import { format_area } from "../../domain/measure";
import { follow_session } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.expressions;
const kPause = 350; // ms without a key before the server is asked
const kSurface = ["x", "y", "z", "area", "nx", "ny", "nz", "height", "slope", "curvature"] as const;
const kNone: Completion = { from: 0, suggestions: [] };

@customElement("strata-expression-field")
export class StrataExpressionField extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property() label = "";
  @property() placeholder = "";
  /** Whether it may be a number, too; then normals and the like are there. */
  @property({ type: Boolean }) computes = false;
  @property() initial = "";

  @state() private completion_ = kNone;
  @state() private chosen_ = 0;
  @state() private told_ = "";
  @state() private problem_: { text: string; offset: number | null; message: string } | null = null;
  @query("textarea") private field_!: HTMLTextAreaElement;
  private timer_ = 0;
  private asked_ = 0;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        gap: 0.5rem;
      }
      .editor {
        position: relative;
      }
      textarea {
        font: 0.95rem var(--mono);
        resize: vertical;
      }
      ul {
        position: absolute;
        z-index: 3;
        inset: 100% 0 auto 0;
        margin: 2px 0 0;
        padding: 4px;
        list-style: none;
        border: var(--edge) solid var(--line-strong);
        border-radius: var(--radius-small);
        background: var(--paper);
        box-shadow: var(--shadow);
      }
      li {
        display: flex;
        justify-content: space-between;
        gap: 1rem;
        padding: 5px 0.5625rem;
        border-radius: var(--radius-small);
        font-size: 0.88rem;
        cursor: pointer;
      }
      li[aria-selected="true"] {
        background: var(--accent-soft);
      }
      li b {
        font: 0.88rem var(--mono);
      }
      li span {
        color: var(--ink-soft);
        white-space: nowrap;
        overflow: hidden;
        text-overflow: ellipsis;
      }
      pre {
        margin: 0;
        padding: 0.375rem 0.5625rem;
        white-space: pre-wrap;
        word-break: break-word;
        font: 0.86rem var(--mono);
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
    return this.field_?.value.trim() ?? "";
  }

  override focus(): void {
    this.field_.focus();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    window.clearTimeout(this.timer_);
    ++this.asked_;
  }

  override render(): TemplateResult {
    const { suggestions } = this.completion_;
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
            aria-activedescendant=${suggestions.length > 0 ? `name-${this.chosen_}` : ""}
            aria-invalid=${this.problem_ ? "true" : "false"}
            @input=${this.on_input}
            @keydown=${this.on_key}
            @blur=${() => (this.completion_ = kNone)}
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
                    aria-selected=${index === this.chosen_ ? "true" : "false"}
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
      ${this.problem_ ? this.told_problem(this.problem_) : nothing}
      <p class="hint" role="status" ?hidden=${this.told_ === ""}>${this.told_}</p>`;
  }

  private told_problem({
    text,
    offset,
    message,
  }: {
    text: string;
    offset: number | null;
    message: string;
  }): TemplateResult {
    const [before, at, after] = marked_at(text, offset ?? 0);
    return html`${offset === null ? nothing : html`<pre aria-hidden="true">${before}<mark>${at}</mark>${after}</pre>`}
      <p class="error" role="alert">${message}</p>`;
  }

  /** A problem that the server told of the text as a whole. */
  refuse(error: ApiError): void {
    this.problem_ = {
      text: this.value,
      offset: error.problem.offset ?? null,
      message: error.message,
    };
    this.told_ = "";
    this.focus();
  }

  private names(): Suggestion[] {
    const names: Suggestion[] = [];
    for (const layer of this.session.layers.all) {
      const slug = name_in_text(layer.slug);
      names.push({ text: slug, hint: layer.name });
      if (layer.table === undefined) continue;
      for (const column of this.session.tables.find(layer.table)?.columns ?? [])
        names.push({
          text: `${slug}.${name_in_text(column.slug)}`,
          hint: words.column(label_of(column), layer.name),
        });
    }
    const surface = this.computes ? kSurface : kSurface.slice(0, 4);
    for (const name of surface) names.push({ text: name, hint: words.surface[name] });
    for (const [text, hint] of words.functions) names.push({ text, hint });
    return names;
  }

  private on_input(event: Event): void {
    event.stopPropagation();
    this.completion_ = complete(this.field_.value, this.field_.selectionStart, this.names());
    this.chosen_ = 0;
    this.problem_ = null;
    window.clearTimeout(this.timer_);
    this.timer_ = window.setTimeout(() => void this.preview(), kPause);
    this.dispatchEvent(new CustomEvent("input"));
  }

  private on_key(event: KeyboardEvent): void {
    const count = this.completion_.suggestions.length;
    if (count > 0 && (event.key === "ArrowDown" || event.key === "ArrowUp")) {
      this.chosen_ = (this.chosen_ + (event.key === "ArrowDown" ? 1 : count - 1)) % count;
    } else if (count > 0 && (event.key === "Tab" || event.key === "Enter")) {
      this.accept(this.chosen_);
    } else if (count > 0 && event.key === "Escape") {
      event.stopPropagation();
      this.completion_ = kNone;
    } else if (event.key === "Enter" && !event.shiftKey) {
      this.dispatchEvent(new CustomEvent("submitted"));
    } else {
      return;
    }
    event.preventDefault();
  }

  private accept(index: number): void {
    const suggestion = this.completion_.suggestions[index];
    if (!suggestion) return;
    this.field_.setRangeText(
      suggestion.text,
      this.completion_.from,
      this.field_.selectionStart,
      "end",
    );
    this.field_.dispatchEvent(new Event("input"));
    this.completion_ = kNone;
    this.focus();
  }

  /** Asks the server for what it holds; of a number, where it is known. */
  private async preview(): Promise<void> {
    const text = this.value;
    const asked = ++this.asked_;
    this.told_ = "";
    if (text === "") return;
    let tried = await this.try_out(text, words.holds, 0);
    if (this.computes && tried.error?.message.startsWith(kWantsCondition))
      tried = await this.try_out(`(${text}) is not null`, words.known, 1);
    if (asked !== this.asked_) return;
    const { error, told, before } = tried;
    this.told_ = told;
    if (!error || error.status !== 422 || (this.computes && is_for_computing(error))) return;
    const { offset } = error.problem;
    const message = error.message.replace(
      /\(at character (\d+)\)/,
      (_, n: string) => `(at character ${Number(n) - before})`,
    );
    this.problem_ = {
      text,
      offset: offset === undefined ? null : Math.max(0, offset - before),
      message,
    };
  }

  /** `before`: characters that stand before the person's own text. */
  private async try_out(
    where: string,
    in_words: (area: string) => string,
    before: number,
  ): Promise<{ error?: ApiError; told: string; before: number }> {
    const { api, model_id } = this.session;
    try {
      return { told: in_words(format_area((await api.select(model_id, where)).area_m2)), before };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return { error, told: "", before };
    }
  }
}

const kWantsCondition = "A condition is wanted, not a number";
/** What only a computed layer can have cannot be tried out before it is made. */
const is_for_computing = (error: ApiError): boolean =>
  kSurface.slice(4).some((name) => error.message.startsWith(`'${name}' of the surface`));
