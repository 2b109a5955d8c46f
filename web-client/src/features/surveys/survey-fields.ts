// <strata-survey-fields>: the object of which the open model is a survey, and the date of the
// survey, for curators.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { SurveyedObject } from "../../core/protocol.gen";
import type { Model } from "../../core/types";
import { isSurveyDate, toldSurveyDate } from "../../domain/surveys";
import type { ModelSession } from "../../session/model-session";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { surveyPatch } from "./survey-patch";

const words = texts.surveys;

@customElement("strata-survey-fields")
export class StrataSurveyFields extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) model!: Model;
  @state() private _objects: readonly SurveyedObject[] | null = null;
  @state() private _problem = "";
  @state() private _said = "";
  @state() private _busy = false;
  @query("input[name=object]") private _name!: HTMLInputElement;
  @query("input[name=date]") private _date!: HTMLInputElement;

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      form {
        grid-template-columns: minmax(0, 1fr) minmax(0, 11rem) auto;
        align-items: end;
      }
      p {
        margin: var(--space-2) 0 0;
      }
      @media (max-width: 620px) {
        form {
          grid-template-columns: minmax(0, 1fr);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private async load(): Promise<void> {
    try {
      this._objects = await this.session.api.all("GET /projects/{project}/objects", "objects", {
        path: { project: this.model.project },
      });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  override render(): TemplateResult {
    const { model, _objects: objects } = this;
    if (!objects)
      return this._problem
        ? html`<p class="error" role="alert">${this._problem}</p>`
        : html`<p class="hint" role="status">${texts.loading}</p>`;
    const own = objects.find(({ id }) => id === model.object);
    return html`<form @submit=${this.onSubmit} @input=${this.onInput}>
        <label class="field">
          <span>${words.object}</span>
          <input type="text" name="object" list="objects" maxlength="200" autocomplete="off" .defaultValue=${own?.name ?? ""} placeholder=${words.object_hint} />
          <datalist id="objects">${objects.map(({ name }) => html`<option value=${name}></option>`)}</datalist>
        </label>
        <label class="field">
          <span>${words.date}</span>
          <input type="text" name="date" maxlength="10" autocomplete="off" aria-describedby="date-hint" .defaultValue=${model.survey_date ?? ""} placeholder="2019-05-01" />
        </label>
        <button ?disabled=${this._busy}>${words.save}</button>
      </form>
      <p class="hint" id="date-hint">${words.date_hint}</p>
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <p class="hint" role="status" ?hidden=${!this._said}>${this._said}</p>`;
  }

  private readonly onInput = (): void => {
    this._problem = this._said = "";
  };

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    if (!this._busy)
      void this.save({ name: this._name.value.trim(), date: this._date.value.trim() });
  };

  private async save(survey: { name: string; date: string }): Promise<void> {
    // Before the page creates an object, which would stay after a refused date.
    if (survey.name !== "" && !isSurveyDate(survey.date)) {
      this._problem = words.date_needed;
      this._date.focus();
      return;
    }
    this._busy = true;
    this._problem = this._said = "";
    try {
      const { session, model } = this;
      await session.changeModel(
        await surveyPatch(session.api, model.project, this._objects ?? [], survey),
      );
      this._said =
        survey.name === "" ? words.left : words.saved(survey.name, toldSurveyDate(survey.date));
      await Promise.all([this.load(), session.surveys.load()]);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}
