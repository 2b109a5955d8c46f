// <strata-bill-rule>: a rule of a position: which elements it counts, and how. The event "changed"
// contains the new rule, and the changed field.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import type { BillRule, Table } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { kMeasures, type Measure } from "../../domain/bills";
import { labelOf } from "../../domain/cells";
import { chosenIn, withChoice } from "../../domain/column-filter";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { billFieldStyles, choiceField, defined, textField, type Choice } from "./bill-fields";
import { countingFields, ofMeasure, type RulePart } from "./bill-counting";
import type { BillSources, ClassColumn } from "./bill-sources";

const words = texts.bills;

export interface RuleChange {
  rule: BillRule;
  /** The changed field. */
  key: string;
}

@customElement("strata-bill-rule")
export class StrataBillRule extends LitElement {
  @property({ attribute: false }) rule!: BillRule;
  /** The path of the rule in its item, such as "rules[0]". */
  @property() at = "";
  /** The path of the wrong field in the item. */
  @property() wrong = "";
  @property({ attribute: false }) sources!: BillSources;
  /** Changes when the sources have changed. */
  @property({ attribute: false }) loaded = 0;

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    billFieldStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-3);
      }
      fieldset {
        min-width: 0;
        margin: 0;
        padding: var(--space-2) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
      }
      .classes {
        display: grid;
        grid-template-columns: repeat(auto-fill, minmax(10rem, 1fr));
        gap: var(--space-1) var(--space-3);
        max-height: 11rem;
        overflow: auto;
      }
      legend {
        padding: 0 var(--space-1);
        font-size: var(--text-tiny);
        font-weight: 600;
        color: var(--ink-soft);
      }
      .check {
        min-height: var(--control-small);
        font-size: var(--text-small);
      }
      summary {
        cursor: pointer;
        font-size: var(--text-small);
        min-height: var(--control-small);
      }
      details > .fields {
        padding-top: var(--space-2);
      }
    `,
  ];

  private put(part: RulePart, key: string): void {
    const rule = defined<BillRule>({ ...this.rule, ...part });
    this.dispatchEvent(new CustomEvent<RuleChange>("changed", { detail: { rule, key } }));
  }

  override render(): TemplateResult {
    const { rule, sources } = this;
    const table = sources.tables.find(({ id }) => id === rule.table);
    const layers = rule.model === undefined ? [] : sources.layers(rule.model);
    return html`<div class="fields">${this.source(table, layers)} ${this.measure()}</div>
      ${table ? this.condition(table) : this.values(layers)} ${countingFields({
        rule,
        at: this.at,
        wrong: this.wrong,
        table,
        layerSlugs: sources.layerSlugs,
        put: (part, key) => this.put(part, key),
      })}`;
  }

  // ── which elements ─────────────────────────────────────────────────────────────────────────────

  private source(table: Table | undefined, layers: readonly Layer[]): TemplateResult {
    const { rule, at, wrong, sources } = this;
    const fits = layers.filter((layer) =>
      rule.table === undefined ? !layer.type.startsWith("f") : layer.table === rule.table,
    );
    const named = (all: readonly { id: number; name: string }[]): Choice[] =>
      all.map(({ id, name }) => ({ value: String(id), name }));
    const tables = sources.tables.map((each) => ({ id: each.id, name: labelOf(each) }));
    const unknown = rule.table !== undefined && !table && sources.tables.length > 0;
    return html`${choiceField({
      label: words.table,
      name: `${at}.table`,
      value: String(rule.table ?? ""),
      wrong,
      choices: [
        { value: "", name: words.no_table },
        ...named(tables),
        ...(unknown ? [{ value: String(rule.table), name: words.gone }] : []),
      ],
      typed: (id) =>
        this.put(
          id
            ? { table: Number(id), values: undefined, where: undefined, layer: undefined }
            : {
                table: undefined,
                where: undefined,
                layer: undefined,
                size: undefined,
                overmeasured_up_to: undefined,
              },
          "table",
        ),
    })}
    ${choiceField({
      label: words.model,
      name: `${at}.model`,
      value: String(rule.model ?? ""),
      wrong,
      choices: [
        { value: "", name: rule.table ? words.all_models : words.choose },
        ...named(sources.models),
      ],
      typed: (id) =>
        this.put(
          { model: id ? Number(id) : undefined, layer: undefined, values: undefined },
          "model",
        ),
    })}
    ${
      rule.model === undefined
        ? nothing
        : choiceField({
            label: words.layer,
            name: `${at}.layer`,
            value: String(rule.layer ?? ""),
            wrong,
            choices: [
              { value: "", name: rule.table ? words.all_layers : words.choose },
              ...named(fits.map((layer) => ({ id: layer.id, name: labelOf(layer) }))),
            ],
            typed: (id) =>
              this.put({ layer: id ? Number(id) : undefined, values: undefined }, "layer"),
          })
    }`;
  }

  /** The classes of a table, and the condition that they make. */
  private condition(table: Table): TemplateResult {
    const { rule, at, wrong } = this;
    return html`${this.sources
      .classColumns(table)
      .filter(({ classes }) => classes.length > 0)
      .map((column) => this.classColumn(column))}
      ${textField({
        label: words.where,
        name: `${at}.where`,
        value: rule.where ?? "",
        wrong,
        placeholder: words.where_hint,
        typed: (where) => this.put({ where: where === "" ? undefined : where }, "where"),
      })}`;
  }

  private classColumn({ column, name, classes }: ClassColumn): TemplateResult {
    const where = this.rule.where ?? "";
    const filter = chosenIn(where, column);
    const chosen = filter?.is === "one_of" ? filter.values.map(String) : [];
    return this.checks(
      name,
      classes.map(({ value, label }) => ({ value, name: label })),
      chosen,
      (values) => {
        const next = withChoice(
          where,
          column,
          values.length > 0 ? { is: "one_of", values, empty: false } : null,
        );
        this.put({ where: next === "" ? undefined : next }, "");
      },
    );
  }

  /** The classes of a layer. */
  private values(layers: readonly Layer[]): TemplateResult | typeof nothing {
    const layer = layers.find(({ id }) => id === this.rule.layer);
    const points = layer?.palette.points.filter(({ label }) => label) ?? [];
    if (points.length === 0) return nothing;
    return this.checks(
      words.classes,
      points.map(({ at, label }) => ({ value: String(at), name: label! })),
      (this.rule.values ?? []).map(String),
      (values) => this.put({ values: values.length > 0 ? values.map(Number) : undefined }, ""),
    );
  }

  private checks(
    name: string,
    choices: readonly Choice[],
    chosen: readonly string[],
    put: (values: string[]) => void,
  ): TemplateResult {
    const turn = (value: string, on: boolean): void => {
      const kept = choices.map((each) => each.value);
      put(kept.filter((each) => (each === value ? on : chosen.includes(each))));
    };
    return html`<fieldset>
      <legend>${name} (${chosen.length === 0 ? words.all_classes : words.some_classes(chosen.length)})</legend>
      <div class="classes">
        ${choices.map(
          (choice) =>
            html`<label class="check">
              <input type="checkbox" .checked=${chosen.includes(choice.value)} @change=${(event: Event) => turn(choice.value, (event.target as HTMLInputElement).checked)} />
              ${choice.name}
            </label>`,
        )}
      </div>
    </fieldset>`;
  }

  private measure(): TemplateResult {
    const { rule, at, wrong } = this;
    return choiceField({
      label: words.measure,
      name: `${at}.measure`,
      value: rule.measure,
      wrong,
      choices: kMeasures.map((value) => ({ value, name: words.measures[value] })),
      typed: (value) => this.put(ofMeasure(value as Measure, rule), "measure"),
    });
  }
}
