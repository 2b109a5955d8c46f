// Completes the names of people behind an @ while a comment is written: the field is a combobox
// while there are some, and its list follows it.

import { css, html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";
import { mention_begun, people_like } from "../../domain/mentions";
import type { ProjectPerson } from "../../core/protocol.gen";
import { person_mark } from "../../ui/person-mark";
import { texts } from "../../texts";

export const name_completion_styles = css`
  .names {
    display: grid;
    gap: 2px;
    margin: 0;
    padding: 4px;
    list-style: none;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
    background: var(--paper);
  }
  .names li {
    display: flex;
    align-items: center;
    gap: 8px;
    min-height: 36px;
    padding: 2px 8px;
    border-radius: var(--radius-small);
    cursor: pointer;
    overflow-wrap: anywhere;
  }
  .names li[aria-selected="true"] {
    background: var(--accent-soft);
  }
`;

export class NameCompletion {
  private field_: HTMLTextAreaElement | null = null; // that is written in, while names are offered
  private at_ = 0; // of the @
  private people_: readonly ProjectPerson[] = [];
  private chosen_ = 0;

  constructor(
    private readonly host_: ReactiveControllerHost,
    /** Whom one may name; they may come later. */
    private readonly all_: () => Promise<readonly ProjectPerson[]>,
  ) {}

  /** Of the field with that name. */
  offers_in(name: string): boolean {
    return this.field_?.name === name;
  }
  /** The option that the keyboard is on. */
  get active(): string {
    return `name-${this.chosen_}`;
  }

  /** Something was written in the field, or the caret moved. */
  async look(field: HTMLTextAreaElement): Promise<void> {
    if (!mention_begun(field.value, field.selectionStart)) return this.close();
    const all = await this.all_();
    // more may have been written meanwhile
    const begun = mention_begun(field.value, field.selectionStart);
    const people = begun && field.matches(":focus") ? people_like(all, begun.word) : [];
    const is_whole =
      people.length === 1 && people[0]!.user.toLowerCase() === begun?.word.toLowerCase();
    if (!begun || people.length === 0 || is_whole) return this.close();
    this.field_ = field;
    this.at_ = begun.at;
    this.people_ = people;
    this.chosen_ = 0;
    this.host_.requestUpdate();
  }

  close(): void {
    if (!this.field_) return;
    this.field_ = null;
    this.host_.requestUpdate();
  }

  /**
   * Arrows choose, Enter and Tab take, Escape closes the list alone. True: the key was for the
   * list.
   */
  on_key(event: KeyboardEvent): boolean {
    if (!this.field_ || event.ctrlKey || event.metaKey || event.altKey || event.isComposing)
      return false;
    const count = this.people_.length;
    if (event.key === "ArrowDown" || event.key === "ArrowUp")
      this.chosen_ = (this.chosen_ + (event.key === "ArrowDown" ? 1 : count - 1)) % count;
    else if (event.key === "Enter" || (event.key === "Tab" && !event.shiftKey))
      this.take(this.chosen_);
    else if (event.key === "Escape") this.close();
    else return false;
    event.preventDefault();
    event.stopPropagation();
    this.host_.requestUpdate();
    return true;
  }

  list(): TemplateResult {
    return html`<ul id="names" class="names" role="listbox" aria-label=${texts.comments.names}>
      ${this.people_.map(
        (person, index) =>
          html`<li
            id="name-${index}"
            role="option"
            aria-selected=${index === this.chosen_}
            @pointerdown=${(event: Event) => {
              event.preventDefault(); // the field keeps the keyboard
              this.take(index);
            }}
          >
            ${person_mark(person)}<span><b>${person.user}</b>${person.full_name ? html` <span class="hint">${person.full_name}</span>` : nothing}</span>
          </li>`,
      )}
    </ul>`;
  }

  private take(index: number): void {
    const field = this.field_;
    const person = this.people_[index];
    if (!field || !person) return;
    const caret = field.selectionStart;
    const space = /^\s/.test(field.value.slice(caret)) ? "" : " ";
    field.setRangeText(`@${person.user}${space}`, this.at_, caret, "end");
    this.close();
    field.dispatchEvent(new Event("input"));
  }
}
