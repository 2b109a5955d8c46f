// Layout of dialogs that only display: names at the left, values at the right.

import { css } from "lit";

export const detailStyles = css`
  h3 {
    margin: 2px 0 -0.5rem;
    font: 600 1rem var(--serif);
  }
  dl {
    display: grid;
    grid-template-columns: minmax(9.375rem, auto) 1fr;
    gap: 0.4375rem 1.125rem;
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
    margin-top: 1rem;
  }
  .parts h3 {
    margin: 2px 0 0.5rem;
    break-after: avoid;
  }
  dl.keys {
    display: block;
  }
  .keys > div {
    display: grid;
    grid-template-columns: minmax(6.875rem, 44%) 1fr;
    gap: 1.125rem;
    padding-bottom: 0.4375rem;
    break-inside: avoid;
  }
  .guides {
    display: flex;
    flex-wrap: wrap;
    gap: 0.5rem 1.25rem;
    margin: 1.25rem 0 0;
  }
  .version {
    margin: 1.25rem 0 0;
    color: var(--ink-soft);
  }
  .keys dt {
    color: var(--ink);
    font-weight: 600;
  }
  @media (min-width: 2560px) {
    .parts {
      columns: 2;
      column-gap: 3rem;
    }
  }
  @media (max-width: 560px) {
    dl,
    .keys > div {
      grid-template-columns: minmax(6.875rem, 40%) 1fr;
    }
  }
`;
