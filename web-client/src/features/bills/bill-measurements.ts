// <strata-bill-measurements>: the hand measurements of a position, with the values of their
// formulas. The event "changed" contains the new lines, and the changed field.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import type { BillPosition, HandMeasurement } from "../../core/protocol.gen";
import { shownDecimal } from "../../domain/bills";
import { formulaResult } from "./formulas";
import { toldTime } from "../../domain/times";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { billFieldStyles, choiceField, defined, textField } from "./bill-fields";

const words = texts.bills;

export interface LinesChange {
  lines: readonly HandMeasurement[];
  /** The changed field. */
  key: string;
}

@customElement("strata-bill-measurements")
export class StrataBillMeasurements extends LitElement {
  @property({ attribute: false }) lines: readonly HandMeasurement[] = [];
  @property({ attribute: false }) measured: BillPosition | null = null;
  @property() unit = "";
  /** The path of the wrong field in the item. */
  @property() wrong = "";

  static override styles = [
    sharedStyles,
    billFieldStyles,
    css`
      section,
      .line {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-3);
      }
      .line {
        padding: var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
      }
      .head {
        justify-content: space-between;
      }
      output {
        font-weight: 600;
      }
      .error output {
        font-weight: inherit;
      }
      section > button {
        justify-self: start;
      }
    `,
  ];

  private put(lines: readonly HandMeasurement[], key = ""): void {
    this.dispatchEvent(new CustomEvent<LinesChange>("changed", { detail: { lines, key } }));
  }

  override render(): TemplateResult {
    const { lines } = this;
    return html`<section aria-labelledby="by_hand">
      <h3 id="by_hand">${words.by_hand}</h3>
      ${lines.length === 0 ? html`<p class="hint">${words.by_hand_hint}</p>` : nothing}
      ${lines.map((line, i) => this.line(line, i))}
      <button type="button" @click=${() => this.put([...lines, { formula: "" }])}>${icon("plus")}${words.add_line}</button>
    </section>`;
  }

  private line(line: HandMeasurement, index: number): TemplateResult {
    const { lines } = this;
    const at = `measurements[${index}]`;
    const set = (name: keyof HandMeasurement, text: string): void => {
      const value = text === "" && name !== "formula" ? undefined : text;
      const next = defined<HandMeasurement>({ ...line, [name]: value });
      this.put(
        lines.map((each, i) => (i === index ? next : each)),
        `${at}.${name}`,
      );
    };
    const field = (name: "text" | "formula" | "remark"): TemplateResult =>
      textField({
        label: words.line_fields[name],
        name: `${at}.${name}`,
        value: line[name] ?? "",
        wrong: this.wrong,
        placeholder: name === "formula" ? "2 * 1,20 * 0,85" : "",
        typed: (text) => set(name, text),
      });
    return html`<div class="line" role="group" aria-label=${words.line(index + 1)}>
      <div class="row head">
        <span class="caption">${words.line(index + 1)}</span>
        <button type="button" class="icon quiet" aria-label=${words.remove_line(index + 1)} title=${words.remove_line(index + 1)} @click=${() => this.put(lines.filter((_, i) => i !== index))}>
          ${icon("trash")}
        </button>
      </div>
      <div class="fields">
        ${field("text")} ${field("formula")} ${field("remark")} ${this.replaces(line, at, set)}
      </div>
      ${this.result(line.formula)}
      ${line.user ? html`<p class="hint">${words.entered(line.user, line.time ? toldTime(line.time) : "")}</p>` : nothing}
    </div>`;
  }

  /** The measured line that the hand measurement replaces. */
  private replaces(
    line: HandMeasurement,
    at: string,
    set: (name: keyof HandMeasurement, text: string) => void,
  ): TemplateResult | typeof nothing {
    const measured = this.measured?.lines.filter(({ rule }) => rule !== undefined) ?? [];
    const { replaces } = line;
    if (measured.length === 0 && replaces === undefined) return nothing;
    const known = measured.some(({ id }) => id === replaces);
    return choiceField({
      label: words.replaces,
      name: `${at}.replaces`,
      value: replaces ?? "",
      wrong: this.wrong,
      choices: [
        { value: "", name: words.replaces_none },
        ...measured.map(({ id, title }) => ({ value: id, name: title })),
        ...(replaces !== undefined && !known ? [{ value: replaces, name: replaces }] : []),
      ],
      typed: (id) => set("replaces", id),
    });
  }

  private result(formula: string): TemplateResult | typeof nothing {
    if (formula.trim() === "") return nothing;
    const result = formulaResult(formula);
    if ("value" in result)
      return html`<p>= <output>${shownDecimal(result.value)} ${this.unit}</output></p>`;
    const text = result.problem === "mistake" ? words.mistake(result.at + 1) : words.no_result;
    return html`<p class="error"><output>${text}</output></p>`;
  }
}
