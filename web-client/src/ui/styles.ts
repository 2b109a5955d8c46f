// Styles that several elements share.

import { css } from "lit";

export const sharedStyles = css`
  :host {
    box-sizing: border-box;
  }
  :host([hidden]),
  [hidden] {
    display: none !important;
  }
  *,
  *::before,
  *::after {
    box-sizing: border-box;
  }
  h1,
  h2,
  h3,
  p {
    margin: 0;
  }
  h1,
  h2 {
    font-family: var(--serif);
    font-weight: 600;
    letter-spacing: -0.005em;
    line-height: 1.2;
  }
  button,
  input,
  select,
  textarea {
    font: inherit;
    color: inherit;
  }
  button,
  .button {
    display: inline-flex;
    align-items: center;
    justify-content: center;
    gap: 0.5em;
    min-height: 2.25rem;
    padding: 0 0.875rem;
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-small);
    background: var(--raised);
    color: inherit;
    cursor: pointer;
    text-decoration: none;
    white-space: nowrap;
    transition:
      background 120ms,
      border-color 120ms;
  }
  button:hover:not(:disabled),
  .button:hover {
    border-color: var(--line-strong);
  }
  button:disabled {
    opacity: var(--unavailable);
    cursor: default;
  }
  button.primary {
    border-color: var(--accent);
    background: var(--accent);
    color: var(--accent-ink);
    font-weight: 600;
  }
  button.primary:hover:not(:disabled) {
    filter: brightness(1.08);
    border-color: var(--accent);
  }
  button.danger {
    border-color: var(--danger);
    background: var(--danger);
    color: var(--danger-ink);
    font-weight: 600;
  }
  button.quiet {
    border-color: transparent;
    background: transparent;
  }
  button.quiet:hover:not(:disabled) {
    background: var(--hover);
  }
  button.icon {
    width: 2.25rem;
    padding: 0;
    flex: none;
  }
  a.text {
    color: var(--accent);
  }
  button.link {
    min-height: 0;
    padding: 2px 0;
    border: 0;
    background: none;
    color: var(--accent);
    text-decoration: underline;
    text-underline-offset: 2px;
  }
  :focus-visible {
    outline: var(--focus);
    outline-offset: 2px;
  }
  input[type="text"],
  input[type="password"],
  select,
  textarea {
    width: 100%;
    min-height: 2.375rem;
    padding: 0.375rem 0.625rem;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--raised);
  }
  textarea {
    resize: vertical;
    min-height: 4rem;
  }
  input:focus-visible,
  select:focus-visible,
  textarea:focus-visible {
    outline-offset: 0;
  }
  input[aria-invalid="true"] {
    border-color: var(--danger);
  }
  input[type="range"] {
    width: 100%;
    min-width: 0;
    margin: 0;
    height: 1.5rem;
    accent-color: var(--accent);
  }
  input[type="checkbox"],
  input[type="radio"] {
    flex: none;
    width: 0.8125rem;
    height: 0.8125rem;
  }
  input[type="color"] {
    width: 2.375rem;
    height: 2.375rem;
    flex: none;
    padding: 3px;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--raised);
    cursor: pointer;
  }
  label.field {
    display: grid;
    gap: 5px;
    font-size: 0.93rem;
  }
  label.field > span:not(.number),
  .caption {
    font-size: 0.8rem;
    font-weight: 600;
    color: var(--ink-soft);
  }
  .hint {
    font-size: 0.82rem;
    color: var(--ink-soft);
  }
  .error {
    font-size: 0.86rem;
    color: var(--danger);
  }
  .numeric {
    font-variant-numeric: tabular-nums;
  }
  .grow {
    flex: 1;
    min-width: 0;
  }
  .row {
    display: flex;
    align-items: center;
    gap: 0.625rem;
  }
  .ellipsis {
    overflow: hidden;
    text-overflow: ellipsis;
    white-space: nowrap;
  }
  .swatch {
    display: inline-block;
    flex: none;
    width: 1rem;
    height: 1rem;
    border-radius: 4px;
    box-shadow: inset 0 0 0 1px var(--swatch-rim);
  }
  .segments {
    display: inline-flex;
    flex-wrap: wrap;
    max-width: 100%;
    padding: 2px;
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-small);
    background: var(--paper);
  }
  .segments button {
    flex: 1;
    min-height: 1.875rem;
    padding: 0 0.625rem;
    border: 0;
    border-radius: 4px;
    background: transparent;
    font-size: 0.88rem;
  }
  .segments button[aria-checked="true"],
  .segments button[aria-pressed="true"] {
    background: var(--chosen);
    color: var(--chosen-ink);
    box-shadow: 0 0 0 1px var(--line-strong);
    font-weight: 600;
  }
  .visibility {
    display: grid;
    gap: 0.375rem;
    justify-items: start;
  }
  @media (max-width: 560px) {
    .visibility .segments {
      display: grid;
      grid-template-columns: repeat(3, minmax(0, 1fr));
      justify-self: stretch;
    }
    .visibility .segments button {
      flex-direction: column;
      gap: 2px;
      padding: 0.375rem 4px;
      line-height: 1.2;
      white-space: normal;
    }
  }
  .visually-hidden {
    position: absolute;
    width: 1px;
    height: 1px;
    overflow: hidden;
    clip-path: inset(50%);
    white-space: nowrap;
  }
  svg.glyph {
    width: 1.25rem;
    height: 1.25rem;
    flex: none;
    fill: none;
    stroke: currentColor;
    stroke-width: 1.7;
    stroke-linecap: round;
    stroke-linejoin: round;
  }
  @media (prefers-reduced-motion: reduce) {
    *,
    *::before,
    *::after {
      transition: none !important;
      animation: none !important;
    }
  }
  @media (forced-colors: active) {
    .swatch {
      forced-color-adjust: none;
    }
    [aria-pressed="true"],
    [aria-checked="true"],
    [aria-selected="true"] {
      outline: 3px solid Highlight;
      outline-offset: -3px;
    }
    :focus-visible {
      outline: 3px solid CanvasText;
      outline-offset: 2px;
    }
  }
  @media (pointer: coarse) {
    button,
    .button {
      min-height: 2.75rem;
    }
    button.icon {
      width: 2.75rem;
    }
  }
  label.check {
    display: flex;
    align-items: center;
    gap: 0.5625rem;
  }
`;

/** Fields of a dialog, one below the other. */
export const formStyles = css`
  form {
    display: grid;
    gap: 0.875rem;
  }
`;

/**
 * A form inside a dialog that makes a link, and the link, which is shown once. The dialog sets the
 * number of fields in a row.
 */
export const linkMakingStyles = css`
  form {
    display: grid;
    gap: 0.75rem;
    padding: 0.875rem;
    border: var(--edge) solid var(--line);
    border-radius: var(--radius);
  }
  .fields {
    display: grid;
    gap: 0.75rem;
  }
`;

/** Fields of a dialog, two in a row. */
export const choicesStyles = css`
  .choices {
    display: grid;
    grid-template-columns: 1fr 1fr;
    gap: 0.75rem;
    align-items: start;
  }
  .choices .full {
    grid-column: 1 / -1;
  }
`;

/** A number with its unit inside the field, for a unit of any length: the border is around both. */
export const numberFieldStyles = css`
  .number {
    display: flex;
    align-items: center;
    min-width: 0;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--raised);
    cursor: text;
  }
  .number input[type="text"] {
    flex: 1;
    min-width: 2.5rem;
    min-height: calc(2.375rem - 2 * var(--edge));
    border: 0;
    background: none;
    text-align: right;
    outline: none;
  }
  .number > span {
    order: 1;
    flex: 0 1 auto;
    max-width: 60%;
    padding-right: 0.625rem;
    overflow: hidden;
    color: var(--ink-soft);
    font-size: 0.85rem;
    text-overflow: ellipsis;
    white-space: nowrap;
    pointer-events: none;
  }
  .number > span:empty {
    display: none;
  }
  .number:has(> span:not(:empty)) input {
    padding-right: 0.3125rem;
  }
  .number:focus-within {
    outline: var(--focus);
  }
  .number:has([aria-invalid="true"]) {
    border-color: var(--danger);
  }
  .number:has(:disabled) {
    opacity: var(--unavailable);
    cursor: default;
  }
  @media (forced-colors: active) {
    .number:focus-within {
      outline: 3px solid CanvasText;
      outline-offset: 2px;
    }
  }
`;

/** A list with rows that can be dragged (`DragOrder`). */
export const dragStyles = css`
  li {
    position: relative;
  }
  li.dragged {
    opacity: 0.4;
  }
  li.drop-before::before {
    content: "";
    position: absolute;
    left: 0;
    right: 0;
    top: -5px;
    height: 3px;
    border-radius: 2px;
    background: var(--accent);
  }
  .grip {
    display: grid;
    place-items: center;
    width: 1.375rem;
    height: 2.125rem;
    color: var(--line-strong);
    cursor: grab;
  }
`;

/** A word or two about the adjacent content. */
export const chipStyles = css`
  .chip {
    padding: 1px 0.5rem;
    border-radius: 99px;
    background: var(--calm-soft);
    color: var(--calm);
    font-size: 0.76rem;
    font-weight: 600;
    white-space: nowrap;
  }
`;

/** A dialog that uploads files: their contents, the numbers of their placement, the progress. */
export const filesStyles = css`
  .part {
    display: grid;
    gap: 0.375rem;
  }
  .found {
    padding: 0.5625rem 0.75rem;
    border-radius: var(--radius-small);
    background: var(--calm-soft);
    font-size: 0.9rem;
  }
  textarea {
    font: 0.95rem var(--mono);
  }
  progress {
    width: 100%;
    height: 0.375rem;
    accent-color: var(--accent);
  }
`;
