// <strata-cross-table>: the area that each class of one layer shares with each class of another.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { WorkbookQuery } from "../../domain/workbooks";
import { labelOf } from "../../domain/cells";
import { formatArea } from "../../domain/measure";
import type { Agreement, CrossTable } from "../../core/protocol.gen";
import { holdsFractions, type Layer } from "../../core/types";
import { describeValue } from "../../session/layer-values";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { saveBlob } from "../../ui/save-from";
import { copyButton, workbookButtons, workbookQuery } from "../../ui/workbook-buttons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { agreementSummary, kMostClasses } from "./agreement-summary";

const words = texts.cross_table;
const kMostShown = 40; // the largest number of rows and of columns shown; files contain all

/** Returns whether a cross-table can count the layer's classes. */
export const hasClasses = (layer: Layer): boolean => !holdsFractions(layer.type);

@customElement("strata-cross-table")
export class StrataCrossTable extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _with: Layer | null = null;
  @state() private _table: CrossTable | null = null;
  @state() private _problem = "";

  constructor() {
    super();
    followSession(this, "layers", "tables");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
        padding-top: var(--space-3);
        border-top: var(--edge) solid var(--line);
      }
      h3,
      h4 {
        font: 600 var(--text-large) var(--serif);
      }
      .scroller {
        max-height: 22rem;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
      }
      table {
        border-collapse: collapse;
        font-size: var(--text-small);
      }
      th,
      td {
        padding: var(--space-2) var(--space-2);
        border-bottom: var(--edge) solid var(--line);
        text-align: end;
        white-space: nowrap;
      }
      th {
        font-weight: 600;
      }
      thead th {
        position: sticky;
        top: 0;
        background: var(--paper);
      }
      th[scope="row"],
      thead th:first-child {
        text-align: start;
      }
      .sum {
        font-weight: 600;
      }
      .none {
        color: var(--ink-soft);
      }
      .row {
        flex-wrap: wrap;
      }
    `,
  ];

  private get others(): Layer[] {
    return [...this.session.layers.all]
      .reverse()
      .filter((layer) => layer.id !== this.layer.id && hasClasses(layer));
  }

  override render(): TemplateResult {
    const { others, _with: other } = this;
    return html`<h3>${words.title}</h3>
      ${
        others.length === 0
          ? html`<p class="hint">${words.no_other}</p>`
          : html`<label class="field">
            <span>${words.other}</span>
            <select @change=${(event: Event) => void this.choose(Number((event.target as HTMLSelectElement).value))}>
              <option value="0" ?selected=${other === null}>${words.choose}</option>
              ${others.map((layer) => html`<option value=${layer.id} ?selected=${layer.id === other?.id}>${labelOf(layer)}</option>`)}
            </select>
          </label>`
      }
      ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
      ${other && !this._table && !this._problem ? html`<p class="hint" role="status">${texts.loading}</p>` : nothing}
      ${other && this._table ? this.table(other, this._table) : nothing}`;
  }

  private async choose(id: number): Promise<void> {
    const other = this.others.find((layer) => layer.id === id) ?? null;
    this._with = other;
    this._table = null;
    this._problem = "";
    if (!other) return;
    try {
      const table = await this.session.api.json("POST /models/{model}/cross-table", {
        path: { model: this.session.modelId },
        body: { rows: this.layer.id, columns: other.id },
      });
      if (this._with === other) this._table = table;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (this._with === other) this._problem = error.message;
    }
  }

  private name(layer: Layer, key: number | null): string {
    return key === null
      ? words.nothing(labelOf(layer))
      : describeValue(layer, key, this.session.tables);
  }

  /** Returns the displayed and copied rows, with sums. */
  private rows(other: Layer, { rows, columns, area_m2: areaM2 }: CrossTable): string[][] {
    const sum = (numbers: readonly number[]): number =>
      numbers.reduce((all, each) => all + each, 0);
    const shown = (area: number): string => (area > 0 ? formatArea(area) : "");
    const lines = rows.map((key, row) => [
      this.name(this.layer, key),
      ...areaM2[row]!.map(shown),
      shown(sum(areaM2[row]!)),
    ]);
    const sums = columns.map((_, column) => sum(areaM2.map((row) => row[column]!)));
    return [
      [
        `${labelOf(this.layer)} / ${labelOf(other)}`,
        ...columns.map((key) => this.name(other, key)),
        words.sum,
      ],
      ...lines,
      [words.sum, ...sums.map(shown), shown(sum(sums))],
    ];
  }

  private table(other: Layer, table: CrossTable): TemplateResult {
    if (table.rows.length === 0) return html`<p class="hint">${words.empty}</p>`;
    const all = this.rows(other, table);
    const what = words.of(labelOf(this.layer), labelOf(other));
    const cut = <T>(list: readonly T[]): T[] =>
      list.length > kMostShown
        ? [...list.slice(0, kMostShown - 1), list[list.length - 1]!]
        : [...list];
    const [head, ...lines] = cut(all).map(cut);
    return html`<div class="row" role="group" aria-label=${what}>
        ${workbookButtons({ what, rows: () => all, save: (f) => void this.save(other, f) })}
      </div>
      ${this.grid(what, head!, lines, true)}
      ${all.length > kMostShown || all[0]!.length > kMostShown ? html`<p class="hint">${words.cut(kMostShown)}</p>` : nothing}
      <h4>${words.agreement.title}</h4>
      ${table.agreement ? this.agreement(other, table.agreement) : html`<p class="hint">${words.agreement.none}</p>`}`;
  }

  private agreement(other: Layer, agreement: Agreement): TemplateResult {
    const { title, cut } = words.agreement;
    const { tables } = this.session;
    const { sentences, rows, isCut } = agreementSummary(agreement, this.layer, other, tables);
    return html`${sentences.map((sentence) => html`<p>${sentence}</p>`)}
      <div class="row" role="group" aria-label=${title}>${copyButton({ what: title, rows: () => rows })}</div>
      ${this.grid(title, rows[0]!, rows.slice(1), false)}
      ${isCut ? html`<p class="hint">${cut(kMostClasses)}</p>` : nothing}`;
  }

  /** With `hasSums`, the last row and the last column contain sums. */
  private grid(
    what: string,
    head: readonly string[],
    lines: readonly (readonly string[])[],
    hasSums: boolean,
  ): TemplateResult {
    return html`<div class="scroller" tabindex="0" role="region" aria-label=${what}>
      <table>
        <thead>
          <tr>${head.map((cell) => html`<th scope="col">${cell}</th>`)}</tr>
        </thead>
        <tbody>
          ${lines.map(
            (line, row) =>
              html`<tr class=${hasSums && row === lines.length - 1 ? "sum" : ""}>${line.map((cell, at) => (at === 0 ? html`<th scope="row">${cell}</th>` : html`<td class=${hasSums && at === line.length - 1 ? "sum" : ""}>${cell}</td>`))}</tr>`,
          )}
        </tbody>
      </table>
    </div>`;
  }

  private async save(other: Layer, f: WorkbookQuery["f"]): Promise<void> {
    this._problem = "";
    try {
      const sheet = await this.session.api.blob("POST /models/{model}/cross-table", {
        path: { model: this.session.modelId },
        body: { rows: this.layer.id, columns: other.id },
        query: workbookQuery(f),
      });
      saveBlob(sheet, `${this.layer.slug}-${other.slug}.${f}`);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }
}
