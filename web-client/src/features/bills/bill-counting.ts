// The fields of a rule that define how its elements are counted: the depth, the size class, the
// factor, openings and the figure.

import { html, nothing, type TemplateResult } from "lit";
import type { BillDepth, BillRule, BillSize, Table } from "../../core/protocol.gen";
import { kUnitOfMeasure, type Measure } from "../../domain/bills";
import { labelOf } from "../../domain/cells";
import { texts } from "../../texts";
import { choiceField, decimalField, textField } from "./bill-fields";

const words = texts.bills;

/** A change of a rule. Members that are undefined are removed. */
export type RulePart = { [K in keyof BillRule]?: BillRule[K] | undefined };

export interface CountingFields {
  rule: BillRule;
  /** The path of the rule in its item. */
  at: string;
  /** The path of the wrong field in the item. */
  wrong: string;
  table: Table | undefined;
  /** The slugs of layers that may contain depths. */
  layerSlugs: readonly string[];
  /** Changes the rule. `key` is the changed field. */
  put(part: RulePart, key: string): void;
}

type DepthKind = keyof BillDepth;
const kDepths: readonly DepthKind[] = ["metres", "column", "layer"];

export function countingFields(fields: CountingFields): TemplateResult {
  const { rule, at, wrong, put: change } = fields;
  const size = rule.size ?? {};
  const sizeUnit = size.of === "length" ? "m" : "m²";
  const putSize = (part: BillSize, key: string): void =>
    change({ size: { ...size, ...part } }, key);
  const number = (name: "over" | "up_to", label: string): TemplateResult =>
    decimalField({
      label,
      name: `${at}.size.${name}`,
      value: size[name] ?? "",
      wrong,
      unit: sizeUnit,
      typed: (text) => putSize({ [name]: text }, `size.${name}`),
    });
  const open =
    Boolean(rule.size || rule.factor || rule.deduct || rule.figure) || wrong.startsWith(at);
  return html`${rule.measure === "volume" ? html`<div class="fields">${depthFields(fields)}</div>` : nothing}
    <details ?open=${open}>
      <summary>${words.more}</summary>
      <div class="fields">
        ${
          rule.table === undefined
            ? nothing // the element is a whole class, whose size says nothing about its pieces
            : html`${choiceField({
                label: words.size_of,
                name: `${at}.size.of`,
                value: size.of ?? "area",
                wrong,
                choices: (["area", "length"] as const).map((value) => ({
                  value,
                  name: words.measures[value],
                })),
                typed: (of) => putSize({ of: of as "area" | "length" }, "size.of"),
              })}
              ${number("over", words.over)} ${number("up_to", words.up_to)}`
        }
        ${decimalField({
          label: words.factor,
          name: `${at}.factor`,
          value: rule.factor ?? "",
          wrong,
          placeholder: "1",
          typed: (factor) => change({ factor }, "factor"),
        })}
        ${textField({
          label: words.figure,
          name: `${at}.figure`,
          value: rule.figure ?? "",
          wrong,
          placeholder: words.figure_hint,
          typed: (figure) => change({ figure: figure === "" ? undefined : figure }, "figure"),
        })}
        <label class="check full">
          <input
            type="checkbox"
            name="${at}.deduct"
            .checked=${rule.deduct ?? false}
            @change=${(event: Event) => {
              const on = (event.target as HTMLInputElement).checked;
              change(
                on ? { deduct: true } : { deduct: undefined, overmeasured_up_to: undefined },
                "",
              );
            }}
          />
          ${words.deduct}
        </label>
        ${
          rule.deduct && rule.table !== undefined
            ? decimalField({
                label: words.overmeasured,
                name: `${at}.overmeasured_up_to`,
                value: rule.overmeasured_up_to ?? "",
                wrong,
                unit: kUnitOfMeasure[rule.measure],
                typed: (text) => change({ overmeasured_up_to: text }, "overmeasured_up_to"),
              })
            : nothing
        }
      </div>
    </details>`;
}

function depthFields({
  rule,
  at,
  wrong,
  table,
  layerSlugs,
  put: change,
}: CountingFields): TemplateResult {
  const depth = rule.depth ?? { metres: "" };
  const kind = kDepths.find((each) => each in depth) ?? "metres";
  const value = depth[kind] ?? "";
  const put = (of: DepthKind, text: string): void =>
    change({ depth: { [of]: text } }, `depth.${of}`);
  const kinds = kDepths.filter((each) => each !== "column" || table);
  const columns = (table?.columns ?? []).filter(
    (column) => column.kind === "numeric" || column.kind === "integer",
  );
  const common = { label: words.depths[kind], name: `${at}.depth.${kind}`, value, wrong };
  return html`${choiceField({
    label: words.depth,
    name: `${at}.depth`,
    value: kind,
    wrong,
    choices: kinds.map((each) => ({ value: each, name: words.depths[each] })),
    typed: (of) => put(of as DepthKind, ""),
  })}
  ${
    kind === "metres"
      ? decimalField({ ...common, unit: "m", typed: (text) => put(kind, text) })
      : kind === "column"
        ? choiceField({
            ...common,
            choices: [
              { value: "", name: words.choose },
              ...columns.map((column) => ({ value: column.slug, name: labelOf(column) })),
            ],
            typed: (text) => put(kind, text),
          })
        : html`${textField({ ...common, list: "layers", typed: (text) => put(kind, text) })}
          <datalist id="layers">${layerSlugs.map((slug) => html`<option value=${slug}></option>`)}</datalist>`
  }`;
}

/** The members of a rule that must follow its measure. */
export function ofMeasure(measure: Measure, { depth, size }: BillRule): RulePart {
  return {
    measure,
    depth: measure === "volume" ? (depth ?? { metres: "" }) : undefined,
    size: size && measure === "length" ? { ...size, of: "length" } : size,
  };
}
