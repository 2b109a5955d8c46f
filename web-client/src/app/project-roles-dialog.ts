// <strata-project-roles-dialog>: what one person may do in each project, beside what they may do everywhere.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError, type Api } from "../core/api";
import { called } from "../core/people";
import type { Person, Project, ProjectRole } from "../core/protocol.gen";
import { kProjectRoles } from "../core/types";
import "./dialog";
import { shared_styles } from "./styles";
import { texts } from "./texts";

const words = texts.project_roles;

interface Row {
  project: Project;
  role: ProjectRole | null;
  note: { kind: "error" | "done"; text: string } | null;
}

@customElement("strata-project-roles-dialog")
export class StrataProjectRolesDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) person!: Person;
  @state() private rows_: readonly Row[] | null = null;
  @state() private problem_ = "";

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
        display: grid;
        grid-template-columns: 1fr auto;
        align-items: center;
        gap: 4px 12px;
        padding: 8px 0;
        border-top: var(--edge) solid var(--line);
      }
      li b {
        font-weight: 600;
        overflow-wrap: anywhere;
      }
      li select {
        width: auto;
      }
      li .error,
      li .done {
        grid-column: 1 / 3;
        font-size: 0.86rem;
      }
      li .done {
        color: var(--calm);
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
      const projects = await this.api.projects();
      const members = await Promise.all(projects.map(({ slug }) => this.api.members(slug)));
      this.rows_ = projects.map((project, i) => ({ project, role: members[i]!.find(({ user }) => user === this.person.user)?.role ?? null, note: null }));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    }
  }

  override render(): TemplateResult {
    const { role } = this.person;
    return html`<strata-dialog heading=${words.title(called(this.person))} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${words.lead(texts.roles[role])}</p>
      ${this.problem_
        ? html`<p class="error" role="alert">${this.problem_}</p>
            <button @click=${() => void this.read()}>${texts.try_again}</button>`
        : this.rows_
          ? html`<ul>
              ${repeat(
                this.rows_,
                ({ project }) => project.id,
                (row) => this.row(row),
              )}
            </ul>`
          : html`<p class="hint" role="status">${texts.loading}</p>`}
    </strata-dialog>`;
  }

  private row(row: Row): TemplateResult {
    const { project, role, note } = row;
    return html`<li>
      <b>${project.name}</b>
      <select aria-label=${words.role_in(project.name)} @change=${(event: Event) => void this.change(row, event.target as HTMLSelectElement)}>
        <option value="" ?selected=${role === null}>${words.none}</option>
        ${kProjectRoles.map((each) => html`<option value=${each} ?selected=${each === role}>${texts.roles[each]}</option>`)}
      </select>
      ${note ? html`<span class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</span>` : nothing}
    </li>`;
  }

  private async change({ project, role: before }: Row, select: HTMLSelectElement): Promise<void> {
    const role = kProjectRoles.find((each) => each === select.value) ?? null;
    const say = (now: ProjectRole | null, kind: "error" | "done", text: string): void => {
      this.rows_ = (this.rows_ ?? []).map((row) => (row.project.id === project.id ? { project, role: now, note: { kind, text } } : row));
    };
    try {
      if (role) await this.api.put_member(project.slug, this.person.user, role);
      else await this.api.remove_member(project.slug, this.person.user);
      say(role, "done", role ? texts.site_people.role_changed(texts.roles[role]) : words.removed);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      select.value = before ?? "";
      say(before, "error", error.message);
    }
  }
}
