// Styles of <strata-people-dialog>.

import { css } from "lit";

export const peopleDialogStyles = css`
  .bar {
    position: sticky;
    z-index: 1;
    top: -0.875rem; /* covers the padding of the dialog */
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0.625rem 0.75rem;
    padding: 0.875rem 0 0.625rem;
    margin: -0.875rem 0 -0.375rem;
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
    gap: 0.375rem 1rem;
    margin: 0;
    padding: 0;
    border: 0;
  }
  fieldset legend {
    padding: 0 0 5px;
  }
  fieldset label {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    min-height: 1.75rem;
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
    margin-top: 5px;
  }
  table {
    width: 100%;
    border-collapse: collapse;
  }
  th {
    padding: 4px 0.625rem 0.375rem 0;
    text-align: left;
    font-size: 0.8rem;
    color: var(--ink-soft);
  }
  td {
    padding: 0.4375rem 0.625rem 0.4375rem 0;
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
    font-size: 0.86rem;
  }
  td .done {
    color: var(--calm);
  }
  td select {
    width: auto;
    min-height: 2.125rem;
    padding: 3px 0.5rem;
  }
  .seen {
    white-space: nowrap;
    font-size: 0.86rem;
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
    gap: 4px;
    margin-top: 3px;
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
      gap: 0.375rem 0.75rem;
      padding: 0.625rem 0;
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
