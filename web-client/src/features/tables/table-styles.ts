import { css } from "lit";

export const tableStyles = css`
  :host {
    display: flex;
    flex-direction: column;
    min-width: 0;
    min-height: 0;
    background: var(--surface);
    container-type: inline-size;
  }
  :host(.over) {
    box-shadow: inset 0 0 0 3px var(--accent);
  }
  .chosen > .ellipsis {
    flex: 0 1 auto;
    min-width: 4rem;
  }
  .chosen > button {
    flex: none;
    min-height: 2rem;
  }
  .chosen > button.icon {
    width: 2rem;
  }
  .thumbnail {
    height: 1.5rem;
    width: 2rem;
    margin-right: var(--space-1);
    object-fit: cover;
    border-radius: var(--radius-tiny);
    vertical-align: middle;
  }
  /* below the rows, which do not move when a row is selected */
  .chosen {
    display: flex;
    align-items: center;
    flex: none;
    gap: var(--space-half);
    min-width: 0;
    padding: var(--space-half) var(--space-2) var(--space-half) var(--space-3);
    border-top: var(--edge) solid var(--line);
    background: var(--accent-soft);
    font-size: var(--text-small);
    white-space: nowrap;
  }
  .wrong {
    display: grid;
    gap: var(--space-half);
    padding: var(--space-2) var(--space-3);
    border-bottom: var(--edge) solid var(--line);
    background: var(--danger-soft);
  }
  .scroller {
    flex: 1;
    position: relative;
    min-height: 0;
    overflow: auto;
    font-size: var(--text-small);
    outline: 0;
    scrollbar-gutter: stable;
  }
  .scroller:focus-visible:not(:has(.cell.active)) {
    outline: var(--focus);
    outline-offset: -3px;
  }
  .scroller:focus-visible .cell.active,
  .scroller:focus-within .cell.active {
    box-shadow: inset 0 0 0 2px var(--accent);
  }
  .head,
  .line {
    display: grid;
    grid-template-columns: var(--columns);
    width: max-content;
    min-width: 100%;
  }
  .head {
    position: sticky;
    z-index: 3;
    top: 0;
    grid-auto-rows: 2.0625rem;
    height: 2.125rem;
    border-bottom: var(--edge) solid var(--line-strong);
    background: var(--paper);
  }
  .body {
    position: relative;
  }
  .line {
    position: absolute;
    left: 0;
    height: var(--row);
    border-bottom: var(--edge) solid var(--line);
    background: var(--raised);
  }
  .line.chosen-row,
  .line.chosen-row .cell.key {
    background: var(--accent-soft);
  }
  .cell {
    display: flex;
    align-items: center;
    min-width: 0;
    padding: 0 var(--space-2);
    border-right: var(--edge) solid var(--line);
    cursor: default;
  }
  .cell.number {
    justify-content: flex-end;
  }
  .cell.key {
    position: sticky;
    z-index: 1;
    left: 0;
    gap: var(--space-2);
    background: var(--surface);
    cursor: pointer;
  }
  .cell.key .writer {
    display: grid;
    margin-left: auto;
    color: var(--accent);
  }
  .cell.key .writer .glyph {
    width: 0.9375rem;
    height: 0.9375rem;
  }
  .line.held:not(.chosen-row),
  .line.held:not(.chosen-row) .cell.key {
    background: var(--calm-soft);
  }
  .cell.key .swatch {
    width: 0.75rem;
    height: 0.75rem;
  }
  .cell.saving {
    color: var(--ink-soft);
    font-style: italic;
  }
  .cell.refused {
    box-shadow: inset 0 0 0 2px var(--danger);
    background: var(--danger-soft);
  }
  .cell.computed {
    color: var(--ink-soft);
  }
  .head .cell {
    position: relative;
    padding: 0 0 0 var(--space-half);
  }
  .head .cell.key {
    position: sticky;
    z-index: 1;
    background: var(--paper);
  }
  .head .sort {
    flex: 1;
    justify-content: flex-start;
    min-width: 0;
    min-height: var(--control-small);
    padding: 0 var(--space-2);
    border: 0;
    background: none;
    font-weight: 600;
    font-size: var(--text-small);
    gap: var(--space-1);
  }
  .head .number .sort {
    justify-content: flex-end;
  }
  .head .unit {
    font-weight: 400;
    color: var(--ink-soft);
  }
  .head .required {
    color: var(--danger);
  }
  .head .by-column {
    width: 1.375rem;
    min-height: var(--control-small);
    color: var(--ink-soft);
  }
  .head .by-column.on {
    color: var(--accent);
  }
  .head .by-column.on svg {
    fill: currentColor;
  }
  .head svg.glyph {
    width: 0.875rem;
    height: 0.875rem;
  }
  .edge {
    position: absolute;
    z-index: 2;
    right: -4px;
    top: 0;
    bottom: 0;
    width: 0.5rem;
    cursor: col-resize;
    touch-action: none;
  }
  .edge:hover {
    background: var(--accent-soft);
  }
  .editor {
    position: absolute;
    z-index: 4;
    padding: var(--space-half);
    border-radius: var(--radius-small);
    background: var(--raised);
    box-shadow: var(--shadow);
  }
  .bubble {
    position: absolute;
    z-index: 5;
    display: grid;
    gap: var(--space-2);
    width: max-content;
    max-width: 23.75rem;
    padding: var(--space-2) var(--space-3);
    border: var(--edge) solid var(--danger);
    border-radius: var(--radius-small);
    background: var(--raised);
    box-shadow: var(--shadow);
    font-size: var(--text-small);
    white-space: normal;
    cursor: default;
  }
  .bubble .row {
    flex-wrap: wrap;
    gap: var(--space-2);
  }
  .bubble button {
    min-height: var(--control-small);
  }
  .empty {
    display: grid;
    gap: var(--space-2);
    justify-items: start;
    padding: var(--space-4);
    color: var(--ink-soft);
  }
`;
