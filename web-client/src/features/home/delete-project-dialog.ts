// <strata-delete-project-dialog>: lists the content that is deleted with a project. A project with
// models cannot be deleted. For a project with tables the user must type its name first.
// askToDeleteProject() opens the dialog.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { labelOf } from "../../domain/cells";
import type { Table } from "../../core/protocol.gen";
import { openTrash } from "../../ui/trash-dialog";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import type { ListedProject } from "./project-list";
import { isNameOf, removeProject } from "./project-removal";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.projects;

@customElement("strata-delete-project-dialog")
class StrataDeleteProjectDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) listed!: ListedProject;
  answer: (isDeleted: boolean) => void = () => {};

  @state() private _tables: readonly Table[] | null = null;
  @state() private _hasTrashed = false; // whether the trash contains models
  @state() private _typed = "";
  @state() private _problem = "";
  @state() private _busy = false;
  @query("strata-dialog") private _dialog!: StrataDialog;
  private _answered = false;

  static override styles = [
    sharedStyles,
    css`
      ul {
        max-height: 30vh;
        margin: 0;
        padding-left: 1.2em;
        overflow: auto;
      }
      li {
        overflow-wrap: anywhere;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.listed.models.length === 0) void this.read();
  }

  private async read(): Promise<void> {
    this._problem = "";
    try {
      const { slug } = this.listed.project;
      const trash = await this.api.json("GET /projects/{project}/bin", {
        path: { project: slug },
        query: { limit: 1000, offset: 0 },
      });
      this._hasTrashed = trash.entries.some(({ kind }) => kind === "model");
      this._tables = await this.api.all("GET /projects/{project}/tables", "tables", {
        path: { project: slug },
      });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  override render(): TemplateResult {
    const { project, models } = this.listed;
    const { _hasTrashed: hasTrashed } = this;
    const isKept = models.length > 0 || hasTrashed;
    const heading = hasTrashed
      ? words.kept_by_bin_title
      : isKept
        ? words.kept_title
        : words.delete_title;
    return html`<strata-dialog heading=${heading(project.name)} way_out=${isKept ? texts.close : texts.cancel} @closed=${() => this.finish()}>
      ${
        hasTrashed
          ? html`<p>${words.kept_by_bin_lead}</p>
            <div><button @click=${() => void this.lookIntoTrash()}>${icon("trash")}${texts.bin.open}</button></div>`
          : isKept
            ? html`<p>${words.kept_lead(models.length)}</p>`
            : this.consequences()
      }
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${this._problem && !this._tables ? html`<div><button @click=${() => void this.read()}>${texts.try_again}</button></div>` : nothing}
      ${
        isKept
          ? nothing
          : html`<button slot="actions" class="danger" ?disabled=${this._busy || !this.isConfirmed} @click=${() => void this.deleteProject()}>${texts.delete}</button>`
      }
    </strata-dialog>`;
  }

  private consequences(): TemplateResult {
    const { _tables: tables } = this;
    if (!tables)
      return html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`;
    if (tables.length === 0) return html`<p>${words.delete_lead}</p>`;
    return html`<p>${words.delete_tables_lead(tables.length)}</p>
      <ul>
        ${tables.map((table) => html`<li>${labelOf(table)} <span class="hint">${texts.tables.records(table.records)}</span></li>`)}
      </ul>
      <p>${words.delete_lead}</p>
      <label class="field">
        <span>${words.type_name(this.listed.project.name)}</span>
        <input
          type="text"
          autocomplete="off"
          spellcheck="false"
          autofocus
          @input=${(event: Event) => (this._typed = (event.target as HTMLInputElement).value)}
          @keydown=${(event: KeyboardEvent) => event.key === "Enter" && void this.deleteProject()}
        />
      </label>`;
  }

  private async lookIntoTrash(): Promise<void> {
    if (!(await openTrash(this.api, this.listed.project))) return;
    await this.read();
  }

  private get isConfirmed(): boolean {
    if (!this._tables) return false;
    return this._tables.length === 0 || isNameOf(this._typed, this.listed.project);
  }

  private async deleteProject(): Promise<void> {
    if (!this._tables || !this.isConfirmed || this._busy) return;
    this._busy = true;
    this._problem = "";
    try {
      await removeProject(this.api, this.listed.project, this._tables);
      this._answered = true;
      this._dialog.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      await this.read(); // the user may have deleted some tables
      this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }

  private finish(): void {
    this.answer(this._answered);
    this.remove();
  }
}

/** Resolves to true if the project was deleted. */
export function askToDeleteProject(api: Api, listed: ListedProject): Promise<boolean> {
  return new Promise((resolve) => {
    const element = new StrataDeleteProjectDialog();
    Object.assign(element, { api, listed, answer: resolve });
    document.body.append(element);
  });
}
