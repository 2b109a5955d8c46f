// Styles that the dialogs for regions share.

import { css } from "lit";

export const regionStyles = css`
  .operations {
    display: grid;
    gap: var(--space-1);
  }
  .operations button {
    justify-content: start;
    text-align: left;
  }
  .operations button[aria-checked="true"] {
    border-color: var(--accent);
  }
  .size {
    display: flex;
    align-items: center;
    gap: var(--space-2);
  }
  .size input {
    width: 130px;
  }
  .check {
    display: flex;
    align-items: center;
    gap: var(--space-2);
    min-height: 30px;
  }
  .progress {
    height: 5px;
    border-radius: var(--radius-tiny);
    overflow: hidden;
    background: var(--line);
  }
  .progress i {
    display: block;
    height: 100%;
    background: var(--accent);
  }
`;
