// <strata-where-dialog>: fills, or erases, a layer where a condition over the layers holds.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../core/api";
import { format_area } from "../core/measure";
import type { Layer } from "../core/types";
import "./dialog";
import { follow_session } from "./follow-session";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { radio_group } from "./radio-group";
import { shared_styles } from "./styles";
import { texts } from "./texts";
import "./value-picker";

@customElement("strata-where-dialog")
export class StrataWhereDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private erases_ = false;
  @state() private problem_ = "";
  @state() private working_ = false;
  @query("textarea") private condition_!: HTMLTextAreaElement;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      form {
        display: grid;
        gap: 14px;
      }
      textarea {
        font: 0.95rem var(--mono);
        resize: vertical;
      }
      .names {
        display: flex;
        flex-wrap: wrap;
        gap: 6px;
      }
      .names button {
        min-height: 30px;
        padding: 0 10px;
        font: 0.86rem var(--mono);
      }
      dl {
        display: grid;
        grid-template-columns: auto 1fr;
        gap: 4px 16px;
        margin: 0;
        font-size: 0.88rem;
      }
      dt {
        font-family: var(--mono);
      }
      dd {
        margin: 0;
        color: var(--ink-soft);
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.areas;
    const { session, layer } = this;
    return html`<strata-dialog heading=${words.where_title(layer.name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="where" @submit=${(event: Event) => this.on_submit(event)}>
        <p class="hint">${words.where_lead}</p>
        <label class="field">
          <span>${words.condition}</span>
          <textarea
            rows="2"
            maxlength="4096"
            required
            spellcheck="false"
            autocapitalize="off"
            placeholder=${words.condition_example}
            aria-invalid=${this.problem_ ? "true" : "false"}
            @keydown=${(event: KeyboardEvent) => this.on_key(event)}
          ></textarea>
        </label>
        ${this.problem_ ? html`<p class="error" role="alert">${this.problem_}</p>` : nothing}
        <div class="names" role="group" aria-label=${words.insert}>
          ${session.layers.all.map(
            ({ slug, name }) =>
              html`<button type="button" title=${name} @click=${() => this.insert(name_in_text(slug))}>${name_in_text(slug)}</button>`,
          )}
        </div>
        <dl>${words.grammar.map(([text, does]) => html`<dt>${text}</dt><dd>${does}</dd>`)}</dl>
        ${radio_group<boolean>({
          label: words.does,
          class: "segments",
          choices: [
            { value: false, content: words.paints },
            { value: true, content: words.erases },
          ],
          chosen: this.erases_,
          choose: (chosen) => (this.erases_ = chosen),
        })}
        ${this.erases_
          ? nothing
          : html`<strata-value-picker
              .session=${session}
              .layer=${layer}
              .value=${session.painting.brush.value_of(layer)}
            ></strata-value-picker>`}
      </form>
      <button slot="actions" class="primary" form="where" ?disabled=${this.working_} @click=${() => void this.apply()}>
        ${this.erases_ ? words.apply_erase : words.apply}
      </button>
    </strata-dialog>`;
  }

  private insert(text: string): void {
    const field = this.condition_;
    field.setRangeText(text, field.selectionStart, field.selectionEnd, "end");
    field.focus();
  }

  private on_key(event: KeyboardEvent): void {
    if (event.key !== "Enter" || event.shiftKey) return;
    event.preventDefault();
    void this.apply();
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    void this.apply();
  }

  private async apply(): Promise<void> {
    const where = this.condition_.value.trim();
    if (where === "" || this.working_) {
      this.condition_.focus();
      return;
    }
    const { session, layer } = this;
    const paint = this.erases_ ? { erase: true } : { value: session.painting.brush.value_of(layer) };
    this.working_ = true;
    this.problem_ = "";
    try {
      const { texels_changed, area_m2 } = await session.api.edit(session.model_id, layer.id, { op: "fill", ...paint, mode: "where", where });
      if (texels_changed === 0) notices.show("info", texts.areas.nothing_changed);
      else notices.show("success", texts.areas.changed(format_area(area_m2)));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      this.problem_ = error instanceof ApiError ? error.message : texts.problems.unexpected;
      this.condition_.focus();
    } finally {
      this.working_ = false;
    }
  }
}

const kWords = new Set(["and", "or", "not", "true", "false", "valid", "if", "min", "max", "abs"]);

/** A layer's slug as an expression names it. */
export const name_in_text = (slug: string): string => (/^[a-z_]/.test(slug) && !kWords.has(slug) ? slug : `"${slug}"`);
