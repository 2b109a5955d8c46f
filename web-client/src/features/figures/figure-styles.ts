// Styles of the dialog for measured figures: its fields next to the sheet, and on phones below it.

import { css } from "lit";

export const figureStyles = css`
  .editor {
    display: grid;
    grid-template-columns: minmax(0, 5fr) minmax(0, 6fr);
    gap: var(--space-4) var(--space-6);
    align-items: start;
  }
  .fields {
    display: grid;
    grid-template-columns: minmax(0, 1fr) minmax(0, 1fr);
    gap: var(--space-3) var(--space-3);
  }
  .fields > * {
    min-width: 0;
  }
  .full {
    grid-column: 1 / -1;
  }
  .fields > .error {
    grid-column: 1 / -1;
    margin-top: calc(-1 * var(--space-2));
  }
  .group {
    display: grid;
    gap: var(--space-1);
    align-content: start;
  }
  .segments {
    display: flex;
  }
  .segments button {
    padding: 0 var(--space-2);
    min-width: 0;
  }
  .own {
    display: flex;
    align-items: center;
    gap: var(--space-2);
  }
  .own input {
    width: 6.875rem;
  }
  textarea {
    min-height: 3.625rem;
  }
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
  .sheet {
    position: sticky; /* stays visible next to the fields, which are longer */
    top: 0;
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-2);
  }
  .warning {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-1) var(--space-3);
    padding: var(--space-2) var(--space-3);
    border-radius: var(--radius-small);
    background: var(--warn-soft);
    color: var(--ink);
    font-size: var(--text-small);
  }
  .making,
  .told {
    flex: 1 1 15rem;
    align-self: center;
    display: grid;
    gap: var(--space-1);
    min-width: 0;
    overflow-wrap: anywhere;
  }
  .told.nothing {
    flex-basis: 0; /* keeps the buttons in a single row */
  }
  .bar {
    height: 0.375rem;
    border-radius: var(--radius-tiny);
    overflow: hidden;
    background: var(--line);
  }
  .bar i {
    display: block;
    height: 100%;
    background: var(--accent);
  }
  @media (max-width: 760px) {
    .editor {
      grid-template-columns: minmax(0, 1fr);
    }
    .sheet {
      position: static;
      order: -1;
    }
    strata-figure-preview {
      --most-sheet: 36dvh;
      --least-sheet: 11.25rem;
    }
  }
`;
