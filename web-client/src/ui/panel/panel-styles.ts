// Styles of the lists in the side panel.

import { css } from "lit";

/** The heading of a panel, with its tools. */
export const panelHeadingStyles = css`
  .heading {
    display: flex;
    align-items: center;
    gap: var(--space-2);
    min-height: var(--control);
    margin-bottom: var(--space-2);
  }
  h2 {
    flex: 1;
    display: flex;
    align-items: center;
    gap: var(--space-2);
    font-size: var(--text-large);
  }
`;

/** Lines in a panel. Each is a button with three columns: user, content and time. */
export const panelLineStyles = css`
  ul {
    display: grid;
    gap: var(--space-half);
    margin: 0 calc(-1 * var(--space-2));
    padding: 0;
    list-style: none;
  }
  .line {
    display: grid;
    grid-template-columns: auto minmax(0, 1fr) auto;
    justify-content: stretch;
    align-items: start;
    gap: var(--space-half) var(--space-2);
    width: 100%;
    min-height: 0;
    padding: var(--space-2);
    text-align: left;
    white-space: normal;
  }
  .line .person-mark {
    grid-row: span 2;
  }
`;

/** The heading of a list in a panel, with its buttons. */
export const listHeadStyles = css`
  :host {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-2);
  }
  .row {
    flex-wrap: wrap;
    min-height: var(--control-small);
  }
  h3 {
    flex: 1;
    font-size: var(--text-tiny);
    font-weight: 600;
    color: var(--ink-soft);
  }
  ul {
    display: grid;
    gap: var(--space-half);
    margin: 0;
    padding: 0;
    list-style: none;
  }
`;

/** The rows of such a list: a button with a name, as wide as the panel, and a menu. */
export const listRowStyles = css`
  ul {
    margin-left: calc(-1 * var(--space-2));
  }
  li {
    display: grid;
    grid-template-columns: minmax(0, 1fr) auto;
    align-items: start;
    gap: var(--space-half);
  }
  li > button {
    display: grid;
    justify-content: stretch;
    padding: var(--space-2) var(--space-2);
    text-align: start;
    white-space: normal;
  }
  b {
    font-weight: 600;
    overflow-wrap: anywhere;
    unicode-bidi: plaintext;
  }
`;
