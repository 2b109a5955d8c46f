// <strata-class-changes>: the area of each class that became each class between two surveys, and the
// pieces that appeared and vanished.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { readNumber } from "../../core/locale";
import type {
  ChangedPiece,
  ChangedPieces,
  LayerChanges,
  LayerChangesRequest,
  Survey,
} from "../../core/protocol.gen";
import { completeLayer, type Job, type Layer, type Model } from "../../core/types";
import { labelOf } from "../../domain/cells";
import type { WorkbookQuery } from "../../domain/workbooks";
import { formatArea, formatNumber, metresPer } from "../../domain/measure";
import { colorOf, cssColor } from "../../domain/palette";
import {
  changeTable,
  inOrder,
  likelyToleranceMm,
  sumOf,
  type ChangeKey,
} from "../../domain/survey-changes";
import { toldSurveyDate } from "../../domain/surveys";
import { ApiError } from "../../net/api-error";
import { followJob, jobIsOver } from "../../net/follow-job";
import { followSession } from "../../session/follow-session";
import { stepOf } from "../../session/layer-jobs";
import { describeValue } from "../../session/layer-values";
import type { ModelSession } from "../../session/model-session";
import { numberInput } from "../../ui/number-input";
import { styled } from "../../ui/styled";
import { saveFrom } from "../../ui/save-from";
import { workbookButtons, workbookQuery } from "../../ui/workbook-buttons";
import { filesStyles, formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { changesStyles } from "./changes-styles";

const words = texts.surveys.changes;
const kMostPieces = 50; // in each list
const kAround = 0.1; // size of the surroundings of a piece, as a share of the model's size

interface Compared {
  body: LayerChangesRequest;
  changes: LayerChanges;
  then: { survey: Survey; layer: Layer };
  now: { survey: Survey; layer: Layer };
  unit: Model["unit"]; // of the later survey
}

@customElement("strata-class-changes")
export class StrataClassChanges extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _with: number | null = null; // the model of the other survey
  @state() private _job: Job | null = null;
  @state() private _busy = false;
  @state() private _compared: Compared | null = null;
  @state() private _problem = "";
  @query("form") private _form!: HTMLFormElement;
  private _asked = 0;

  constructor() {
    super();
    followSession(this, "surveys", "tables");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    filesStyles,
    changesStyles,
    css`
      .pieces {
        display: grid;
        gap: var(--space-half);
        max-height: 12rem;
        margin: 0;
        padding: 0;
        overflow: auto;
        list-style: none;
      }
      .pieces button {
        display: flex;
        gap: var(--space-2);
        align-items: center;
        width: 100%;
        border-color: transparent;
        background: none;
        text-align: start;
      }
      h3 {
        font: 600 var(--text-large) var(--serif);
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.get("layer") && changed.get("layer")?.id !== this.layer.id) this.reset();
  }
  /** A closed dialog computes nothing. */
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.reset();
  }

  private get other(): Survey | null {
    const { surveys } = this.session;
    const chosen = this._with ?? surveys.other?.survey.model;
    return surveys.others.find(({ model }) => model === chosen) ?? surveys.others[0] ?? null;
  }

  private reset(): void {
    this._asked += 1;
    const job = this._job;
    this._compared = this._job = null;
    this._busy = false;
    this._problem = "";
    if (job) void this.cancel(job);
  }

  private async cancel(job: Job): Promise<void> {
    try {
      await this.session.api.send("DELETE /jobs/{job}", { path: { job: job.id } });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // 409: the job has just ended
    }
  }

  override render(): TemplateResult {
    const { surveys, model, canPaint } = this.session;
    const { other } = this;
    if (!other || !model) return html`<p>${words.no_other}</p>`;
    const percent = Math.round((this._job?.progress ?? 0) * 100);
    return html`<p class="hint">${words.lead}</p>
      <form id="changes" novalidate @submit=${this.onSubmit}>
        <label class="field">
          <span>${words.since}</span>
          <select name="since" @change=${(event: Event) => this.choose(Number((event.target as HTMLSelectElement).value))}>
            ${surveys.others.map((each) => html`<option value=${each.model} ?selected=${each.model === other.model}>${toldSurveyDate(each.date)}</option>`)}
          </select>
        </label>
        <label class="field">
          <span>${words.tolerance}</span>
          ${numberInput({ name: "tolerance", value: likelyToleranceMm(model), min: 0, wrong: false })}
        </label>
        <label class="field">
          <span>${words.min_area}</span>
          ${numberInput({ name: "min_area", value: 0, min: 0, wrong: false })}
        </label>
        <button class="primary" ?disabled=${this._busy || !canPaint}>${words.compare}</button>
      </form>
      ${canPaint ? nothing : html`<p class="hint">${words.not_allowed}</p>`}
      ${
        this._busy
          ? html`<progress aria-label=${words.progress} max="100" value=${percent}></progress>
            <span class="hint">${this._job ? stepOf(this._job) : ""}</span>
            <button type="button" @click=${() => this.reset()}>${words.stop}</button>`
          : nothing
      }
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${this._compared ? this.result(this._compared) : nothing}`;
  }

  private choose(model: number): void {
    this.reset();
    this._with = model;
  }

  private readonly onSubmit = (event: Event): void => {
    event.preventDefault();
    const form = new FormData(this._form);
    const tolerance = readNumber(String(form.get("tolerance")));
    const minArea = readNumber(String(form.get("min_area")));
    this.reset();
    if (!(tolerance > 0)) this._problem = texts.shape.bad_length;
    else if (!(minArea >= 0)) this._problem = words.bad_area;
    else void this.compare(tolerance, minArea);
  };

  private async compare(toleranceMm: number, minAreaCm2: number): Promise<void> {
    const { api, surveys } = this.session;
    const { other } = this;
    const { current, object } = surveys;
    if (!other || !current || !object) return;
    const asked = ++this._asked;
    const isAsked = (): boolean => asked === this._asked;
    this._busy = true;
    try {
      const [all, otherModel] = await Promise.all([
        api.all("GET /models/{model}/layers", "layers", { path: { model: other.model } }),
        api.json("GET /models/{model}", { path: { model: other.model } }),
      ]);
      if (!isAsked()) return;
      const found = all.find(({ name }) => name === this.layer.name);
      if (!found) {
        this._problem = words.no_such_layer(labelOf(this.layer), toldSurveyDate(other.date));
        return;
      }
      const sides = new Map<Survey, Layer>([
        [current, this.layer],
        [other, completeLayer(found)],
      ]);
      const [earlier, later] = inOrder(object.surveys, current, other);
      const [then, now] = [sides.get(earlier)!, sides.get(later)!];
      const body: LayerChangesRequest = {
        since: String(earlier.model),
        layer: String(then.id),
        tolerance_mm: toleranceMm,
        min_area_cm2: minAreaCm2,
      };
      const last = await this.run(later, now, body, {}, isAsked);
      if (last?.changes)
        this._compared = {
          body,
          changes: last.changes,
          then: { survey: earlier, layer: then },
          now: { survey: later, layer: now },
          unit: later === current ? this.session.model!.unit : otherModel.unit,
        };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (isAsked()) this._problem = error.message;
    } finally {
      if (isAsked()) [this._busy, this._job] = [false, null];
    }
  }

  /** Runs the comparison. Returns null if it was canceled, and shows its problem if it failed. */
  private async run(
    { model }: Survey,
    { id }: Layer,
    body: LayerChangesRequest,
    query: Partial<WorkbookQuery>,
    isAsked: () => boolean,
  ): Promise<Job | null> {
    const { api } = this.session;
    const job = await api.json("POST /models/{model}/layers/{layer}/changes", {
      path: { model, layer: id },
      body,
      query,
    });
    const last = await followJob(api, job, (state) => {
      if (isAsked()) this._job = state;
      else if (!jobIsOver(state)) void this.cancel(state);
    });
    if (!isAsked()) return null;
    if (last.problem) this._problem = last.problem.detail ?? last.problem.title;
    return last;
  }

  /** The server makes the file with another comparison, because it keeps no results. */
  private async save({ body, now }: Compared, f: WorkbookQuery["f"]): Promise<void> {
    if (this._busy) return;
    const asked = ++this._asked;
    const isAsked = (): boolean => asked === this._asked;
    this._busy = true;
    this._problem = "";
    try {
      const last = await this.run(now.survey, now.layer, body, workbookQuery(f), isAsked);
      if (last?.file)
        saveFrom(
          this.session.api.url("GET /jobs/{job}/file", { path: { job: last.id } }),
          last.file.name,
        );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (isAsked()) this._problem = error.message;
    } finally {
      if (isAsked()) [this._busy, this._job] = [false, null];
    }
  }

  private name(layer: Layer, key: ChangeKey): string {
    if (key === null) return words.unpainted;
    if (key === "unmatched") return words.unmatched;
    return describeValue(layer, key, this.session.tables);
  }
  private swatch(layer: Layer, key: ChangeKey): TemplateResult | typeof nothing {
    if (typeof key !== "number") return nothing;
    const color = colorOf(layer.palette, key);
    return html`<i class="swatch" ${styled({ background: color ? cssColor(color) : "var(--line-strong)" })}></i>`;
  }

  private result(compared: Compared): TemplateResult {
    const { changes, then, now, unit } = compared;
    const { rows, columns, areaM2 } = changeTable(changes);
    const [before, after] = [then, now].map(({ survey }) => toldSurveyDate(survey.date));
    const cm2 = (area: number): string => (area > 0 ? formatNumber(area * 1e4, 4) : "");
    const share =
      changes.area_m2 > 0 ? formatNumber((100 * changes.matched_m2) / changes.area_m2, 3) : "0";
    const caption = words.table(before!, after!);
    return html`<p class="hint" role="status">${words.matched(`${share} %`)}</p>
      ${
        rows.length === 0
          ? html`<p>${words.nothing}</p>`
          : html`<p class="caption">${caption}</p>
            <div class="row" role="group" aria-label=${caption}>
              ${workbookButtons({ what: caption, rows: () => this.copied(compared), save: (f) => void this.save(compared, f) })}
            </div>
            <div class="scroller" tabindex="0" role="region" aria-label=${caption}>
              <table>
                <thead>
                  <tr>
                    <th scope="col">${before} → ${after}</th>
                    ${columns.map((key) => html`<th scope="col">${this.swatch(now.layer, key)}${this.name(now.layer, key)}</th>`)}
                    <th scope="col">${words.sum}</th>
                  </tr>
                </thead>
                <tbody>
                  ${rows.map(
                    (key, row) =>
                      html`<tr>
                        <th scope="row">${this.swatch(then.layer, key)}${this.name(then.layer, key)}</th>
                        ${columns.map((to, column) => html`<td class=${to === key ? "same" : ""}>${cm2(areaM2[row]![column]!)}</td>`)}
                        <td class="sum">${cm2(sumOf(areaM2[row]!))}</td>
                      </tr>`,
                  )}
                  <tr class="sum">
                    <th scope="row">${words.sum}</th>
                    ${columns.map((_, column) => html`<td>${cm2(sumOf(areaM2.map((row) => row[column]!)))}</td>`)}
                    <td>${cm2(sumOf(areaM2.map(sumOf)))}</td>
                  </tr>
                </tbody>
              </table>
            </div>`
      }
      ${this.pieces(words.appeared, changes.appeared, now.layer, unit)}
      ${this.pieces(words.vanished, changes.vanished, then.layer, unit)}`;
  }

  /** Returns the table as texts for a spreadsheet, in cm². */
  private copied({ changes, then, now }: Compared): string[][] {
    const { rows, columns, areaM2 } = changeTable(changes);
    return [
      ["cm²", ...columns.map((key) => this.name(now.layer, key))],
      ...rows.map((key, row) => [
        this.name(then.layer, key),
        ...areaM2[row]!.map((area) => formatNumber(area * 1e4, 4)),
      ]),
    ];
  }

  private pieces(
    title: (n: number, area: string) => string,
    { pieces, total, area_m2: area }: ChangedPieces,
    layer: Layer,
    unit: Model["unit"],
  ): TemplateResult {
    return html`<h3>${title(total, formatArea(area))}</h3>
      <ul class="pieces">
        ${pieces.slice(0, kMostPieces).map((piece) => {
          const name = this.name(layer, piece.value);
          return html`<li>
            <button type="button" title=${words.fly} @click=${() => this.fly(piece, unit)}>
              ${this.swatch(layer, piece.value)}<span class="grow ellipsis">${name}</span>
              <span>${formatArea(piece.area_m2)}</span>
            </button>
          </li>`;
        })}
      </ul>
      ${total > kMostPieces ? html`<p class="hint">${words.largest(kMostPieces)}</p>` : nothing}`;
  }

  private fly({ at, area_m2: area }: ChangedPiece, unit: Model["unit"]): void {
    const { view, model } = this.session;
    if (!model) return;
    const { min, max } = view.camera.bounds;
    const metres = metresPer(model.unit);
    const size = Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
    const half = Math.max(Math.sqrt(area) / metres, (size * kAround) / 2);
    const [x, y, z] = at.map((each) => (each * metresPer(unit)) / metres);
    view.flyTo({
      min: [x! - half, y! - half, z! - half],
      max: [x! + half, y! + half, z! + half],
    });
  }
}
