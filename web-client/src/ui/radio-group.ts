// A choice between several values, as buttons. It is a single Tab stop, and arrow keys choose a
// value.

import { html, type TemplateResult } from "lit";
import { arrowStep } from "./keyboard";

export interface RadioChoice<T> {
  value: T;
  content: unknown;
  title?: string;
}

export interface RadioGroup<T> {
  /** The accessible name: a text, or the id of the element with the text. */
  label: string | { id: string };
  class: string;
  choices: readonly RadioChoice<T>[];
  chosen: T | null;
  choose(value: T): void;
}

export function radioGroup<T>({
  label,
  class: style,
  choices,
  chosen,
  choose,
}: RadioGroup<T>): TemplateResult {
  // There is a Tab stop even without a chosen value.
  const stop = Math.max(
    0,
    choices.findIndex((choice) => choice.value === chosen),
  );
  const buttons = choices.map(
    ({ value, content, title }, index) =>
      html`<button
        type="button"
        role="radio"
        aria-checked=${value === chosen}
        tabindex=${index === stop ? 0 : -1}
        title=${title ?? ""}
        @click=${() => choose(value)}
      >
        ${content}
      </button>`,
  );
  return typeof label === "string"
    ? html`<div class=${style} role="radiogroup" aria-label=${label} @keydown=${onRadioKey}>${buttons}</div>`
    : html`<div class=${style} role="radiogroup" aria-labelledby=${label.id} @keydown=${onRadioKey}>${buttons}</div>`;
}

function onRadioKey(event: KeyboardEvent): void {
  const buttons = [...(event.currentTarget as HTMLElement).querySelectorAll("button")];
  const next = arrowStep(
    event.key,
    buttons.indexOf(event.target as HTMLButtonElement),
    buttons.length,
  );
  if (next === null) return;
  event.preventDefault();
  event.stopPropagation();
  buttons[next]!.click();
  buttons[next]!.focus();
}
