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
