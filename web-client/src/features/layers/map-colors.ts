// <strata-map-colors>: the main colors of a scanned map, and the value of each. The parent element
// sets `rows`. The event "rows" contains the changed rows.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatFixed, readNumber } from "../../core/locale";
import type { Layer } from "../../core/types";
import { describeValue } from "../../session/layer-values";
import type { ColorRow } from "./map-file";
import { numberInput } from "../../ui/number-input";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.maps;

@customElement("strata-map-colors")
export class StrataMapColors extends LitElement {
  @property({ attribute: false }) layer!: Layer;
  @property({ attribute: false }) rows: readonly ColorRow[] = [];

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        max-height: 236px;
        overflow: auto;
      }
      table {
        width: 100%;
        border-collapse: collapse;
        font-size: var(--text-small);
      }
      th {
        padding: 0 var(--space-2) var(--space-1) 0;
        text-align: left;
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
      td {
        padding: var(--space-1) var(--space-2) var(--space-1) 0;
        border-top: var(--edge) solid var(--line);
      }
      label {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      tr.off td:not(:last-child) {
        color: var(--ink-soft);
      }
      tr.off .swatch {
        opacity: 0.5;
      }
      input[type="text"] {
        width: 84px;
        min-height: 32px;
        text-align: right;
      }
      .value {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
      }
    `,
  ];

  override render(): TemplateResult {
    return html`<table>
      <tr>
        <th scope="col">${words.color}</th>
        <th scope="col">${words.share}</th>
        <th scope="col">${words.gets}</th>
      </tr>
      ${this.rows.map((row, index) => this.row(row, index))}
    </table>`;
  }

  private row(row: ColorRow, index: number): TemplateResult {
    const number = readNumber(row.value);
    const said =
      Number.isFinite(number) && this.layer.palette.mode === "categorical"
        ? describeValue(this.layer, number)
        : "";
    return html`<tr class=${row.used ? "" : "off"}>
      <td>
        <label>
          <input
            type="checkbox"
            .checked=${row.used}
            @change=${(event: Event) => this.change(index, { used: (event.target as HTMLInputElement).checked })}
          />
          <span class="swatch" ${styled({ background: row.color })}></span><span>${row.color}</span>
        </label>
      </td>
      <td>${formatFixed(100 * row.share, 1)} %</td>
      <td>
        <span class="value">
          ${numberInput({
            label: words.value_of(row.color),
            value: row.value,
            disabled: !row.used,
            wrong: row.used && Number.isNaN(number),
            typed: (value) => this.change(index, { value }),
          })}
          <span class="ellipsis hint">${row.used ? said : words.left_out}</span>
        </span>
      </td>
    </tr>`;
  }

  private change(index: number, change: Partial<ColorRow>): void {
    const detail = this.rows.map((row, i) => (i === index ? { ...row, ...change } : row));
    this.dispatchEvent(new CustomEvent<ColorRow[]>("rows", { detail }));
  }
}
