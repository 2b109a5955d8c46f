// <strata-group-members-dialog>: the members of a group, selected from all users of the site. Each
// choice is sent immediately.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { called, findPeople } from "../../domain/people";
import type { Group, Person } from "../../core/protocol.gen";
import "../../ui/dialog";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.groups;

@customElement("strata-group-members-dialog")
export class StrataGroupMembersDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) group!: Group;
  @property({ attribute: false }) people!: readonly Person[];
  @state() private _inside: ReadonlySet<string> | null = null; // user names of the members
  @state() private _filter = "";
  @state() private _note: { user: string; kind: "error" | "done"; text: string } | null = null;
  @state() private _problem = "";
  // requests are sent one at a time, in the order of the clicks
  private _last: Promise<void> = Promise.resolve();

  static override styles = [
    sharedStyles,
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
        gap: var(--space-half) var(--space-3);
        border-top: var(--edge) solid var(--line);
      }
      li label {
        flex: 1;
        display: flex;
        align-items: center;
        gap: var(--space-3);
        padding: var(--space-2) var(--space-half);
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
        font-size: var(--text-small);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.read();
  }

  private async read(): Promise<void> {
    this._problem = "";
    try {
      this._inside = new Set(
        (
          await this.api.json("GET /groups/{group}", { path: { group: this.group.id } })
        ).members.map(({ user }) => user),
      );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  override render(): TemplateResult {
    return html`<strata-dialog heading=${words.members_of(this.group.name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>
            <button @click=${() => void this.read()}>${texts.try_again}</button>`
          : this._inside
            ? this.content(this._inside)
            : html`<p class="hint" role="status">${texts.loading}</p>`
      }
    </strata-dialog>`;
  }

  private content(inside: ReadonlySet<string>): TemplateResult {
    const shown = findPeople(this.people, this._filter, () => "");
    return html`<p class="hint" role="status">${words.inside(inside.size)}</p>
      <input
        type="text"
        autocomplete="off"
        autocapitalize="off"
        spellcheck="false"
        aria-label=${texts.site_people.filter}
        placeholder=${words.find_hint}
        .value=${this._filter}
        @input=${(event: Event) => (this._filter = (event.target as HTMLInputElement).value)}
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

  private row(person: Person, isInside: boolean): TemplateResult {
    const note = this._note?.user === person.user ? this._note : null;
    return html`<li>
      <label>
        <input type="checkbox" .checked=${isInside} @change=${(event: Event) => this.choose(person, event.target as HTMLInputElement)} />
        <span class="grow"><b>${called(person)}</b> ${person.full_name.trim() ? html`<span class="hint">${person.user}</span>` : nothing}</span>
      </label>
      ${note ? html`<span class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</span>` : nothing}
    </li>`;
  }

  private choose(person: Person, box: HTMLInputElement): void {
    const isIn = box.checked;
    this._last = this._last.then(() => this.put({ user: person.user, isIn, box }));
  }

  private async put({
    user,
    isIn,
    box,
  }: {
    user: string;
    isIn: boolean;
    box: HTMLInputElement;
  }): Promise<void> {
    try {
      const { members } = await this.api.json("PATCH /groups/{group}", {
        path: { group: this.group.id },
        body: isIn ? { add: [user] } : { remove: [user] },
      });
      this._inside = new Set(members.map((member) => member.user));
      this._note = { user, kind: "done", text: isIn ? words.put_in : words.taken_out };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      box.checked = !isIn;
      this._note = { user, kind: "error", text: error.message };
    }
  }
}
