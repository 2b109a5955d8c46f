// <strata-bill-position>: the fields of a group or position: its texts, rules and hand
// measurements. The event "changed" contains the new item, and the changed field.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import type { BillItem, BillPosition, BillRounding, BillRule } from "../../core/protocol.gen";
import { isGroup, kUnitOfMeasure, kUnits, measureOf } from "../../domain/bills";
import { icon } from "../../ui/icons";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import {
  billFieldStyles,
  choiceField,
  decimalField,
  defined,
  longField,
  textField,
  type Field,
} from "./bill-fields";
import "./bill-measurements";
import type { LinesChange } from "./bill-measurements";
import { ofMeasure } from "./bill-counting";
import type { RuleChange } from "./bill-rule";
import type { BillSources } from "./bill-sources";

const words = texts.bills;

export interface ItemChange {
  item: BillItem;
  /** The changed field. Consecutive changes of one field are one step of undo. */
  key: string;
}

@customElement("strata-bill-position")
export class StrataBillPosition extends LitElement {
  @property({ attribute: false }) item!: BillItem;
  @property() currency = "";
  /** The path of the wrong field in the item. */
  @property() wrong = "";
  @property({ attribute: false }) sources!: BillSources;
  @property({ attribute: false }) loaded = 0;
  /** The measured lines of the position, which hand measurements can replace. */
  @property({ attribute: false }) measured: BillPosition | null = null;

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    billFieldStyles,
    css`
      :host,
      section {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-3);
      }
      .rule {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-3);
        padding: var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
      }
      .head {
        justify-content: space-between;
      }
      section > button {
        justify-self: start;
      }
    `,
  ];

  private put(part: { [K in keyof BillItem]?: BillItem[K] | undefined }, key: string): void {
    const item = defined<BillItem>({ ...this.item, ...part });
    this.dispatchEvent(new CustomEvent<ItemChange>("changed", { detail: { item, key } }));
  }

  private field(
    name: "number" | "short_text" | "long_text" | "unit" | "quantity" | "unit_price",
  ): Field {
    return {
      label: words.fields[name],
      name,
      value: this.item[name] ?? "",
      wrong: this.wrong,
      typed: (text) => this.put({ [name]: text }, name),
    };
  }

  override render(): TemplateResult {
    const group = isGroup(this.item);
    return html`<div class="fields">
        ${textField(this.field("number"))}
        <div class="full">${textField(this.field("short_text"))}</div>
        ${longField(this.field("long_text"))} ${group ? nothing : this.amounts()}
      </div>
      ${group ? nothing : this.rules()}
      ${
        group
          ? nothing
          : html`<strata-bill-measurements
            .lines=${this.item.measurements ?? []}
            .measured=${this.measured}
            unit=${this.item.unit ?? ""}
            wrong=${this.wrong}
            @changed=${({ detail }: CustomEvent<LinesChange>) =>
              this.put(
                { measurements: detail.lines.length > 0 ? [...detail.lines] : undefined },
                detail.key,
              )}
          ></strata-bill-measurements>`
      }`;
  }

  private amounts(): TemplateResult {
    const { item, wrong } = this;
    const rounding = item.rounding ?? {};
    const put = (part: BillRounding, key: string): void =>
      this.put({ rounding: { ...rounding, ...part } }, `rounding.${key}`);
    const measure = measureOf(item.unit ?? "");
    return html`${textField({ ...this.field("unit"), list: "units", typed: (unit) => this.putUnit(unit) })}
      <datalist id="units">${kUnits.map(({ unit }) => html`<option value=${unit}></option>`)}</datalist>
      ${decimalField({ ...this.field("quantity"), unit: item.unit ?? "" })}
      ${decimalField({ ...this.field("unit_price"), unit: this.currency })}
      ${choiceField({
        label: words.round_each,
        name: "rounding.each",
        value: rounding.each ?? "sum",
        wrong,
        choices: (["sum", "element"] as const).map((value) => ({ value, name: words.each[value] })),
        typed: (each) => put({ each: each as NonNullable<BillRounding["each"]> }, "each"),
      })}
      ${choiceField({
        label: words.round_mode,
        name: "rounding.mode",
        value: rounding.mode ?? "half_up",
        wrong,
        choices: (["half_up", "up", "down"] as const).map((value) => ({
          value,
          name: words.modes[value],
        })),
        typed: (mode) => put({ mode: mode as NonNullable<BillRounding["mode"]> }, "mode"),
      })}
      ${choiceField({
        label: words.places,
        name: "rounding.places",
        value: String(rounding.places ?? 2),
        wrong,
        choices: [0, 1, 2, 3, 4, 5, 6].map((n) => ({ value: String(n), name: String(n) })),
        typed: (places) => put({ places: Number(places) }, "places"),
      })}
      ${decimalField({
        label: words.smallest,
        name: "rounding.smallest",
        value: rounding.smallest ?? "",
        wrong,
        unit: measure ? kUnitOfMeasure[measure] : "",
        typed: (smallest) => put({ smallest }, "smallest"),
      })}`;
  }

  /** The rules must have the measure of the unit. */
  private putUnit(unit: string): void {
    const measure = measureOf(unit);
    const { rules } = this.item;
    this.put(
      {
        unit,
        rules: measure
          ? rules?.map((rule) => defined<BillRule>({ ...rule, ...ofMeasure(measure, rule) }))
          : rules,
      },
      "unit",
    );
  }

  private rules(): TemplateResult {
    const rules = this.item.rules ?? [];
    const put = (next: BillRule[], key = ""): void =>
      this.put({ rules: next.length > 0 ? next : undefined }, key);
    const [table] = this.sources.tables;
    const measure = measureOf(this.item.unit ?? "") ?? "area";
    const add = (): void => {
      const rule: BillRule = { measure, ...(table ? { table: table.id } : {}) };
      put([...rules, defined<BillRule>({ ...rule, ...ofMeasure(measure, rule) })]);
    };
    return html`<section aria-labelledby="rules">
      <h3 id="rules">${words.rules}</h3>
      ${rules.length === 0 ? html`<p class="hint">${words.rules_hint}</p>` : nothing}
      ${this.sources.problem ? html`<p class="error" role="alert">${this.sources.problem}</p>` : nothing}
      ${rules.map(
        (rule, i) =>
          html`<div class="rule" role="group" aria-label=${words.rule(i + 1)}>
            <div class="row head">
              <span class="caption">${words.rule(i + 1)}</span>
              <button type="button" class="icon quiet" aria-label=${words.remove_rule(i + 1)} title=${words.remove_rule(i + 1)} @click=${() => put(rules.filter((_, k) => k !== i))}>
                ${icon("trash")}
              </button>
            </div>
            <strata-bill-rule
              .rule=${rule}
              at="rules[${i}]"
              wrong=${this.wrong}
              .sources=${this.sources}
              .loaded=${this.loaded}
              @changed=${({ detail }: CustomEvent<RuleChange>) =>
                put(
                  rules.map((each, k) => (k === i ? detail.rule : each)),
                  detail.key && `rules[${i}].${detail.key}`,
                )}
            ></strata-bill-rule>
          </div>`,
      )}
      <button type="button" @click=${add}>${icon("plus")}${words.add_rule}</button>
    </section>`;
  }
}
