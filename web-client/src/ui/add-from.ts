// A choice of items with a button that adds the chosen item.

import { css, html, type TemplateResult } from "lit";
import { icon } from "./icons";

export const addFromStyles = css`
  .add {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-2) var(--space-2);
  }
  .add select {
    flex: 1 1 190px;
    width: auto;
    min-width: 0;
  }
`;

/** `label` is the label of the choice and of the button. */
export function addFrom(
  label: string,
  options: readonly { value: string; name: string }[],
  add: (value: string) => void,
): TemplateResult {
  const addChosen = (event: Event): void => {
    const value = (event.currentTarget as HTMLElement).parentElement?.querySelector(
      "select",
    )?.value;
    if (value) add(value);
  };
  return html`<div class="add">
    <select aria-label=${label}>
      ${options.map(({ value, name }) => html`<option value=${value}>${name}</option>`)}
    </select>
    <button type="button" @click=${addChosen}>${icon("plus")}${label}</button>
  </div>`;
}
