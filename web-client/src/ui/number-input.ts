// A field for one number in the format of the page's language. The browser's own number fields use
// the browser's language and discard invalid characters. In an English field, "1,5" becomes 15.

import { html, noChange, type TemplateResult } from "lit";
import { ifDefined } from "lit/directives/if-defined.js";
import { readNumber, typedNumber } from "../core/locale";

export interface NumberInput {
  /** The number, or a text as typed. NaN keeps the field's content. */
  value: number | string;
  name?: string;
  /** The accessible name of a field without a surrounding <label>. */
  label?: string;
  title?: string;
  placeholder?: string | number;
  /** The limits for the arrow keys. The listener checks typed values. */
  min?: number;
  max?: number;
  wrong?: boolean;
  /** The id of the message about a wrong value. */
  toldAt?: string;
  disabled?: boolean;
  /** Called with the field's text, for readNumber(). */
  typed?(text: string): void;
  /** Called when the field loses the focus, or on Enter. */
  changed?(text: string, input: HTMLInputElement): void;
}

export function numberInput(field: NumberInput): TemplateResult {
  const { value, typed, changed } = field;
  const inputOf = (event: Event): HTMLInputElement => event.target as HTMLInputElement;
  return html`<input
    type="text"
    inputmode="decimal"
    autocomplete="off"
    name=${ifDefined(field.name)}
    aria-label=${ifDefined(field.label)}
    title=${ifDefined(field.title)}
    placeholder=${ifDefined(field.placeholder)}
    aria-invalid=${field.wrong ? "true" : "false"}
    aria-describedby=${ifDefined(field.wrong ? field.toldAt : undefined)}
    ?disabled=${field.disabled ?? false}
    .value=${typeof value === "string" ? value : Number.isNaN(value) ? noChange : typedNumber(value)}
    @input=${(event: Event) => typed?.(inputOf(event).value)}
    @change=${(event: Event) => changed?.(inputOf(event).value, inputOf(event))}
    @keydown=${(event: KeyboardEvent) => onStep(event, field)}
  />`;
}

/** Changes the number by one with the arrow keys. */
function onStep(event: KeyboardEvent, { min = -Infinity, max = Infinity }: NumberInput): void {
  const step = event.key === "ArrowUp" ? 1 : event.key === "ArrowDown" ? -1 : 0;
  const input = event.target as HTMLInputElement;
  const now = readNumber(input.value);
  if (step === 0 || Number.isNaN(now)) return;
  event.preventDefault();
  input.value = typedNumber(Number(Math.min(max, Math.max(min, now + step)).toPrecision(12)));
  for (const type of ["input", "change"])
    input.dispatchEvent(new Event(type, { bubbles: true, composed: true }));
}
