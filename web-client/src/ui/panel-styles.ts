// Styles of the lists in the side panel.

import { css } from "lit";

/** Lines in a panel, each a button with three columns: person, content and time. */
export const panelLineStyles = css`
  ul {
    display: grid;
    gap: 2px;
    margin: 0 -0.5rem;
    padding: 0;
    list-style: none;
  }
  .line {
    display: grid;
    grid-template-columns: auto minmax(0, 1fr) auto;
    justify-content: stretch;
    align-items: start;
    gap: 1px 0.625rem;
    width: 100%;
    min-height: 0;
    padding: 0.5rem;
    text-align: left;
    white-space: normal;
  }
  .line .person-mark {
    grid-row: span 2;
  }
`;

/** Heading of a list in a panel, with its buttons. */
export const listHeadStyles = css`
  :host {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 0.625rem;
  }
  .row {
    flex-wrap: wrap;
    min-height: 1.875rem;
  }
  h3 {
    flex: 1;
    font-size: 0.8rem;
    font-weight: 600;
    color: var(--ink-soft);
  }
  ul {
    display: grid;
    gap: 2px;
    margin: 0;
    padding: 0;
    list-style: none;
  }
`;

/** Rows of such a list: a button with a name, as wide as the panel, and its menu. */
export const listRowStyles = css`
  ul {
    margin-left: -0.5rem;
  }
  li {
    display: grid;
    grid-template-columns: minmax(0, 1fr) auto;
    align-items: start;
    gap: 2px;
  }
  li > button {
    display: grid;
    justify-content: stretch;
    padding: 0.4375rem 0.5rem;
    text-align: start;
    white-space: normal;
  }
  b {
    font-weight: 600;
    overflow-wrap: anywhere;
    unicode-bidi: plaintext;
  }
`;
