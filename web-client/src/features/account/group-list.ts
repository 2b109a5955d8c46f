// <strata-group-list>: the groups of the site, made, renamed and deleted, and from here who is in
// one and what it may do in projects. Says "regrouped" where people are in others than before.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError, type Api } from "../../net/api";
import type { Group, Person } from "../../core/protocol.gen";
import { ask, ask_text } from "../../ui/dialog";
import "./group-members-dialog";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import "./project-roles-dialog";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.groups;

@customElement("strata-group-list")
export class StrataGroupList extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) people!: readonly Person[];
  @state() private groups_: Group[] | null = null;
  @state() private name_problem_ = "";
  @state() private problem_ = "";
  @state() private row_problem_: { id: number; text: string } | null = null;
  @state() private members_of_: Group | null = null;
  @state() private roles_of_: Group | null = null;
  @query("input[name=name]") private name_!: HTMLInputElement;

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        gap: 14px;
      }
      form {
        display: grid;
        grid-template-columns: minmax(0, 340px) auto;
        align-items: end;
        justify-content: start;
        gap: 6px 10px;
      }
      form .error {
        grid-column: 1 / -1;
      }
      ul {
        display: grid;
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: 1fr auto;
        align-items: center;
        gap: 2px 12px;
        padding: 8px 0;
        border-top: var(--edge) solid var(--line);
      }
      li b {
        font-weight: 600;
        overflow-wrap: anywhere;
      }
      li .hint {
        display: block;
      }
      li > .error {
        grid-column: 1 / -1;
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
      this.groups_ = await this.api.groups();
    } catch (error) {
      this.problem_ = this.told(error);
    }
  }

  override render(): TemplateResult {
    return html`<p class="hint">${words.lead}</p>
      <form @submit=${this.on_make} novalidate>
        <label class="field">
          <span>${words.new_name}</span>
          <input
            type="text"
            name="name"
            maxlength="100"
            autocomplete="off"
            placeholder=${words.name_hint}
            aria-invalid=${this.name_problem_ ? "true" : "false"}
            aria-describedby="name_problem"
            @input=${() => (this.name_problem_ = "")}
          />
        </label>
        <button>${icon("plus")}${words.make}</button>
        <small class="error" id="name_problem" role="alert" ?hidden=${!this.name_problem_}>${this.name_problem_}</small>
      </form>
      ${
        this.problem_
          ? html`<p class="error" role="alert">${this.problem_}</p>
            <button @click=${() => void this.read()}>${texts.try_again}</button>`
          : this.groups_ === null
            ? html`<p class="hint" role="status">${texts.loading}</p>`
            : this.groups_.length === 0
              ? html`<p class="hint">${words.none}</p>`
              : html`<ul aria-label=${words.title}>
                ${repeat(
                  this.groups_,
                  ({ id }) => id,
                  (group) => this.row(group),
                )}
              </ul>`
      }
      ${
        this.members_of_
          ? html`<strata-group-members-dialog .api=${this.api} .group=${this.members_of_} .people=${this.people} @closed=${() => this.closed()}></strata-group-members-dialog>`
          : nothing
      }
      ${
        this.roles_of_
          ? html`<strata-project-roles-dialog .api=${this.api} .group=${this.roles_of_} @closed=${() => this.closed()}></strata-project-roles-dialog>`
          : nothing
      }`;
  }

  private row(group: Group): TemplateResult {
    const { id, name, people, projects } = group;
    const problem = this.row_problem_?.id === id ? this.row_problem_.text : "";
    return html`<li>
      <div><b>${name}</b><span class="hint numeric">${words.about(people, projects)}</span></div>
      <strata-menu label=${words.options(name)}>
        <button class="quiet" role="menuitem" @click=${() => (this.members_of_ = group)}>${icon("people")}${words.members}</button>
        <button class="quiet" role="menuitem" @click=${() => (this.roles_of_ = group)}>${icon("layers")}${texts.site_people.projects}</button>
        <button class="quiet" role="menuitem" @click=${() => void this.rename(group)}>${icon("edit")}${words.rename}</button>
        <hr />
        <button class="quiet" role="menuitem" @click=${() => void this.delete_group(group)}>${icon("trash")}${texts.site_people.delete}</button>
      </strata-menu>
      ${problem ? html`<span class="error" role="alert">${problem}</span>` : nothing}
    </li>`;
  }

  /** Of what a dialog changed. */
  private closed(): void {
    this.members_of_ = this.roles_of_ = null;
    this.regrouped();
  }

  private regrouped(): void {
    this.dispatchEvent(new CustomEvent("regrouped"));
    void this.read();
  }

  private readonly on_make = async (event: Event): Promise<void> => {
    event.preventDefault();
    const name = this.name_.value.trim();
    this.name_problem_ = name === "" ? words.name_empty : "";
    if (name === "") return this.name_.focus();
    try {
      const { id } = await this.api.create_group({ name });
      this.name_.value = "";
      await this.read();
      // nobody is in it yet
      this.members_of_ = this.groups_?.find((group) => group.id === id) ?? null;
    } catch (error) {
      this.name_problem_ = this.told(error);
      this.name_.focus();
    }
  };

  private async rename({ id, name }: Group): Promise<void> {
    const next = await ask_text({
      heading: words.rename_title(name),
      label: words.name,
      text: name,
      yes: texts.save,
    });
    if (next === null || next === name) return;
    await this.change(id, () => this.api.change_group(id, { name: next }));
  }

  private async delete_group({ id, name }: Group): Promise<void> {
    await this.change(id, async () => {
      const { losing, members } = await this.api.group(id);
      if (
        !(await ask({
          heading: words.delete_title(name),
          lead: words.delete_lead(losing, members.length),
          yes: texts.delete,
          danger: true,
        }))
      )
        return;
      await this.api.delete_group(id);
    });
  }

  private async change(id: number, task: () => Promise<unknown>): Promise<void> {
    this.row_problem_ = null;
    try {
      await task();
      this.regrouped();
    } catch (error) {
      this.row_problem_ = { id, text: this.told(error) };
    }
  }

  private told(error: unknown): string {
    if (!(error instanceof ApiError)) throw error;
    if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
    return error.message;
  }
}
