// <strata-report-fields>: the rows of a report's title block. It adds, moves and removes rows.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { kMostFields, type FieldInput } from "../../domain/reports";
import { moved } from "../../domain/tours";
import { icon } from "../../ui/icons";
import { OrderButtons } from "../../ui/order/order-buttons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { Problems } from "./report-problems";

const words = texts.report_dialog;

@customElement("strata-report-fields")
export class StrataReportFields extends LitElement {
  @property({ attribute: false }) rows: readonly FieldInput[] = [];
  @property({ attribute: false }) problems: Problems = new Map();
  private readonly _order = new OrderButtons(this);
  private _added: number | null = null; // the id of the row that gets the focus

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
        min-width: 0;
      }
      ol {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: minmax(0, 2fr) minmax(0, 3fr) auto;
        align-items: center;
        gap: var(--space-1);
      }
      li .error {
        grid-column: 1 / -1;
      }
      .buttons {
        display: flex;
      }
      .buttons button.icon {
        width: 1.75rem;
      }
      .add {
        justify-self: start;
      }
      @media (pointer: coarse), (max-width: 560px) {
        li {
          grid-template-columns: minmax(0, 1fr) auto;
        }
        li .label,
        li .value {
          grid-column: 1;
        }
        li .buttons {
          grid-area: 1 / 2 / span 2;
        }
        .buttons button.icon {
          width: 2.5rem;
          min-height: var(--control-touch);
        }
      }
    `,
  ];

  override updated(): void {
    if (this._added === null) return;
    this.renderRoot.querySelector<HTMLInputElement>(`[name="field_${this._added}_label"]`)?.focus();
    this._added = null;
  }

  override render(): TemplateResult {
    const { rows } = this;
    return html`${
      rows.length === 0
        ? nothing
        : html`<ol aria-label=${words.fields}>
            ${repeat(
              rows,
              ({ id }) => id,
              (row, index) => this.row(row, index),
            )}
          </ol>`
    }
    ${rows.length < kMostFields ? html`<button type="button" class="add" @click=${() => this.add()}>${icon("plus")}${words.add_field}</button>` : nothing}`;
  }

  private row(row: FieldInput, index: number): TemplateResult {
    const { rows } = this;
    const name = row.label.trim() || words.field(index + 1);
    const remove = texts.ordered_choice.remove(name);
    return html`<li>
      ${this.input(row, "label", 100, name)} ${this.input(row, "value", 500, name)}
      <span class="buttons">
        ${
          rows.length > 1
            ? this._order.buttons({ id: String(row.id), name, index, count: rows.length }, (to) =>
                this.put(moved(rows, index, to)),
              )
            : nothing
        }
        <button type="button" class="icon quiet" aria-label=${remove} title=${remove} @click=${() => this.put(rows.filter((each) => each !== row))}>${icon("close")}</button>
      </span>
      ${(["label", "value"] as const).map((part) => {
        const problem = this.problems.get(`field:${row.id}:${part}`);
        return problem
          ? html`<p class="error" role="alert" id="field_${row.id}_${part}_problem">${problem}</p>`
          : nothing;
      })}
    </li>`;
  }

  private input(
    row: FieldInput,
    part: "label" | "value",
    most: number,
    name: string,
  ): TemplateResult {
    const wrong = this.problems.has(`field:${row.id}:${part}`);
    return html`<input
      type="text"
      class=${part}
      name="field_${row.id}_${part}"
      maxlength=${most}
      autocomplete="off"
      aria-label="${words[part]} (${name})"
      placeholder=${words[part]}
      aria-invalid=${wrong}
      aria-describedby=${wrong ? `field_${row.id}_${part}_problem` : nothing}
      .value=${row[part]}
      @input=${(event: Event) => {
        const changed = { ...row, [part]: (event.target as HTMLInputElement).value };
        this.put(this.rows.map((each) => (each.id === row.id ? changed : each)));
      }}
    />`;
  }

  private add(): void {
    const id = Math.max(-1, ...this.rows.map((row) => row.id)) + 1;
    this._added = id;
    this.put([...this.rows, { id, label: "", value: "" }]);
  }

  private put(rows: readonly FieldInput[]): void {
    this.dispatchEvent(new CustomEvent<readonly FieldInput[]>("changed", { detail: rows }));
  }
}
