// <strata-survey-statistics>: the areas or values of a layer in each survey of the object, as a table
// and as curves over the dates.

import { css, html, LitElement, nothing, svg, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { pageLocale } from "../../core/locale";
import type { SurveyLayerStatistics, SurveyStatistics } from "../../core/protocol.gen";
import { holdsFractions, type Layer } from "../../core/types";
import { formatNumber } from "../../domain/measure";
import { colorOf, cssColor } from "../../domain/palette";
import { classArea, classesOf, datedPlot, type DatedCurve } from "../../domain/survey-changes";
import { toldSurveyDate } from "../../domain/surveys";
import type { WorkbookQuery } from "../../domain/workbooks";
import { ApiError } from "../../net/api-error";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { saveFrom } from "../../ui/save-from";
import { styled } from "../../ui/styled";
import { filesStyles, sharedStyles } from "../../ui/styles";
import { workbookButtons, workbookQuery } from "../../ui/workbook-buttons";
import { texts } from "../../texts";
import { changesStyles } from "./changes-styles";

const words = texts.surveys.changes;
const kMostClasses = 12;
const kPlot = { width: 480, height: 150, margin: 8 };
const kCall = "GET /projects/{project}/objects/{object}/statistics";

/** A column after the date. `of` returns undefined if a survey has no such number. */
interface Column {
  name: string;
  color?: string;
  of: (statistics: SurveyLayerStatistics) => number | undefined;
}

const inCm2 = (areaM2: number | undefined): number | undefined =>
  areaM2 === undefined ? undefined : areaM2 * 1e4;

@customElement("strata-survey-statistics")
export class StrataSurveyStatistics extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _read: readonly SurveyStatistics[] = []; // sorted by date
  @state() private _reading = false;
  @state() private _problem = "";
  private _asked: AbortController | null = null;

  constructor() {
    super();
    followSession(this, "surveys");
  }

  static override styles = [
    sharedStyles,
    filesStyles,
    changesStyles,
    css`
      svg {
        display: block;
        width: 100%;
        border-bottom: var(--edge) solid var(--line-strong);
      }
      .ends {
        display: flex;
        justify-content: space-between;
        font-size: var(--text-small);
        color: var(--ink-soft);
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("layer") && changed.get("layer")?.id !== this.layer.id) void this.read();
  }
  /** A closed dialog needs no result, so the server stops. */
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._asked?.abort();
  }

  private get path(): { project: string; object: number } | null {
    const { model, surveys } = this.session;
    return model && surveys.object ? { project: model.project, object: surveys.object.id } : null;
  }

  private async read(): Promise<void> {
    this._asked?.abort();
    const asked = (this._asked = new AbortController());
    const { path } = this;
    this._read = [];
    this._problem = "";
    if (!path) return;
    this._reading = true;
    try {
      const { surveys } = await this.session.api.json(kCall, {
        path,
        query: { layer: this.layer.name, lang: pageLocale() },
        signal: asked.signal,
      });
      if (asked === this._asked) this._read = surveys;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked === this._asked && !asked.signal.aborted) this._problem = error.message;
    } finally {
      if (asked === this._asked) this._reading = false;
    }
  }

  private save(f: WorkbookQuery["f"]): void {
    const { path } = this;
    if (!path) return;
    const query = { layer: this.layer.name, ...workbookQuery(f) };
    saveFrom(this.session.api.url(kCall, { path, query }), `${this.layer.slug}-surveys.${f}`);
  }

  private get isMeasured(): boolean {
    const { type, kind, palette } = this.layer;
    return holdsFractions(type) || (kind !== "database" && palette.mode !== "categorical");
  }

  override render(): TemplateResult {
    return html`${this._reading ? html`<p class="hint" role="status">${texts.loading}</p>` : nothing}
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${this._read.length > 0 ? this.table() : nothing} ${this._read.length > 1 ? this.plot() : nothing}`;
  }

  private columns(): Column[] {
    const { layer } = this;
    const area: Column = { name: words.area, of: ({ area_m2: m2 }) => inCm2(m2) };
    if (this.isMeasured) {
      const unit = layer.unit ? ` (${layer.unit})` : "";
      return [
        area,
        { name: texts.statistics.mean + unit, of: ({ mean }) => mean },
        { name: texts.statistics.min + unit, of: ({ min }) => min },
        { name: texts.statistics.max + unit, of: ({ max }) => max },
      ];
    }
    return [area, ...this.classColumns()];
  }

  private classColumns(): (Column & { color: string })[] {
    return classesOf(this._read, kMostClasses).map(({ name, key }) => ({
      name,
      color: this.color(key),
      of: (statistics: SurveyLayerStatistics) => inCm2(classArea(statistics, name)),
    }));
  }

  private color(key: number): string {
    const color = colorOf(this.layer.palette, key);
    return color ? cssColor(color) : "var(--line-strong)";
  }

  private table(): TemplateResult {
    const columns = this.columns();
    const caption = this.isMeasured ? words.statistics : words.statistics_of_classes;
    const swatch = (color: string | undefined): TemplateResult | typeof nothing =>
      color ? html`<i class="swatch" ${styled({ background: color })}></i>` : nothing;
    return html`<p class="caption">${caption}</p>
      <div class="row" role="group" aria-label=${caption}>
        ${workbookButtons({ what: caption, rows: () => this.copied(columns), save: (f) => this.save(f) })}
      </div>
      <div class="scroller" tabindex="0" role="region" aria-label=${caption}>
        <table>
          <thead>
            <tr>
              <th scope="col">${words.date}</th>
              ${columns.map(({ name, color }) => html`<th scope="col">${swatch(color)}${name}</th>`)}
            </tr>
          </thead>
          <tbody>
            ${this._read.map(
              ({ date, statistics }) =>
                html`<tr>
                  <th scope="row">${toldSurveyDate(date)}</th>
                  ${columns.map((column) => html`<td>${this.cell(column, statistics)}</td>`)}
                </tr>`,
            )}
          </tbody>
        </table>
      </div>`;
  }

  private cell({ of }: Column, statistics: SurveyLayerStatistics | null): string {
    const value = statistics ? of(statistics) : undefined;
    return value === undefined ? "–" : formatNumber(value, 4);
  }

  /** Returns the table as texts for a spreadsheet. */
  private copied(columns: readonly Column[]): string[][] {
    return [
      [words.date, ...columns.map(({ name }) => name)],
      ...this._read.map(({ date, statistics }) => [
        toldSurveyDate(date),
        ...columns.map((column) => this.cell(column, statistics)),
      ]),
    ];
  }

  private curves(): DatedCurve[] {
    const values = (of: Column["of"]): (number | null)[] =>
      this._read.map(({ statistics }) => (statistics ? (of(statistics) ?? null) : null));
    if (this.isMeasured) return [{ color: "var(--accent)", values: values(({ mean }) => mean) }];
    return this.classColumns().map(({ color, of }) => ({ color, values: values(of) }));
  }

  private plot(): TemplateResult {
    const { width, height, margin } = kPlot;
    const dates = this._read.map(({ date }) => date);
    const { paths, least, most } = datedPlot(dates, this.curves(), width, height);
    const unit = this.isMeasured ? this.layer.unit : "cm²";
    const caption = this.isMeasured ? words.plot_of_mean : words.plot_of_areas;
    const range = [least, most].map((value) => formatNumber(value, 3)).join(" – ");
    return html`<div>
      <p class="caption">${caption}: ${range} ${unit}</p>
      <svg role="img" aria-label=${caption} viewBox="${-margin} ${-margin} ${width + 2 * margin} ${height + 2 * margin}">
        ${paths.map(
          ({ color, d, points }) =>
            svg`<path d=${d} fill="none" stroke=${color} stroke-width="2"></path>
              ${points.map(([x, y]) => svg`<circle cx=${x} cy=${y} r="4" fill=${color}></circle>`)}`,
        )}
      </svg>
      <div class="ends">
        <span>${toldSurveyDate(dates[0]!)}</span>
        <span>${toldSurveyDate(dates[dates.length - 1]!)}</span>
      </div>
    </div>`;
  }
}
