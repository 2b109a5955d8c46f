// Styles of the dialog for condition reports: the title block next to the sections, and on phones
// above them.

import { css } from "lit";

export const reportStyles = css`
  .editor {
    display: grid;
    grid-template-columns: minmax(0, 5fr) minmax(0, 6fr);
    gap: var(--space-4) var(--space-6);
    align-items: start;
  }
  .fields {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-3);
  }
  .group {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-1);
    align-content: start;
  }
  .segments {
    display: flex;
  }
  .layers {
    display: grid;
    gap: var(--space-1);
  }
  .layers label {
    min-width: 0;
    overflow-wrap: anywhere;
  }
  button.link {
    justify-self: start;
  }
  @media (pointer: coarse) {
    .layers label {
      min-height: var(--control-touch);
    }
  }
  @media (max-width: 760px) {
    .editor {
      grid-template-columns: minmax(0, 1fr);
    }
  }
`;
