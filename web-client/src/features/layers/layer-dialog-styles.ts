// Styles of <strata-layer-dialog>.

import { css } from "lit";

export const layerDialogStyles = css`
  .kinds {
    display: grid;
    grid-template-columns: repeat(2, 1fr);
    gap: 0.625rem;
    margin-top: 0.375rem;
  }
  .kinds button {
    display: grid;
    place-content: start stretch;
    justify-items: start;
    gap: 3px;
    height: auto;
    padding: 0.75rem 0.8125rem;
    text-align: left;
    white-space: normal;
    border-radius: var(--radius);
  }
  .kinds button b {
    font: 600 1.02rem var(--serif);
  }
  .kinds button span {
    font-size: 0.82rem;
    line-height: 1.35;
    color: var(--ink-soft);
  }
  .kinds button:last-child:nth-child(odd) {
    grid-column: 1 / -1;
  }
  .kinds button[aria-checked="true"] {
    border-color: var(--accent);
    box-shadow: inset 0 0 0 1px var(--accent);
    background: var(--accent-soft);
  }
  .two {
    display: flex;
    gap: 0.75rem;
    align-items: end;
  }
  .two > label:first-child {
    flex: 1;
  }
  .classes {
    display: grid;
    gap: 0.4375rem;
    max-height: 16.875rem;
    overflow: auto;
    padding: 3px;
    margin: -3px;
  }
  .class {
    display: flex;
    gap: 0.5rem;
    align-items: center;
  }
  .range {
    display: grid;
    grid-template-columns: 1fr auto 1fr 6rem;
    align-items: end;
    gap: 0.625rem;
  }
  .range > span {
    padding-bottom: 0.5625rem;
    color: var(--ink-soft);
  }
  .details {
    display: grid;
    gap: 5px;
  }
  .details .segments {
    display: flex;
  }
  .details .segments button {
    min-height: 2.375rem;
  }
  .chosen-lead {
    display: none;
  }
  /* leaves room for the fields below */
  @media (max-width: 560px) {
    .kinds {
      gap: 0.5rem;
    }
    .kinds button {
      position: relative;
      align-content: center;
      padding: 0.5rem 0.6875rem;
    }
    .kinds button b {
      font-size: 0.95rem;
      line-height: 1.2;
    }
    .kinds button span {
      position: absolute;
      width: 1px;
      height: 1px;
      overflow: hidden;
      clip-path: inset(50%);
    }
    .chosen-lead {
      display: block;
      margin-top: 0.5rem;
    }
    .range {
      grid-template-columns: 1fr auto 1fr;
    }
  }
`;
