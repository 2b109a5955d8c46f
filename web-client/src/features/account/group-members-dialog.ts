// <strata-group-members-dialog>: who is in a group, of everybody on the site; each choice counts at
// once.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError, type Api } from "../../net/api";
import { called, find_people } from "../../domain/people";
import type { Group, Person } from "../../core/protocol.gen";
import "../../ui/dialog";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.groups;

@customElement("strata-group-members-dialog")
export class StrataGroupMembersDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) group!: Group;
  @property({ attribute: false }) people!: readonly Person[];
  @state() private inside_: ReadonlySet<string> | null = null; // names for signing in
  @state() private filter_ = "";
  @state() private note_: { user: string; kind: "error" | "done"; text: string } | null = null;
  @state() private problem_ = "";
  // one after the other, in the order of the clicks
  private last_: Promise<void> = Promise.resolve();

  static override styles = [
    shared_styles,
    css`
      ul {
        display: grid;
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: 2px 12px;
        border-top: var(--edge) solid var(--line);
      }
      li label {
        flex: 1;
        display: flex;
        align-items: center;
        gap: 12px;
        padding: 9px 2px;
        cursor: pointer;
      }
      li input {
        width: 18px;
        height: 18px;
        flex: none;
        margin: 0;
        accent-color: var(--accent);
      }
      li b {
        font-weight: 600;
        overflow-wrap: anywhere;
      }
      .done {
        color: var(--calm);
        font-size: 0.86rem;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.read();
  }

  private async read(): Promise<void> {
    this.problem_ = "";
    try {
      this.inside_ = new Set((await this.api.group(this.group.id)).members.map(({ user }) => user));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    }
  }

  override render(): TemplateResult {
    return html`<strata-dialog heading=${words.members_of(this.group.name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${
        this.problem_
          ? html`<p class="error" role="alert">${this.problem_}</p>
            <button @click=${() => void this.read()}>${texts.try_again}</button>`
          : this.inside_
            ? this.content(this.inside_)
            : html`<p class="hint" role="status">${texts.loading}</p>`
      }
    </strata-dialog>`;
  }

  private content(inside: ReadonlySet<string>): TemplateResult {
    const shown = find_people(this.people, this.filter_, () => "");
    return html`<p class="hint numeric" role="status">${words.inside(inside.size)}</p>
      <input
        type="text"
        autocomplete="off"
        autocapitalize="off"
        spellcheck="false"
        aria-label=${texts.site_people.filter}
        placeholder=${words.find_hint}
        .value=${this.filter_}
        @input=${(event: Event) => (this.filter_ = (event.target as HTMLInputElement).value)}
      />
      ${
        shown.length === 0
          ? html`<p class="hint">${texts.site_people.none_found}</p>`
          : html`<ul>
            ${repeat(
              shown,
              ({ id }) => id,
              (person) => this.row(person, inside.has(person.user)),
            )}
          </ul>`
      }`;
  }

  private row(person: Person, is_inside: boolean): TemplateResult {
    const note = this.note_?.user === person.user ? this.note_ : null;
    return html`<li>
      <label>
        <input type="checkbox" .checked=${is_inside} @change=${(event: Event) => this.choose(person, event.target as HTMLInputElement)} />
        <span class="grow"><b>${called(person)}</b> ${person.full_name.trim() ? html`<span class="hint">${person.user}</span>` : nothing}</span>
      </label>
      ${note ? html`<span class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</span>` : nothing}
    </li>`;
  }

  private choose(person: Person, box: HTMLInputElement): void {
    const is_in = box.checked;
    this.last_ = this.last_.then(() => this.put({ user: person.user, is_in, box }));
  }

  private async put({
    user,
    is_in,
    box,
  }: {
    user: string;
    is_in: boolean;
    box: HTMLInputElement;
  }): Promise<void> {
    try {
      const { members } = await this.api.change_group(
        this.group.id,
        is_in ? { add: [user] } : { remove: [user] },
      );
      this.inside_ = new Set(members.map((member) => member.user));
      this.note_ = { user, kind: "done", text: is_in ? words.put_in : words.taken_out };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      box.checked = !is_in;
      this.note_ = { user, kind: "error", text: error.message };
    }
  }
}
