// Styles of the dialog for measured figures: its fields next to the sheet, and on phones below it.

import { css } from "lit";

export const figureStyles = css`
  .editor {
    display: grid;
    grid-template-columns: minmax(0, 5fr) minmax(0, 6fr);
    gap: 1rem 1.625rem;
    align-items: start;
  }
  .fields {
    display: grid;
    grid-template-columns: minmax(0, 1fr) minmax(0, 1fr);
    gap: 0.875rem 0.75rem;
  }
  .fields > * {
    min-width: 0;
  }
  .full {
    grid-column: 1 / -1;
  }
  .fields > .error {
    grid-column: 1 / -1;
    margin-top: -0.375rem;
  }
  .group {
    display: grid;
    gap: 5px;
    align-content: start;
  }
  .segments {
    display: flex;
  }
  .segments button {
    padding: 0 0.375rem;
    min-width: 0;
  }
  .own {
    display: flex;
    align-items: center;
    gap: 0.5rem;
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
    gap: 0.5rem;
  }
  .formats button {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    justify-items: start;
    align-content: start;
    gap: 1px;
    padding: 0.4375rem 0.6875rem;
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
    gap: 0.625rem;
  }
  .warning {
    display: flex;
    flex-wrap: wrap;
    gap: 4px 0.875rem;
    padding: 0.625rem 0.875rem;
    border-radius: var(--radius-small);
    background: var(--warn-soft);
    color: var(--ink);
    font-size: 0.92rem;
  }
  .making,
  .told {
    flex: 1 1 15rem;
    align-self: center;
    display: grid;
    gap: 4px;
    min-width: 0;
    overflow-wrap: anywhere;
  }
  .told.nothing {
    flex-basis: 0; /* keeps the buttons in one row */
  }
  .bar {
    height: 0.375rem;
    border-radius: 3px;
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
