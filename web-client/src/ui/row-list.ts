// The list of a dialog. It shows the name, description and commands of each item, and the result of
// the last command.

import { css, html, nothing, type TemplateResult } from "lit";
import { repeat } from "lit/directives/repeat.js";

export interface Note {
  kind: "error" | "done";
  text: string;
}

export interface ListedRow {
  name: unknown;
  /** The accessible name of the row. */
  label?: string;
  /** The content before the name. */
  glyph?: unknown;
  /** The content after the name. */
  beside?: unknown;
  /** The content below the name. */
  about?: unknown;
  tools?: unknown;
  note?: Note | null;
}

/**
 * Renders a list. Use it with `rowListStyles`. `label` is the accessible name of the list, or the
 * id of an element with the name.
 */
export const rowList = <T extends { id: number | string }>(
  things: readonly T[],
  row: (thing: T) => ListedRow,
  { label, labelledBy }: { label?: string; labelledBy?: string } = {},
): TemplateResult =>
  html`<ul class="rows" aria-label=${label ?? nothing} aria-labelledby=${labelledBy ?? nothing}>
    ${repeat(
      things,
      ({ id }) => id,
      (thing) => listed(row(thing)),
    )}
  </ul>`;

const listed = ({ name, label, glyph, beside, about, tools, note }: ListedRow): TemplateResult =>
  html`<li aria-label=${label ?? nothing}>
    ${glyph ?? nothing}
    <div class="about">
      <div class="row"><b>${name}</b>${beside ?? nothing}</div>
      ${about ?? nothing}
    </div>
    ${tools ? html`<div class="buttons">${tools}</div>` : nothing}
    ${note ? html`<span class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</span>` : nothing}
  </li>`;

export const rowListStyles = css`
  .rows {
    display: grid;
    margin: 0;
    padding: 0;
    list-style: none;
  }
  .rows:empty {
    display: none;
  }
  .rows > li {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: var(--space-1) var(--space-3);
    padding: var(--space-2) 0;
  }
  .rows > li + li {
    border-top: var(--edge) solid var(--line);
  }
  .rows > li > .glyph {
    flex: none;
    color: var(--ink-soft);
  }
  .rows .about {
    display: grid;
    flex: 1 1 12rem;
    gap: var(--space-half);
    min-width: 0;
  }
  .rows .about > .row {
    flex-wrap: wrap;
    gap: var(--space-1) var(--space-2);
  }
  .rows b {
    font-weight: 600;
    overflow-wrap: anywhere;
    unicode-bidi: plaintext;
  }
  .rows .hint {
    overflow-wrap: anywhere;
  }
  .rows .buttons {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: var(--space-2);
  }
  .rows select {
    width: auto;
  }
  .rows > li > .error,
  .rows > li > .done {
    flex-basis: 100%;
    font-size: var(--text-small);
  }
  .rows > li > .done {
    color: var(--calm);
  }
`;
