// A field for one value of a layer, or all values: a list of the classes, or a number.

import { html, nothing, type TemplateResult } from "lit";
import type { Layer } from "../../core/types";
import { texts } from "../../texts";
import { numberInput } from "../../ui/number-input";
import { kProblem } from "./region-job";

export interface ClassField {
  layer: Layer;
  /** The value as typed. Empty: all values. */
  value: string;
  /** The text for an empty value. */
  empty?: string;
  wrong: boolean;
  typed(text: string): void;
}

export function classField({ layer, value, empty, wrong, typed }: ClassField): TemplateResult {
  const words = texts.regions;
  const { palette } = layer;
  const none = empty ?? words.all_values;
  const hasClasses =
    layer.table === undefined && palette.mode === "categorical" && palette.points.length > 0;
  return html`<label class="field">
    <span>${words.class}</span>
    ${
      hasClasses
        ? html`<select name="of" aria-invalid=${wrong ? "true" : "false"} aria-describedby=${wrong ? kProblem : nothing} @change=${(event: Event) => typed((event.target as HTMLSelectElement).value)}>
            <option value="" ?selected=${value === ""}>${none}</option>
            ${palette.points.map(
              ({ at, label }) =>
                html`<option value=${at} ?selected=${value === String(at)}>${label ? `${at} ${label}` : at}</option>`,
            )}
          </select>`
        : numberInput({
            name: "of",
            value,
            placeholder: none,
            wrong,
            toldAt: kProblem,
            typed,
          })
    }
  </label>`;
}
