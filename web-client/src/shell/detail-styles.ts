// Layout of dialogs that only display values: names on the left, values on the right.

import { css } from "lit";

export const detailStyles = css`
  h3 {
    margin: var(--space-half) 0 calc(-1 * var(--space-2));
    font: 600 var(--text-large) var(--serif);
  }
  dl {
    display: grid;
    grid-template-columns: minmax(9.375rem, auto) 1fr;
    gap: var(--space-2) var(--space-4);
    margin: 0;
  }
  dt {
    color: var(--ink-soft);
  }
  dd {
    margin: 0;
    overflow-wrap: anywhere;
  }
  .parts section + section {
    margin-top: var(--space-4);
  }
  .parts h3 {
    margin: var(--space-half) 0 var(--space-2);
    break-after: avoid;
  }
  dl.keys {
    display: block;
  }
  .keys > div {
    display: grid;
    grid-template-columns: minmax(6.875rem, 44%) 1fr;
    align-items: baseline;
    gap: var(--space-4);
    padding-bottom: var(--space-2);
    break-inside: avoid;
  }
  .keys.commands {
    columns: 2;
    column-gap: var(--space-6);
  }
  .keys.commands > div {
    grid-template-columns: 6.5rem 1fr;
    gap: var(--space-3);
  }
  .guides {
    display: flex;
    flex-wrap: wrap;
    gap: var(--space-2) var(--space-5);
    margin: var(--space-5) 0 0;
  }
  .version {
    margin: var(--space-5) 0 0;
    color: var(--ink-soft);
    font-size: var(--text-small);
  }
  .keys dt {
    color: var(--ink);
    font-weight: 600;
  }
  @media (min-width: 2560px) {
    .parts {
      columns: 2;
      column-gap: var(--space-12);
    }
  }
  @media (max-width: 560px) {
    .keys.commands {
      columns: 1;
    }
    dl,
    .keys > div {
      grid-template-columns: minmax(6.875rem, 40%) 1fr;
    }
  }
`;
