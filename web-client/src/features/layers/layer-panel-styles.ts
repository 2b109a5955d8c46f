// Styles of <strata-layer-panel>.

import { css } from "lit";

export const layerPanelStyles = css`
  :host {
    display: block;
  }
  .heading {
    display: flex;
    align-items: center;
    gap: 0.5rem;
    margin-bottom: 0.5rem;
  }
  h2 {
    flex: 1;
    font-size: 1.08rem;
  }
  .list {
    display: grid;
    grid-template-columns: minmax(0, 1fr); /* a long name does not widen its card */
    gap: 0.375rem;
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
    gap: 2px;
    padding: 3px 4px 3px 2px;
  }
  .name {
    flex: 1;
    justify-content: flex-start;
    min-width: 0;
    padding: 0 0.5rem;
    gap: 0.625rem;
  }
  .name.off {
    color: var(--ink-soft);
  }
  .selected .name {
    padding-block: 0.375rem;
    font-weight: 600;
    text-align: start;
    white-space: normal; /* the selected layer shows its whole name */
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
    gap: 0.25rem 0.5rem;
    color: var(--ink-soft);
    font-size: 0.88rem;
  }
  .locked button {
    grid-column: 2;
    justify-self: start;
  }
  .more {
    display: grid;
    grid-template-columns: minmax(0, 1fr);
    gap: 0.75rem;
    padding: 0.375rem 0.875rem 0.875rem;
    border-top: var(--edge) solid var(--line);
  }
  .more p.description {
    color: var(--ink-soft);
    font-size: 0.88rem;
    overflow-wrap: anywhere;
  }
  .opacity {
    display: grid;
    grid-template-columns: auto 1fr 3.25rem;
    align-items: center;
    gap: 0.625rem;
    font-size: 0.88rem;
  }
  .opacity output {
    text-align: right;
    white-space: nowrap;
  }
  .personal {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 4px 0.875rem;
    margin-top: 0.625rem;
    padding: 0.5625rem 0.75rem;
    border-radius: var(--radius-small);
    background: var(--calm-soft);
    font-size: 0.86rem;
  }
  .personal span {
    flex-basis: 100%;
  }
  .personal button.link {
    color: var(--calm);
  }
  .formula {
    display: grid;
    gap: 0.5rem;
    justify-items: start;
    font-size: 0.88rem;
  }
  .formula code {
    font: 0.86rem var(--mono);
    white-space: pre-wrap;
    word-break: break-word;
  }
  .empty {
    display: grid;
    gap: 0.625rem;
    justify-items: start;
    padding: 1rem;
    border: var(--edge) dashed var(--line-strong);
    border-radius: var(--radius);
  }
  .empty p {
    color: var(--ink-soft);
    font-size: 0.9rem;
  }
`;
