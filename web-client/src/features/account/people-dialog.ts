// <strata-people-dialog>: the accounts and their roles. It invites people by a link that is shown
// once. A second tab shows the groups.

import { peopleDialogStyles } from "./people-dialog-styles";
import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { called, findPeople, isUserName, mayChange, rolesToGive } from "../../domain/people";
import type { Group, Invitation, Person, PersonPatch } from "../../core/protocol.gen";
import type { Me, Role } from "../../core/types";
import "../../ui/made-link";
import { ask } from "../../ui/dialog";
import "./audit-log";
import "./group-list";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import "./project-roles-dialog";
import { radioGroup } from "../../ui/radio-group";
import { chipStyles, linkMakingStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { toldTime } from "../../domain/times";

const words = texts.site_people;
const kUsualRole: Role = "annotator";

type Field = "user" | "full_name" | "role";
type Part = "people" | "groups" | "audit";

@customElement("strata-people-dialog")
export class StrataPeopleDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @state() private _people: Person[] | null = null;
  @state() private _part: Part = "people";
  @state() private _groups: readonly Group[] = []; // the groups that a new user can join
  @state() private _filter = "";
  @state() private _inviting = false;
  @state() private _role: Role = kUsualRole; // the role of the new user
  @state() private _invitation: Invitation | null = null;
  @state() private _fieldProblems: Partial<Record<Field, string>> = {};
  @state() private _rowNote: { id: number; kind: "error" | "done"; text: string } | null = null;
  @state() private _problem = "";
  @state() private _busy = false;
  @state() private _inProjects: Person | null = null; // the user whose project roles are shown

  static override styles = [sharedStyles, chipStyles, linkMakingStyles, peopleDialogStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt(() => this.read());
  }

  private async read(): Promise<void> {
    this._people = await this.api.all("GET /users", "users");
  }

  override render(): TemplateResult {
    return html`<strata-dialog broad heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      ${radioGroup<Part>({
        label: words.parts,
        class: "segments parts",
        choices: [
          { value: "people", content: words.people },
          { value: "groups", content: texts.groups.title },
          { value: "audit", content: texts.audit.title },
        ],
        chosen: this._part,
        choose: (part) => (this._part = part),
      })}
      ${this._people ? this.shown(this._people) : html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`}
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>
            <button @click=${() => void this.attempt(() => this.read())}>${texts.try_again}</button>`
          : nothing
      }
      ${
        this._inProjects
          ? html`<strata-project-roles-dialog .api=${this.api} .person=${this._inProjects} @closed=${() => (this._inProjects = null)}></strata-project-roles-dialog>`
          : nothing
      }
    </strata-dialog>`;
  }

  private shown(people: readonly Person[]): TemplateResult {
    if (this._part === "audit")
      return html`<strata-audit-log
        .api=${this.api}
        @signed-out=${() => this.dispatchEvent(new CustomEvent("signed-out"))}
      ></strata-audit-log>`;
    return this._part === "groups" ? this.groupList(people) : this.content(people);
  }

  private groupList(people: readonly Person[]): TemplateResult {
    return html`<strata-group-list
      .api=${this.api}
      .people=${people}
      @regrouped=${() => void this.attempt(() => this.read())}
      @signed-out=${() => this.dispatchEvent(new CustomEvent("signed-out"))}
    ></strata-group-list>`;
  }

  private content(people: readonly Person[]): TemplateResult {
    const shown = findPeople(
      people,
      this._filter,
      ({ role, state, groups }) =>
        `${texts.roles[role]} ${words.states[state]} ${groups.join(" ")}`,
    );
    return html`<div class="bar">
        <input
          type="text"
          autocomplete="off"
          autocapitalize="off"
          spellcheck="false"
          aria-label=${words.filter}
          placeholder=${words.filter_hint}
          .value=${this._filter}
          @input=${(event: Event) => (this._filter = (event.target as HTMLInputElement).value)}
        />
        <span class="hint grow" role="status">${shown.length === people.length ? words.count(people.length) : words.count_of(shown.length, people.length)}</span>
        <button class=${this._inviting || this._invitation ? "" : "primary"} ?disabled=${this._inviting} @click=${this.beginToInvite}>${icon("plus")}${words.invite}</button>
      </div>
      ${this._inviting ? this.inviteForm() : nothing} ${this._invitation ? this.link(this._invitation) : nothing}
      ${
        shown.length === 0
          ? html`<p class="hint">${words.none_found}</p>`
          : html`<table>
            <thead>
              <tr>
                <th scope="col">${words.user}</th>
                <th scope="col">${words.role}</th>
                <th scope="col">${words.state}</th>
                <th scope="col">${words.last_seen}</th>
                <th></th>
              </tr>
            </thead>
            <tbody>
              ${repeat(
                shown,
                ({ id }) => id,
                (person) => this.row(person),
              )}
            </tbody>
          </table>`
      }`;
  }

  private row(person: Person): TemplateResult {
    const { id, user, full_name: fullName, role, state, groups } = person;
    const name = called(person);
    const changeable = mayChange(this.me, person);
    const note = this._rowNote?.id === id ? this._rowNote : null;
    return html`<tr>
      <td class="name">
        <b>${name}</b> ${user === this.me.user ? html`<span class="chip you">${words.you}</span>` : nothing}
        ${fullName.trim() ? html`<span class="hint">${user}</span>` : nothing}
        ${
          groups.length > 0
            ? html`<span class="groups" aria-label=${texts.groups.of(name)} role="group">${groups.map((group) => html`<span class="chip group">${group}</span>`)}</span>`
            : nothing
        }
        ${note ? html`<span class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</span>` : nothing}
      </td>
      <td class="role">
        ${
          changeable
            ? html`<select aria-label=${words.role_of(name)} title=${texts.role_hints[role]} @change=${(event: Event) => void this.changeRole(person, event.target as HTMLSelectElement)}>
              ${rolesToGive(this.me.role).map((each) => html`<option value=${each} ?selected=${each === role}>${texts.roles[each]}</option>`)}
            </select>`
            : html`<span title=${texts.role_hints[role]}>${texts.roles[role]}</span>`
        }
      </td>
      <td class="state">
        ${
          role === "owner" && state === "invited" // owners have no invitation
            ? html`<span class="chip" title=${words.no_password_hint}>${words.no_password}</span>`
            : html`<span class="chip ${state}" title=${words.state_hints[state]}>${words.states[state]}</span>`
        }
      </td>
      <td class="seen" data-label=${words.last_seen}>${person.last_seen ? toldTime(person.last_seen) : words.never}</td>
      <td>${changeable ? this.options(person, name) : nothing}</td>
    </tr>`;
  }

  private options(person: Person, name: string): TemplateResult {
    const disabled = person.state === "disabled";
    return html`<strata-menu label=${words.options(name)}>
      <button class="quiet" role="menuitem" @click=${() => (this._inProjects = person)}>${icon("layers")}${words.projects}</button>
      ${
        disabled
          ? nothing
          : html`<button class="quiet" role="menuitem" @click=${() => void this.makeLink(person)}>${icon("link")}${words.new_link}</button>`
      }
      ${
        disabled
          ? html`<button class="quiet" role="menuitem" @click=${() => void this.enable(person)}>${icon("check")}${words.enable}</button>`
          : html`<button class="quiet" role="menuitem" @click=${() => void this.disable(person)}>${icon("leave")}${words.disable}</button>`
      }
      <hr />
      <button class="quiet" role="menuitem" @click=${() => void this.deletePerson(person)}>${icon("trash")}${words.delete}</button>
    </strata-menu>`;
  }

  private inviteForm(): TemplateResult {
    const problems = this._fieldProblems;
    const textField = (
      name: "user" | "full_name",
      label: string,
      placeholder: string,
      most: number,
    ): TemplateResult =>
      html`<div>
        <label class="field">
          <span>${label}</span>
          <input
            type="text"
            name=${name}
            maxlength=${most}
            autocomplete="off"
            autocapitalize=${name === "user" ? "off" : "words"}
            spellcheck="false"
            placeholder=${placeholder}
            aria-invalid=${problems[name] ? "true" : "false"}
            aria-describedby="${name}_problem"
          />
        </label>
        <small class="error" id="${name}_problem" role="alert" ?hidden=${!problems[name]}>${problems[name] ?? ""}</small>
      </div>`;
    return html`<form @submit=${this.onInvite} novalidate>
      <p class="hint">${words.invite_lead}</p>
      <div class="fields">
        ${textField("user", words.invite_user, words.invite_user_hint, 64)} ${textField("full_name", words.full_name, "", 200)}
        <div>
          <label class="field">
            <span>${words.role}</span>
            <select name="role" aria-describedby="role_hint role_problem" @change=${(event: Event) => (this._role = (event.target as HTMLSelectElement).value as Role)}>
              ${rolesToGive(this.me.role).map((role) => html`<option value=${role} ?selected=${role === this._role}>${texts.roles[role]}</option>`)}
            </select>
          </label>
          <small class="hint" id="role_hint">${texts.role_hints[this._role]}</small>
          <small class="error" id="role_problem" role="alert" ?hidden=${!problems.role}>${problems.role ?? ""}</small>
        </div>
      </div>
      ${
        this._groups.length > 0
          ? html`<fieldset>
            <legend class="caption">${texts.groups.title}</legend>
            ${this._groups.map(({ id, name }) => html`<label><input type="checkbox" name="group" value=${id} />${name}</label>`)}
          </fieldset>`
          : nothing
      }
      <div class="row">
        <button type="button" @click=${() => (this._inviting = false)}>${texts.cancel}</button>
        <button class="primary" ?disabled=${this._busy}>${words.invite_button}</button>
      </div>
    </form>`;
  }

  private link({ path, expires, user }: Invitation): TemplateResult {
    return html`<strata-made-link
      heading=${words.link(called(user))}
      lead=${words.link_lead(toldTime(expires))}
      text=${new URL(path, location.origin).href}
      done=${words.link_done}
      @done=${() => (this._invitation = null)}
    ></strata-made-link>`;
  }

  private beginToInvite(): void {
    this._inviting = true;
    this._role = kUsualRole;
    this._invitation = null;
    this._fieldProblems = {};
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector<HTMLInputElement>("input[name=user]")?.focus(),
    );
    void this.attempt(async () => {
      this._groups = await this.api.all("GET /groups", "groups");
    });
  }

  private refuse(field: Field, problem: string): void {
    this._fieldProblems = { [field]: problem };
    this.renderRoot.querySelector<HTMLElement>(`form [name=${field}]`)?.focus();
  }

  private onInvite(event: Event): void {
    event.preventDefault();
    const data = new FormData(event.target as HTMLFormElement);
    const text = (name: Field): string => String(data.get(name) ?? "").trim();
    this._fieldProblems = {};
    if (text("user") === "") return this.refuse("user", words.user_missing);
    if (!isUserName(text("user"))) return this.refuse("user", words.user_wrong);
    void this.attempt(async () => {
      const groups = data.getAll("group").map(Number);
      const asked = { user: text("user"), full_name: text("full_name"), role: this._role };
      this._invitation = await this.api.json("POST /users", {
        body: groups.length > 0 ? { ...asked, groups } : asked,
      });
      this._inviting = false;
      await this.read();
    });
  }

  private async makeLink(person: Person): Promise<void> {
    const name = called(person);
    if (
      !(await ask({
        heading: words.new_link_title(name),
        lead: words.new_link_lead,
        yes: words.new_link_button,
      }))
    )
      return;
    await this.changeRow(person, async () => {
      this._inviting = false;
      this._invitation = await this.api.json("POST /users/{user}/invite", {
        path: { user: person.user },
      });
      await this.updateComplete;
      this.renderRoot.querySelector(".made")?.scrollIntoView({ block: "nearest" });
    });
  }

  private async changeRole(person: Person, select: HTMLSelectElement): Promise<void> {
    const role = select.value as Role;
    const done = await this.change(person, { role }, words.role_changed(texts.roles[role]));
    if (!done) select.value = person.role;
  }

  private async disable(person: Person): Promise<void> {
    const name = called(person);
    if (
      !(await ask({
        heading: words.disable_title(name),
        lead: words.disable_lead,
        yes: words.disable_button,
        danger: true,
      }))
    )
      return;
    await this.change(person, { disabled: true }, words.disabled);
  }

  private async enable(person: Person): Promise<void> {
    await this.change(person, { disabled: false }, words.enabled);
  }

  private async deletePerson(person: Person): Promise<void> {
    const name = called(person);
    if (
      !(await ask({
        heading: words.delete_title(name),
        lead: words.delete_lead,
        yes: texts.delete,
        danger: true,
      }))
    )
      return;
    await this.changeRow(person, async () => {
      await this.api.send("DELETE /users/{user}", { path: { user: person.user } });
      if (this._invitation?.user.id === person.id) this._invitation = null;
      await this.read();
    });
  }

  private change(person: Person, change: PersonPatch, done: string): Promise<boolean> {
    return this.changeRow(person, async () => {
      const now = await this.api.json("PATCH /users/{user}", {
        path: { user: person.user },
        body: change,
      });
      this._people = (this._people ?? []).map((each) => (each.id === now.id ? now : each));
      this._rowNote = { id: now.id, kind: "done", text: done };
    });
  }

  /**
   * Returns true after success. If the server refuses the change, the user's row shows the reason.
   */
  private async changeRow({ id }: Person, task: () => Promise<void>): Promise<boolean> {
    this._rowNote = null;
    try {
      await task();
      return true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      this._rowNote = { id, kind: "error", text: error.message };
      return false;
    }
  }

  private async attempt(task: () => Promise<void>): Promise<void> {
    this._busy = true;
    this._problem = "";
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const { field } = error.problem;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else if (this._inviting && (field === "full_name" || field === "role"))
        this.refuse(field, error.message);
      else if (this._inviting && (field === "user" || error.status === 409))
        this.refuse("user", error.message);
      else this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}
