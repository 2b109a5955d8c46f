// <strata-project-roles-dialog>: a user's role in each project, next to the role for all projects
// and the roles from groups. For a group, it shows the group's role in each project.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { formatList } from "../../core/locale";
import { called, roleByGroups } from "../../domain/people";
import type { Group, MemberList, Person, Project, ProjectRole } from "../../core/protocol.gen";
import { kProjectRoles, kRoles } from "../../core/types";
import "../../ui/dialog";
import { rowList, rowListStyles, type ListedRow } from "../../ui/row-list";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.project_roles;

interface Row {
  id: number; // the project's id
  project: Project;
  role: ProjectRole | null; // the user's own role
  by_groups: ReturnType<typeof roleByGroups>;
  note: { kind: "error" | "done"; text: string } | null;
}

@customElement("strata-project-roles-dialog")
export class StrataProjectRolesDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** Either `person` or `group` is set. */
  @property({ attribute: false }) person: Person | null = null;
  @property({ attribute: false }) group: Group | null = null;
  @state() private _rows: readonly Row[] | null = null;
  @state() private _problem = "";

  static override styles = [sharedStyles, rowListStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.read();
  }

  private async read(): Promise<void> {
    this._problem = "";
    try {
      const projects = await this.api.all("GET /projects", "projects");
      const members = await Promise.all(
        projects.map(({ slug }) =>
          this.api.json("GET /projects/{project}/members", {
            path: { project: slug },
            query: { limit: 1000 },
          }),
        ),
      );
      this._rows = projects.map((project, i) => ({
        id: project.id,
        project,
        ...this.rolesIn(members[i]!),
        note: null,
      }));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  private rolesIn({ members, groups }: MemberList): Pick<Row, "role" | "by_groups"> {
    const { person, group } = this;
    if (group)
      return { role: groups.find(({ id }) => id === group.id)?.role ?? null, by_groups: null };
    return {
      role: members.find(({ user }) => user === person?.user)?.role ?? null,
      by_groups: roleByGroups(groups, person?.groups ?? []),
    };
  }

  override render(): TemplateResult {
    const { person, group } = this;
    const name = person ? called(person) : (group?.name ?? "");
    return html`<strata-dialog heading=${words.title(name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${person ? words.lead(texts.roles[person.role]) : words.group_lead}</p>
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>
            <button @click=${() => void this.read()}>${texts.try_again}</button>`
          : this._rows
            ? rowList(this._rows, (row) => this.row(row))
            : html`<p class="hint" role="status">${texts.loading}</p>`
      }
    </strata-dialog>`;
  }

  private row(row: Row): ListedRow {
    const { project, role, note } = row;
    return {
      name: project.name,
      about: this.origin(row),
      tools: html`<select aria-label=${words.role_in(project.name)} @change=${(event: Event) => void this.change(row, event.target as HTMLSelectElement)}>
        <option value="" ?selected=${role === null}>${this.group ? words.group_none : words.none}</option>
        ${kProjectRoles.map((each) => html`<option value=${each} ?selected=${each === role}>${texts.roles[each]}</option>`)}
      </select>`,
      note,
    };
  }

  /** Shows the role that groups give, and whether it is the effective one. */
  private origin({ role, by_groups: byGroups }: Row): TemplateResult | typeof nothing {
    if (!byGroups || !this.person) return nothing;
    const rank = (each: ProjectRole | Person["role"]): number => kRoles.indexOf(each);
    const counts = rank(byGroups.role) > Math.max(rank(this.person.role), role ? rank(role) : -1);
    const told = counts ? words.by_groups : words.by_groups_also;
    return html`<span class="hint">${told(texts.roles[byGroups.role], formatList(byGroups.groups))}</span>`;
  }

  private async change(row: Row, select: HTMLSelectElement): Promise<void> {
    const { project, role: before } = row;
    const role = kProjectRoles.find((each) => each === select.value) ?? null;
    const say = (now: ProjectRole | null, kind: "error" | "done", text: string): void => {
      this._rows = (this._rows ?? []).map((row) =>
        row.id === project.id ? { ...row, role: now, note: { kind, text } } : row,
      );
    };
    try {
      await this.put(project.slug, role);
      say(
        role,
        "done",
        role
          ? texts.site_people.role_changed(texts.roles[role])
          : this.group
            ? words.group_removed
            : words.removed,
      );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      select.value = before ?? "";
      say(before, "error", error.message);
    }
  }

  private async put(project: string, role: ProjectRole | null): Promise<void> {
    const { api, person, group } = this;
    if (group && role)
      await api.json("PUT /projects/{project}/groups/{group}", {
        path: { project, group: group.id },
        body: { role },
      });
    else if (group)
      await api.send("DELETE /projects/{project}/groups/{group}", {
        path: { project, group: group.id },
      });
    else if (person && role)
      await api.json("PUT /projects/{project}/members/{user}", {
        path: { project, user: person.user },
        body: { role },
      });
    else if (person)
      await api.send("DELETE /projects/{project}/members/{user}", {
        path: { project, user: person.user },
      });
  }
}
