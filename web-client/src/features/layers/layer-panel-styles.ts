// Styles of <strata-layer-panel>.

import { css } from "lit";

export const layerPanelStyles = css`
  :host {
    display: block;
  }
  .list {
    display: grid;
    grid-template-columns: minmax(0, 1fr); /* a long name does not widen its card */
    gap: var(--space-2);
    margin: 0;
    padding: 0;
    list-style: none;
  }
  li.layer {
    border: var(--edge) solid var(--line);
    border-radius: var(--radius);
    background: var(--raised);
  }
  li.layer.selected {
    border-color: var(--accent);
    box-shadow: inset 3px 0 0 var(--accent);
  }
  .line {
    display: flex;
    align-items: center;
    gap: var(--space-half);
    padding: var(--space-1) var(--space-1) var(--space-1) var(--space-half);
  }
  .name {
    flex: 1;
    justify-content: flex-start;
    min-width: 0;
    padding: 0 var(--space-2);
    gap: var(--space-2);
  }
  .name.off {
    color: var(--ink-soft);
  }
  .selected .name {
    padding-block: var(--space-2);
    font-weight: 600;
    text-align: start;
    white-space: normal; /* the selected layer shows its full name */
  }
  .selected .name .ellipsis {
    overflow-wrap: anywhere;
    white-space: normal;
  }
  .lock,
  .seen-by {
    display: grid;
    place-items: center;
    width: 1.375rem;
    color: var(--ink-soft);
  }
  .locked {
    display: grid;
    grid-template-columns: auto minmax(0, 1fr);
    align-items: start;
    gap: var(--space-1) var(--space-2);
    color: var(--ink-soft);
    font-size: var(--text-small);
  }
  .locked button {
    grid-column: 2;
    justify-self: start;
  }
  .more {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: var(--space-3);
    padding: var(--space-2) var(--space-3) var(--space-3);
    border-top: var(--edge) solid var(--line);
  }
  .more p.description {
    color: var(--ink-soft);
    font-size: var(--text-small);
    overflow-wrap: anywhere;
  }
  .opacity {
    display: grid;
    grid-template-columns: auto 1fr 3.25rem;
    align-items: center;
    gap: var(--space-2);
    font-size: var(--text-small);
  }
  .opacity output {
    text-align: right;
    white-space: nowrap;
  }
  .personal {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: var(--space-1) var(--space-3);
    margin-top: var(--space-2);
    padding: var(--space-2) var(--space-3);
    border-radius: var(--radius-small);
    background: var(--calm-soft);
    font-size: var(--text-small);
  }
  .personal span {
    flex-basis: 100%;
  }
  .personal button.link {
    color: var(--calm);
  }
  .formula {
    display: grid;
    gap: var(--space-2);
    justify-items: start;
    font-size: var(--text-small);
  }
  .formula code {
    font: var(--text-small) var(--mono);
    white-space: pre-wrap;
    word-break: break-word;
  }
  .empty {
    display: grid;
    gap: var(--space-2);
    justify-items: start;
    padding: var(--space-4);
    border: var(--edge) dashed var(--line-strong);
    border-radius: var(--radius);
  }
  .empty p {
    color: var(--ink-soft);
    font-size: var(--text-small);
  }
`;
