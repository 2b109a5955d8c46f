// Styles of <strata-layer-dialog>.

import { css } from "lit";

export const layerDialogStyles = css`
  .kinds {
    display: grid;
    grid-template-columns: repeat(2, 1fr);
    gap: var(--space-2);
    margin-top: var(--space-2);
  }
  .kinds button {
    display: grid;
    place-content: start stretch;
    justify-items: start;
    gap: var(--space-1);
    height: auto;
    padding: var(--space-3) var(--space-3);
    text-align: left;
    white-space: normal;
    border-radius: var(--radius);
  }
  .kinds button b {
    font: 600 var(--text-large) var(--serif);
  }
  .kinds button span {
    font-size: var(--text-small);
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
    gap: var(--space-3);
    align-items: end;
  }
  .two > label:first-child {
    flex: 1;
  }
  .classes {
    display: grid;
    gap: var(--space-2);
    max-height: 16.875rem;
    overflow: auto;
    padding: var(--space-1);
    margin: calc(-1 * var(--space-1));
  }
  .class {
    display: flex;
    gap: var(--space-2);
    align-items: center;
  }
  .range {
    display: grid;
    grid-template-columns: 1fr auto 1fr 6rem;
    align-items: end;
    gap: var(--space-2);
  }
  .range > span {
    padding-bottom: var(--space-2);
    color: var(--ink-soft);
  }
  .details {
    display: grid;
    gap: var(--space-1);
  }
  .details .segments {
    display: flex;
  }
  .details .segments button {
    min-height: var(--control);
  }
  .chosen-lead {
    display: none;
  }
  /* leaves space for the fields below */
  @media (max-width: 560px) {
    .kinds {
      gap: var(--space-2);
    }
    .kinds button {
      position: relative;
      align-content: center;
      padding: var(--space-2) var(--space-3);
    }
    .kinds button b {
      font-size: var(--text-body);
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
      margin-top: var(--space-2);
    }
    .range {
      grid-template-columns: 1fr auto 1fr;
    }
  }
`;
