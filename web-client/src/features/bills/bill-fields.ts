// Fields of a bill. The name of a field is its path in the contract, so a problem of the server is
// shown at its field.

import { css, html, nothing, type TemplateResult } from "lit";
import { numberInput } from "../../ui/number-input";

export interface Field {
  label: string;
  /** The path in the item, such as "rules[0].factor". */
  name: string;
  value: string;
  /** The path of the wrong field. */
  wrong: string;
  placeholder?: string;
  /** The id of a datalist. */
  list?: string;
  typed(text: string): void;
}

const textIn = (event: Event): string =>
  (event.target as HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement).value;

export const textField = (field: Field): TemplateResult =>
  html`<label class="field">
    <span>${field.label}</span>
    <input
      type="text"
      autocomplete="off"
      name=${field.name}
      list=${field.list ?? nothing}
      placeholder=${field.placeholder ?? nothing}
      aria-invalid=${field.wrong === field.name}
      .value=${field.value}
      @input=${(event: Event) => field.typed(textIn(event))}
    />
  </label>`;

export const longField = (field: Field): TemplateResult =>
  html`<label class="field full">
    <span>${field.label}</span>
    <textarea rows="3" name=${field.name} .value=${field.value} @input=${(event: Event) => field.typed(textIn(event))}></textarea>
  </label>`;

/** A field for a decimal number, which is stored as typed. */
export const decimalField = (field: Field & { unit?: string }): TemplateResult =>
  html`<label class="field">
    <span>${field.label}</span>
    <span class="number">${numberInput({
      value: field.value,
      name: field.name,
      placeholder: field.placeholder ?? "",
      wrong: field.wrong === field.name,
      typed: field.typed,
    })}<span>${field.unit ?? ""}</span></span>
  </label>`;

export interface Choice {
  value: string;
  name: string;
}

export const choiceField = (
  field: Omit<Field, "placeholder" | "list"> & { choices: readonly Choice[] },
): TemplateResult =>
  html`<label class="field">
    <span>${field.label}</span>
    <select name=${field.name} aria-invalid=${field.wrong === field.name} @change=${(event: Event) => field.typed(textIn(event))}>
      ${field.choices.map(({ value, name }) => html`<option value=${value} ?selected=${value === field.value}>${name}</option>`)}
    </select>
  </label>`;

/** Returns the object without members that are undefined. */
export function defined<T extends object>(value: { [K in keyof T]: T[K] | undefined }): T {
  return Object.fromEntries(Object.entries(value).filter(([, each]) => each !== undefined)) as T;
}

/** Fields in as many columns as fit. */
export const billFieldStyles = css`
  .fields {
    display: grid;
    grid-template-columns: repeat(auto-fill, minmax(9.5rem, 1fr));
    gap: var(--space-3);
    align-items: end;
  }
  .fields .full {
    grid-column: 1 / -1;
  }
  select[aria-invalid="true"] {
    border-color: var(--danger);
  }
  h3 {
    font-size: var(--text-large);
  }
`;
