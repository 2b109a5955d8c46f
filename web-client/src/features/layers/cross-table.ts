// <strata-cross-table>: how much surface each class of one layer has in common with each class of
// another.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError, type SheetQuery } from "../../net/api";
import { label_of } from "../../domain/cells";
import { format_area } from "../../domain/measure";
import type { CrossTable } from "../../core/protocol.gen";
import { holds_fractions, type Layer } from "../../core/types";
import { describe_value } from "../../session/layer-values";
import { follow_session } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { save_blob } from "../../ui/save-from";
import { sheet_buttons, sheet_query } from "../../ui/workbook-buttons";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.cross_table;
const kMostShown = 40; // rows and columns: the files have all

/** Layers that have classes which can be counted against those of another. */
export const has_classes = (layer: Layer): boolean => !holds_fractions(layer.type);

@customElement("strata-cross-table")
export class StrataCrossTable extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private with_: Layer | null = null;
  @state() private table_: CrossTable | null = null;
  @state() private problem_ = "";

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: 0.625rem;
        padding-top: 0.875rem;
        border-top: var(--edge) solid var(--line);
      }
      h3 {
        font: 600 1rem var(--serif);
      }
      .scroller {
        max-height: 22rem;
        overflow: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
      }
      table {
        border-collapse: collapse;
        font-size: 0.88rem;
      }
      th,
      td {
        padding: 0.375rem 0.625rem;
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
      .filter((layer) => layer.id !== this.layer.id && has_classes(layer));
  }

  override render(): TemplateResult {
    const { others, with_: other } = this;
    return html`<h3>${words.title}</h3>
      ${
        others.length === 0
          ? html`<p class="hint">${words.no_other}</p>`
          : html`<label class="field">
            <span>${words.other}</span>
            <select @change=${(event: Event) => void this.choose(Number((event.target as HTMLSelectElement).value))}>
              <option value="0" ?selected=${other === null}>${words.choose}</option>
              ${others.map((layer) => html`<option value=${layer.id} ?selected=${layer.id === other?.id}>${label_of(layer)}</option>`)}
            </select>
          </label>`
      }
      ${this.problem_ ? html`<p class="error" role="alert">${this.problem_}</p>` : nothing}
      ${other && !this.table_ && !this.problem_ ? html`<p class="hint" role="status">${texts.loading}</p>` : nothing}
      ${other && this.table_ ? this.table(other, this.table_) : nothing}`;
  }

  private async choose(id: number): Promise<void> {
    const other = this.others.find((layer) => layer.id === id) ?? null;
    this.with_ = other;
    this.table_ = null;
    this.problem_ = "";
    if (!other) return;
    try {
      const table = await this.session.api.cross_table(
        this.session.model_id,
        this.layer.id,
        other.id,
      );
      if (this.with_ === other) this.table_ = table;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (this.with_ === other) this.problem_ = error.message;
    }
  }

  private name(layer: Layer, key: number | null): string {
    return key === null
      ? words.nothing(label_of(layer))
      : describe_value(layer, key, this.session.tables);
  }

  /** As it is read, and copied: with sums. */
  private rows(other: Layer, { rows, columns, area_m2 }: CrossTable): string[][] {
    const sum = (numbers: readonly number[]): number =>
      numbers.reduce((all, each) => all + each, 0);
    const shown = (area: number): string => (area > 0 ? format_area(area) : "");
    const lines = rows.map((key, row) => [
      this.name(this.layer, key),
      ...area_m2[row]!.map(shown),
      shown(sum(area_m2[row]!)),
    ]);
    const sums = columns.map((_, column) => sum(area_m2.map((row) => row[column]!)));
    return [
      [
        `${label_of(this.layer)} / ${label_of(other)}`,
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
    const what = words.of(label_of(this.layer), label_of(other));
    const cut = <T>(list: readonly T[]): T[] =>
      list.length > kMostShown
        ? [...list.slice(0, kMostShown - 1), list[list.length - 1]!]
        : [...list];
    const [head, ...lines] = cut(all).map(cut);
    return html`<div class="row" role="group" aria-label=${what}>
        ${sheet_buttons({ what, rows: () => all, save: (f) => void this.save(other, f) })}
      </div>
      <div class="scroller" tabindex="0" role="region" aria-label=${what}>
        <table class="numeric">
          <thead>
            <tr>${head!.map((cell) => html`<th scope="col">${cell}</th>`)}</tr>
          </thead>
          <tbody>
            ${lines.map(
              (line, row) =>
                html`<tr class=${row === lines.length - 1 ? "sum" : ""}>${line.map((cell, at) => (at === 0 ? html`<th scope="row">${cell}</th>` : html`<td class=${at === line.length - 1 ? "sum" : ""}>${cell}</td>`))}</tr>`,
            )}
          </tbody>
        </table>
      </div>
      ${all.length > kMostShown || all[0]!.length > kMostShown ? html`<p class="hint">${words.cut(kMostShown)}</p>` : nothing}`;
  }

  private async save(other: Layer, f: SheetQuery["f"]): Promise<void> {
    this.problem_ = "";
    try {
      const sheet = await this.session.api.cross_table_sheet(
        this.session.model_id,
        this.layer.id,
        other.id,
        sheet_query(f),
      );
      save_blob(sheet, `${this.layer.slug}-${other.slug}.${f}`);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    }
  }
}
