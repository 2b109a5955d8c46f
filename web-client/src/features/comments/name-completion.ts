// Completes user names after an @ in a comment. The field is a combobox while it suggests names,
// and its list appears at the field.

import { css, html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";
import { mentionBegun, peopleLike } from "../../domain/mentions";
import type { ProjectPerson } from "../../core/protocol.gen";
import { personMark } from "../../ui/person-mark";
import { texts } from "../../texts";

export const nameCompletionStyles = css`
  .names {
    display: grid;
    gap: var(--space-half);
    margin: 0;
    padding: var(--space-1);
    list-style: none;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--paper);
  }
  .names li {
    display: flex;
    align-items: center;
    gap: var(--space-2);
    min-height: 36px;
    padding: var(--space-half) var(--space-2);
    border-radius: var(--radius-small);
    cursor: pointer;
    overflow-wrap: anywhere;
  }
  .names li[aria-selected="true"] {
    background: var(--accent-soft);
  }
`;

export class NameCompletion {
  // the field with the caret, while it suggests names
  private _field: HTMLTextAreaElement | null = null;
  private _at = 0; // index of the @
  private _people: readonly ProjectPerson[] = [];
  private _chosen = 0;

  constructor(
    private readonly _host: ReactiveControllerHost,
    /** Loads the users that a comment can mention, on demand. */
    private readonly _all: () => Promise<readonly ProjectPerson[]>,
  ) {}

  /** Returns whether the field with this name suggests user names. */
  offersIn(name: string): boolean {
    return this._field?.name === name;
  }
  /** The id of the active option. */
  get active(): string {
    return `name-${this._chosen}`;
  }

  /** Call this after the text or the caret has changed. */
  async look(field: HTMLTextAreaElement): Promise<void> {
    if (!mentionBegun(field.value, field.selectionStart)) return this.close();
    const all = await this._all();
    // the user may have typed more while the list of users was loading
    const begun = mentionBegun(field.value, field.selectionStart);
    const people = begun && field.matches(":focus") ? peopleLike(all, begun.word) : [];
    const isWhole =
      people.length === 1 && people[0]!.user.toLowerCase() === begun?.word.toLowerCase();
    if (!begun || people.length === 0 || isWhole) return this.close();
    this._field = field;
    this._at = begun.at;
    this._people = people;
    this._chosen = 0;
    this._host.requestUpdate();
  }

  close(): void {
    if (!this._field) return;
    this._field = null;
    this._host.requestUpdate();
  }

  /**
   * Arrow keys choose, Enter and Tab accept, and Escape closes only the list. Returns true if the
   * list used the key.
   */
  onKey(event: KeyboardEvent): boolean {
    if (!this._field || event.ctrlKey || event.metaKey || event.altKey || event.isComposing)
      return false;
    const count = this._people.length;
    if (event.key === "ArrowDown" || event.key === "ArrowUp")
      this._chosen = (this._chosen + (event.key === "ArrowDown" ? 1 : count - 1)) % count;
    else if (event.key === "Enter" || (event.key === "Tab" && !event.shiftKey))
      this.take(this._chosen);
    else if (event.key === "Escape") this.close();
    else return false;
    event.preventDefault();
    event.stopPropagation();
    this._host.requestUpdate();
    return true;
  }

  list(): TemplateResult {
    return html`<ul id="names" class="names" role="listbox" aria-label=${texts.comments.names}>
      ${this._people.map(
        (person, index) =>
          html`<li
            id="name-${index}"
            role="option"
            aria-selected=${index === this._chosen}
            @pointerdown=${(event: Event) => {
              event.preventDefault(); // the field keeps the focus
              this.take(index);
            }}
          >
            ${personMark(person)}<span><b>${person.user}</b>${person.full_name ? html` <span class="hint">${person.full_name}</span>` : nothing}</span>
          </li>`,
      )}
    </ul>`;
  }

  private take(index: number): void {
    const field = this._field;
    const person = this._people[index];
    if (!field || !person) return;
    const caret = field.selectionStart;
    const space = /^\s/.test(field.value.slice(caret)) ? "" : " ";
    field.setRangeText(`@${person.user}${space}`, this._at, caret, "end");
    this.close();
    field.dispatchEvent(new Event("input"));
  }
}
