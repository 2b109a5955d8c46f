// Styles of the tables of the changes between surveys.

import { css } from "lit";

export const changesStyles = css`
  :host {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-3);
  }
  .scroller {
    max-height: 22rem;
    overflow: auto;
    border: var(--edge) solid var(--line);
    border-radius: var(--radius-small);
  }
  table {
    border-collapse: collapse;
    font-size: var(--text-small);
  }
  th,
  td {
    padding: var(--space-2);
    border-bottom: var(--edge) solid var(--line);
    text-align: end;
    white-space: nowrap;
  }
  th {
    font-weight: 600;
  }
  thead th {
    position: sticky;
    top: 0;
    background: var(--paper);
  }
  th[scope="row"],
  thead th:first-child {
    text-align: start;
  }
  .sum {
    font-weight: 600;
  }
  .same {
    background: var(--hover);
  }
  .swatch {
    display: inline-block;
    margin-inline-end: var(--space-1);
    vertical-align: baseline;
  }
`;
