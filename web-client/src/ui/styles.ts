// Styles for several elements.

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
    gap: var(--space-2);
    min-height: var(--control);
    padding: 0 var(--space-3);
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-small);
    background: var(--raised);
    color: inherit;
    cursor: pointer;
    text-decoration: none;
    white-space: nowrap;
    transition:
      background var(--fast),
      border-color var(--fast);
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
    border-color: var(--accent-strong);
    background: var(--accent-strong);
  }
  button.danger {
    border-color: var(--danger);
    background: var(--danger);
    color: var(--danger-ink);
    font-weight: 600;
  }
  button.danger:hover:not(:disabled) {
    border-color: var(--danger-strong);
    background: var(--danger-strong);
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
    padding: var(--space-half) 0;
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
  input[type="date"],
  select,
  textarea {
    width: 100%;
    min-height: var(--control);
    padding: var(--space-1) var(--space-2);
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background-color: var(--field);
    transition: border-color var(--fast);
  }
  input[type="text"]:hover:enabled,
  input[type="password"]:hover:enabled,
  input[type="date"]:hover:enabled,
  select:hover:enabled,
  textarea:hover:enabled {
    border-color: var(--ink-soft);
  }
  /* The arrow is two triangles in the color of the text. */
  select:not([multiple]) {
    appearance: none;
    padding-right: var(--space-6);
    background-image:
      linear-gradient(45deg, transparent 50%, currentColor 50%),
      linear-gradient(-45deg, transparent 50%, currentColor 50%);
    background-position:
      right 0.8125rem top 55%,
      right 0.5625rem top 55%;
    background-repeat: no-repeat;
    background-size: 0.25rem 0.25rem;
    text-overflow: ellipsis;
  }
  textarea {
    padding: var(--space-2);
    resize: vertical;
    min-height: 4rem;
  }
  /* The focus can be on the button for the calendar, inside the field. */
  input[type="date"]:focus-within {
    outline: var(--focus);
  }
  input:focus-visible,
  input[type="date"]:focus-within,
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
    width: 1rem;
    height: 1rem;
    margin: 0;
    accent-color: var(--accent);
  }
  /* The color fills the whole control. */
  input[type="color"] {
    width: var(--control);
    height: var(--control);
    flex: none;
    padding: 0;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--field);
    overflow: hidden;
    cursor: pointer;
    transition: border-color var(--fast);
  }
  input[type="color"]:hover:enabled {
    border-color: var(--ink);
  }
  input[type="color"]::-webkit-color-swatch-wrapper {
    padding: 0;
  }
  input[type="color"]::-webkit-color-swatch {
    border: 0;
    border-radius: 0;
  }
  input[type="color"]::-moz-color-swatch {
    border: 0;
    border-radius: 0;
  }
  label.field {
    display: grid;
    gap: var(--space-1);
    font-size: var(--text-body);
  }
  label.field > span:not(.number),
  .caption {
    font-size: var(--text-tiny);
    font-weight: 600;
    color: var(--ink-soft);
  }
  .hint {
    font-size: var(--text-small);
    color: var(--ink-soft);
  }
  .error {
    font-size: var(--text-small);
    color: var(--danger);
  }
  .grow {
    flex: 1;
    min-width: 0;
  }
  .row {
    display: flex;
    align-items: center;
    gap: var(--space-2);
  }
  .ellipsis {
    overflow: hidden;
    text-overflow: ellipsis;
    white-space: nowrap;
  }
  kbd {
    display: inline-block;
    min-width: 1.375rem;
    padding: 0 var(--space-1);
    border: var(--edge) solid var(--line-strong);
    border-bottom-width: calc(var(--edge) + 1px);
    border-radius: var(--radius-tiny);
    background: var(--raised);
    font: 500 var(--text-tiny) / 1.7 var(--sans);
    text-align: center;
    white-space: nowrap;
  }
  .swatch {
    display: inline-block;
    flex: none;
    width: 1rem;
    height: 1rem;
    border-radius: var(--radius-tiny);
    box-shadow: inset 0 0 0 1px var(--swatch-rim);
  }
  .segments {
    display: inline-flex;
    flex-wrap: wrap;
    gap: var(--space-half);
    max-width: 100%;
    padding: var(--space-half);
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-small);
    background: var(--paper);
  }
  .segments button {
    flex: 1;
    min-height: var(--control-small);
    padding: 0 var(--space-2);
    border: 0;
    border-radius: var(--radius-tiny);
    background: transparent;
    font-size: var(--text-small);
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
    gap: var(--space-2);
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
      gap: var(--space-half);
      padding: var(--space-2) var(--space-1);
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
    .swatch,
    input[type="color"] {
      forced-color-adjust: none;
    }
    select:not([multiple]) {
      appearance: auto;
      background-image: none;
    }
    [aria-pressed="true"],
    [aria-checked="true"],
    [aria-selected="true"] {
      outline: 3px solid Highlight;
      outline-offset: -3px;
    }
    :focus-visible {
      outline: var(--focus);
    }
  }
  @media (pointer: coarse) {
    button,
    .button {
      min-height: var(--control-touch);
    }
    button.icon {
      width: var(--control-touch);
    }
  }
  label.check {
    display: flex;
    align-items: center;
    gap: var(--space-2);
  }
`;

/** The fields of a dialog, one below the other. */
export const formStyles = css`
  form {
    display: grid;
    gap: var(--space-3);
  }
`;

/**
 * A form in a dialog that makes a link, and the new link, which is shown once. The dialog sets the
 * number of fields in a row.
 */
export const linkMakingStyles = css`
  form {
    display: grid;
    gap: var(--space-3);
    padding: var(--space-3);
    border: var(--edge) solid var(--line);
    border-radius: var(--radius);
  }
  .fields {
    display: grid;
    gap: var(--space-3);
  }
`;

/** The fields of a dialog, two in a row. */
export const choicesStyles = css`
  .choices {
    display: grid;
    grid-template-columns: 1fr 1fr;
    gap: var(--space-3);
    align-items: start;
  }
  .choices label {
    display: grid;
    gap: var(--space-1);
  }
  .choices .full {
    grid-column: 1 / -1;
  }
`;

/** A number field with its unit inside the border. The unit can have any length. */
export const numberFieldStyles = css`
  .number {
    display: flex;
    align-items: center;
    min-width: 0;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--field);
    cursor: text;
  }
  .number input[type="text"] {
    flex: 1;
    min-width: 2.5rem;
    min-height: calc(var(--control) - 2 * var(--edge));
    border: 0;
    background: none;
    text-align: right;
    outline: none;
  }
  .number > span {
    order: 1;
    flex: 0 1 auto;
    max-width: 60%;
    padding-right: var(--space-2);
    overflow: hidden;
    color: var(--ink-soft);
    font-size: var(--text-small);
    text-overflow: ellipsis;
    white-space: nowrap;
    pointer-events: none;
  }
  .number > span:empty {
    display: none;
  }
  .number:has(> span:not(:empty)) input {
    padding-right: var(--space-1);
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
    border-radius: var(--radius-tiny);
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

/** A chip with one or two words about the adjacent content. */
export const chipStyles = css`
  .chip {
    padding: var(--space-half) var(--space-2);
    border-radius: var(--radius-round);
    background: var(--calm-soft);
    color: var(--calm);
    font-size: var(--text-tiny);
    font-weight: 600;
    white-space: nowrap;
  }
`;

/**
 * A dialog that uploads files. It shows the content of the files, the numbers that define their
 * position, and the progress.
 */
export const filesStyles = css`
  .part {
    display: grid;
    gap: var(--space-2);
  }
  .found {
    padding: var(--space-2) var(--space-3);
    border-radius: var(--radius-small);
    background: var(--calm-soft);
    font-size: var(--text-small);
  }
  textarea {
    font: var(--text-body) var(--mono);
  }
  progress {
    width: 100%;
    height: 0.375rem;
    accent-color: var(--accent);
  }
`;

/** A radio group with the name and a hint of each choice. */
export const formatChoiceStyles = css`
  .formats {
    display: grid;
    grid-template-columns: minmax(0, 1fr) minmax(0, 1fr);
    gap: var(--space-2);
  }
  .formats button {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    justify-items: start;
    align-content: start;
    gap: var(--space-half);
    padding: var(--space-2) var(--space-3);
    text-align: start;
    white-space: normal;
  }
  .formats button[aria-checked="true"] {
    border-color: var(--accent);
    box-shadow: inset 0 0 0 1px var(--accent);
    background: var(--accent-soft);
  }
  .formats button[aria-checked="true"] .hint {
    color: var(--ink);
  }
`;
