// <strata-group-list>: creates, renames and deletes the groups of the site. It opens the dialogs
// for their members and project roles. It fires "regrouped" after the members change.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { Group, Person } from "../../core/protocol.gen";
import { ask, askText } from "../../ui/dialog";
import "./group-members-dialog";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import "./project-roles-dialog";
import { rowList, rowListStyles, type ListedRow } from "../../ui/row-list";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.groups;

@customElement("strata-group-list")
export class StrataGroupList extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) people!: readonly Person[];
  @state() private _groups: Group[] | null = null;
  @state() private _nameProblem = "";
  @state() private _problem = "";
  @state() private _rowProblem: { id: number; text: string } | null = null;
  @state() private _membersOf: Group | null = null;
  @state() private _rolesOf: Group | null = null;
  @query("input[name=name]") private _name!: HTMLInputElement;

  static override styles = [
    sharedStyles,
    rowListStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-3);
      }
      form {
        display: grid;
        grid-template-columns: minmax(0, 340px) auto;
        align-items: end;
        justify-content: start;
        gap: var(--space-2) var(--space-2);
      }
      form .error {
        grid-column: 1 / -1;
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
      this._groups = await this.api.all("GET /groups", "groups");
    } catch (error) {
      this._problem = this.told(error);
    }
  }

  override render(): TemplateResult {
    return html`<p class="hint">${words.lead}</p>
      <form @submit=${this.onMake} novalidate>
        <label class="field">
          <span>${words.new_name}</span>
          <input
            type="text"
            name="name"
            maxlength="100"
            autocomplete="off"
            placeholder=${words.name_hint}
            aria-invalid=${this._nameProblem ? "true" : "false"}
            aria-describedby="name_problem"
            @input=${() => (this._nameProblem = "")}
          />
        </label>
        <button>${icon("plus")}${words.make}</button>
        <small class="error" id="name_problem" role="alert" ?hidden=${!this._nameProblem}>${this._nameProblem}</small>
      </form>
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>
            <button @click=${() => void this.read()}>${texts.try_again}</button>`
          : this._groups === null
            ? html`<p class="hint" role="status">${texts.loading}</p>`
            : this._groups.length === 0
              ? html`<p class="hint">${words.none}</p>`
              : rowList(this._groups, (group) => this.row(group), { label: words.title })
      }
      ${
        this._membersOf
          ? html`<strata-group-members-dialog .api=${this.api} .group=${this._membersOf} .people=${this.people} @closed=${() => this.closed()}></strata-group-members-dialog>`
          : nothing
      }
      ${
        this._rolesOf
          ? html`<strata-project-roles-dialog .api=${this.api} .group=${this._rolesOf} @closed=${() => this.closed()}></strata-project-roles-dialog>`
          : nothing
      }`;
  }

  private row(group: Group): ListedRow {
    const { id, name, people, projects } = group;
    return {
      name,
      about: html`<span class="hint">${words.about(people, projects)}</span>`,
      tools: html`<strata-menu label=${words.options(name)}>
        <button class="quiet" role="menuitem" @click=${() => (this._membersOf = group)}>${icon("people")}${words.members}</button>
        <button class="quiet" role="menuitem" @click=${() => (this._rolesOf = group)}>${icon("layers")}${texts.site_people.projects}</button>
        <button class="quiet" role="menuitem" @click=${() => void this.rename(group)}>${icon("edit")}${words.rename}</button>
        <hr />
        <button class="quiet" role="menuitem" @click=${() => void this.deleteGroup(group)}>${icon("trash")}${texts.site_people.delete}</button>
      </strata-menu>`,
      note: this._rowProblem?.id === id ? { kind: "error", text: this._rowProblem.text } : null,
    };
  }

  /** Runs after a dialog has changed a group. */
  private closed(): void {
    this._membersOf = this._rolesOf = null;
    this.regrouped();
  }

  private regrouped(): void {
    this.dispatchEvent(new CustomEvent("regrouped"));
    void this.read();
  }

  private readonly onMake = async (event: Event): Promise<void> => {
    event.preventDefault();
    const name = this._name.value.trim();
    this._nameProblem = name === "" ? words.name_empty : "";
    if (name === "") return this._name.focus();
    try {
      const { id } = await this.api.json("POST /groups", { body: { name } });
      this._name.value = "";
      await this.read();
      // The new group has no members yet, so the dialog for its members opens.
      this._membersOf = this._groups?.find((group) => group.id === id) ?? null;
    } catch (error) {
      this._nameProblem = this.told(error);
      this._name.focus();
    }
  };

  private async rename({ id, name }: Group): Promise<void> {
    const next = await askText({
      heading: words.rename_title(name),
      label: words.name,
      text: name,
      yes: texts.save,
    });
    if (next === null || next === name) return;
    await this.change(id, () =>
      this.api.json("PATCH /groups/{group}", { path: { group: id }, body: { name: next } }),
    );
  }

  private async deleteGroup({ id, name }: Group): Promise<void> {
    await this.change(id, async () => {
      const { losing, members } = await this.api.json("GET /groups/{group}", {
        path: { group: id },
      });
      if (
        !(await ask({
          heading: words.delete_title(name),
          lead: words.delete_lead(losing, members.length),
          yes: texts.delete,
          danger: true,
        }))
      )
        return;
      await this.api.send("DELETE /groups/{group}", { path: { group: id } });
    });
  }

  private async change(id: number, task: () => Promise<unknown>): Promise<void> {
    this._rowProblem = null;
    try {
      await task();
      this.regrouped();
    } catch (error) {
      this._rowProblem = { id, text: this.told(error) };
    }
  }

  private told(error: unknown): string {
    if (!(error instanceof ApiError)) throw error;
    if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
    return error.message;
  }
}
