// <strata-survey-bar>: the dates of the surveys of the object. A date opens its survey. The bar also
// shows another survey next to the open one, and opens the dialog of the changes.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { toldSurveyDate } from "../../domain/surveys";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { hasKeyboard } from "../../ui/keyboard";
import { radioGroup } from "../../ui/radio-group";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.surveys;

@customElement("strata-survey-bar")
export class StrataSurveyBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @query("[role=radio][aria-checked=true]") private _chosen!: HTMLElement | null;
  private _shown: HTMLElement | null = null;

  constructor() {
    super();
    followSession(this, "surveys");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        z-index: 3;
        bottom: calc(0.875rem + var(--past-height, 0px));
        left: 50%;
        width: max-content;
        max-width: max(min(20rem, 100% - 1.5rem), 100% - 26rem);
        transform: translateX(-50%);
      }
      section {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        padding: var(--space-1) var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      .dates {
        display: flex;
        gap: var(--space-1);
        min-width: 0;
        overflow-x: auto;
        scrollbar-width: thin;
      }
      .dates button {
        flex: none;
        padding-inline: var(--space-3);
        border-color: transparent;
        background: none;
      }
      .dates button[aria-checked="true"] {
        background: var(--accent);
        color: var(--accent-ink);
      }
      select {
        flex: 0 1 auto;
        width: auto;
        min-width: 5rem;
        max-width: 15rem;
      }
      @media (max-width: 820px) {
        :host {
          top: 3.5rem; /* below the scale bar */
          bottom: auto;
          left: 0.75rem;
          max-width: calc(100% - 5.5rem); /* left of the bar on the stage */
          transform: none;
        }
      }
    `,
  ];

  /** Shows the date of the open survey. After a change of the survey, the focus stays in the bar. */
  override updated(): void {
    const { surveys } = this.session;
    if (this._chosen && this._chosen !== this._shown) {
      this._shown = this._chosen;
      this._shown.scrollIntoView({ block: "nearest", inline: "nearest" });
    }
    if (!surveys.takesFocus || !this._chosen) return;
    surveys.takesFocus = false;
    if (hasKeyboard() === null) this._chosen.focus();
  }

  override render(): TemplateResult | typeof nothing {
    const { surveys } = this.session;
    const { object, current } = surveys;
    if (!object || !current || object.surveys.length < 2) return nothing;
    return html`<section aria-label=${words.title(object.name)}>
      ${radioGroup({
        label: words.dates,
        class: "dates",
        choices: object.surveys.map((survey) => ({
          value: survey,
          content: toldSurveyDate(survey.date),
          title: survey.name,
        })),
        chosen: current,
        // A click with the pointer takes the focus from the button (model-page).
        choose: (survey) =>
          surveys.open(survey, this.shadowRoot?.activeElement instanceof HTMLButtonElement),
      })}
      <select
        aria-label=${words.compare}
        title=${words.compare}
        @change=${(event: Event) => this.compare((event.target as HTMLSelectElement).value)}
      >
        <option value="" ?selected=${surveys.other === null}>${words.alone}</option>
        ${surveys.others.map(
          (survey) =>
            html`<option value=${survey.model} ?selected=${survey.model === surveys.other?.survey.model}>
              ${words.beside(toldSurveyDate(survey.date))}
            </option>`,
        )}
      </select>
      <button @click=${() => this.dispatchEvent(new CustomEvent("request", { detail: { dialog: "changes" } }))}>
        ${words.changes.open}
      </button>
    </section>`;
  }

  private compare(model: string): void {
    const { surveys } = this.session;
    surveys.compareWith(surveys.others.find((survey) => String(survey.model) === model) ?? null);
  }
}
