// Styles of <strata-people-dialog>.

import { css } from "lit";

export const peopleDialogStyles = css`
  .bar {
    position: sticky;
    z-index: 1;
    top: -0.875rem; /* covers the dialog's padding */
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: var(--space-2) var(--space-3);
    padding: var(--space-3) 0 var(--space-2);
    margin: calc(-1 * var(--space-3)) 0 calc(-1 * var(--space-2));
    background: var(--surface);
  }
  .bar input {
    flex: 1 1 11.25rem;
    max-width: 18.75rem;
  }
  .fields {
    grid-template-columns: 1fr 1fr 1fr;
    align-items: start;
  }
  fieldset {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-2) var(--space-4);
    margin: 0;
    padding: 0;
    border: 0;
  }
  fieldset legend {
    padding: 0 0 var(--space-1);
  }
  fieldset label {
    display: flex;
    align-items: center;
    gap: var(--space-2);
    min-height: var(--control-small);
    overflow-wrap: anywhere;
  }
  fieldset input {
    width: 1.0625rem;
    height: 1.0625rem;
    flex: none;
    margin: 0;
    accent-color: var(--accent);
  }
  .fields small {
    display: block;
    margin-top: var(--space-1);
  }
  table {
    width: 100%;
    border-collapse: collapse;
  }
  th {
    padding: var(--space-1) var(--space-2) var(--space-2) 0;
    text-align: left;
    font-size: var(--text-tiny);
    color: var(--ink-soft);
  }
  td {
    padding: var(--space-2) var(--space-2) var(--space-2) 0;
    border-top: var(--edge) solid var(--line);
  }
  td:last-child {
    width: 2.25rem;
    padding-right: 0;
  }
  td b {
    font-weight: 600;
    overflow-wrap: anywhere;
  }
  td .hint {
    display: block;
    overflow-wrap: anywhere;
  }
  td .error,
  td .done {
    display: block;
    font-size: var(--text-small);
  }
  td .done {
    color: var(--calm);
  }
  td select {
    width: auto;
    min-height: 2.125rem;
    padding: var(--space-1) var(--space-2);
  }
  .seen {
    white-space: nowrap;
    font-size: var(--text-small);
    color: var(--ink-soft);
  }
  .chip.invited {
    background: var(--warn-soft);
    color: var(--warn);
  }
  .chip.disabled {
    background: var(--danger-soft);
    color: var(--danger);
  }
  .chip.you {
    background: var(--accent-soft);
    color: var(--accent);
  }
  td .groups {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-1);
    margin-top: var(--space-1);
  }
  .chip.group {
    white-space: normal;
    overflow-wrap: anywhere;
  }
  .parts {
    justify-self: start;
  }
  @media (max-width: 620px) {
    .fields {
      grid-template-columns: 1fr;
    }
    .bar input {
      max-width: none;
    }
    table,
    tbody {
      display: block;
    }
    thead {
      display: none;
    }
    tr {
      display: grid;
      grid-template-columns: auto 1fr auto;
      align-items: center;
      gap: var(--space-2) var(--space-3);
      padding: var(--space-2) 0;
      border-top: var(--edge) solid var(--line);
    }
    td {
      padding: 0;
      border: 0;
    }
    td.name {
      grid-column: 1 / 3;
    }
    td:last-child {
      grid-area: 1 / 3;
    }
    td.seen {
      grid-column: 1 / 4;
    }
    td.seen::before {
      content: attr(data-label) ": ";
    }
  }
`;
