// <strata-bill-proof>: the measured quantity of a position, and its lines of proof. A line opens the
// model of its element in a new tab, so the bill stays open.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatCount } from "../../core/locale";
import type { BillLine, BillPosition } from "../../core/protocol.gen";
import { shownDecimal } from "../../domain/bills";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.bills;
const kAtOnce = 200;

@customElement("strata-bill-proof")
export class StrataBillProof extends LitElement {
  @property({ attribute: false }) position!: BillPosition;
  @property() currency = "";
  /** Whether the quantities are out of date. */
  @property({ type: Boolean }) stale = false;
  @state() private _shown = kAtOnce;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
      }
      .sum {
        display: flex;
        flex-wrap: wrap;
        align-items: baseline;
        gap: var(--space-1) var(--space-4);
      }
      .sum b {
        font-size: var(--text-title-3);
      }
      .table {
        overflow-x: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
      }
      table {
        width: 100%;
        border-collapse: collapse;
        font-size: var(--text-small);
      }
      th,
      td {
        padding: var(--space-1) var(--space-2);
        text-align: start;
        vertical-align: top;
      }
      th {
        font-size: var(--text-tiny);
        color: var(--ink-soft);
        white-space: nowrap;
      }
      tr + tr td,
      tbody tr:first-child td {
        border-top: var(--edge) solid var(--line);
      }
      .amount {
        text-align: end;
        white-space: nowrap;
      }
      td > .hint {
        display: block;
      }
      .title {
        min-width: 8rem;
        overflow-wrap: anywhere;
      }
      .warn {
        color: var(--warn);
        font-size: var(--text-small);
      }
      button {
        justify-self: start;
      }
    `,
  ];

  override willUpdate(changed: Map<string, unknown>): void {
    if (changed.has("position")) this._shown = kAtOnce;
  }

  override render(): TemplateResult {
    const { position, currency } = this;
    const { lines } = position;
    return html`<div class="sum">
        <b>${shownDecimal(position.quantity)} ${position.unit}</b>
        ${position.tendered === undefined ? nothing : html`<span class="hint">${words.tendered(`${shownDecimal(position.tendered)} ${position.unit}`)}</span>`}
        ${position.total === undefined ? nothing : html`<span>${words.total}: ${shownDecimal(position.total)} ${currency}</span>`}
        ${this.stale ? html`<span class="warn">${words.stale}</span>` : nothing}
      </div>
      ${lines.length === 0 ? html`<p class="hint">${words.no_lines}</p>` : this.table(lines)}
      ${
        lines.length > this._shown
          ? html`<button type="button" @click=${() => (this._shown += kAtOnce)}>${words.more_lines(lines.length - this._shown)}</button>`
          : nothing
      }`;
  }

  private table(lines: readonly BillLine[]): TemplateResult {
    return html`<div class="table" tabindex="0" role="region" aria-label=${words.proof}>
      <table>
        <thead>
          <tr>
            <th scope="col">${words.element}</th>
            <th scope="col">${words.place}</th>
            <th scope="col" class="amount">${words.measured}</th>
            <th scope="col" class="amount">${words.factor}</th>
            <th scope="col" class="amount">${words.billed}</th>
          </tr>
        </thead>
        <tbody>
          ${lines.slice(0, this._shown).map((line) => this.line(line))}
        </tbody>
      </table>
    </div>`;
  }

  private line(line: BillLine): TemplateResult {
    const title = line.title || texts.unnamed;
    const more = [line.formula, line.remark, line.figure].filter(Boolean).join(" · ");
    const record = line.key === undefined ? "" : words.record(formatCount(line.key));
    return html`<tr>
      <td class="title">
        ${line.link ? html`<a class="text" target="_blank" rel="noopener" href=${line.link}>${title}</a>` : title}
        ${more ? html`<span class="hint">${more}</span>` : nothing}
      </td>
      <td>
        ${line.model_name ?? line.user ?? ""}
        ${line.layer_name ? html`<span class="hint">${[line.layer_name, record].filter(Boolean).join(" · ")}</span>` : nothing}
      </td>
      <td class="amount">${shownDecimal(line.measured)}</td>
      <td class="amount">${shownDecimal(line.factor)}</td>
      <td class="amount">
        ${shownDecimal(line.billed)}
        ${line.effect === "billed" ? nothing : html`<span class="hint">${words.effects[line.effect]}</span>`}
      </td>
    </tr>`;
  }
}
