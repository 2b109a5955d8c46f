// Styles of the controls over the 3D view.

import { css } from "lit";

export const controlStyles = css`
  :host {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-2);
  }
  .segments {
    display: flex;
  }
  .segments button {
    flex: 1 1 auto; /* the element is at least as wide as its text */
    padding: 0 var(--space-2);
  }
  output {
    text-align: right;
    white-space: nowrap;
  }
  .slider {
    display: grid;
    grid-template-columns: auto 1fr 4.75rem;
    align-items: center;
    gap: var(--space-2);
    font-size: var(--text-small);
  }
  .box {
    display: grid;
    gap: var(--space-half);
  }
`;
