// <strata-delete-project-dialog>: what deleting a project takes along. With models it stays; with
// tables its name is typed first. Opened by ask_to_delete_project().

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, type Api } from "../../net/api";
import { label_of } from "../../domain/cells";
import type { Table } from "../../core/protocol.gen";
import { open_bin } from "../../ui/trash-dialog";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import type { ListedProject } from "./project-list";
import { is_name_of, remove_project } from "./project-removal";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.projects;

@customElement("strata-delete-project-dialog")
class StrataDeleteProjectDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) listed!: ListedProject;
  answer: (is_deleted: boolean) => void = () => {};

  @state() private tables_: readonly Table[] | null = null;
  @state() private has_binned_ = false; // models that lie in its Bin
  @state() private typed_ = "";
  @state() private problem_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  private answered_ = false;

  static override styles = [
    shared_styles,
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
    this.problem_ = "";
    try {
      const { slug } = this.listed.project;
      const bin = await this.api.bin(slug, { limit: 1000, offset: 0 });
      this.has_binned_ = bin.entries.some(({ kind }) => kind === "model");
      this.tables_ = await this.api.tables(slug);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    }
  }

  override render(): TemplateResult {
    const { project, models } = this.listed;
    const { has_binned_: has_binned } = this;
    const is_kept = models.length > 0 || has_binned;
    const heading = has_binned
      ? words.kept_by_bin_title
      : is_kept
        ? words.kept_title
        : words.delete_title;
    return html`<strata-dialog heading=${heading(project.name)} way_out=${is_kept ? texts.close : texts.cancel} @closed=${() => this.finish()}>
      ${
        has_binned
          ? html`<p>${words.kept_by_bin_lead}</p>
            <div><button @click=${() => void this.look_into_bin()}>${icon("trash")}${texts.bin.open}</button></div>`
          : is_kept
            ? html`<p>${words.kept_lead(models.length)}</p>`
            : this.consequences()
      }
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      ${this.problem_ && !this.tables_ ? html`<div><button @click=${() => void this.read()}>${texts.try_again}</button></div>` : nothing}
      ${
        is_kept
          ? nothing
          : html`<button slot="actions" class="danger" ?disabled=${this.busy_ || !this.is_confirmed} @click=${() => void this.delete_project()}>${texts.delete}</button>`
      }
    </strata-dialog>`;
  }

  private consequences(): TemplateResult {
    const { tables_: tables } = this;
    if (!tables)
      return html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${texts.loading}</p>`;
    if (tables.length === 0) return html`<p>${words.delete_lead}</p>`;
    return html`<p>${words.delete_tables_lead(tables.length)}</p>
      <ul>
        ${tables.map((table) => html`<li>${label_of(table)} <span class="hint">${texts.tables.records(table.records)}</span></li>`)}
      </ul>
      <p>${words.delete_lead}</p>
      <label class="field">
        <span>${words.type_name(this.listed.project.name)}</span>
        <input
          type="text"
          autocomplete="off"
          spellcheck="false"
          autofocus
          @input=${(event: Event) => (this.typed_ = (event.target as HTMLInputElement).value)}
          @keydown=${(event: KeyboardEvent) => event.key === "Enter" && void this.delete_project()}
        />
      </label>`;
  }

  private async look_into_bin(): Promise<void> {
    if (!(await open_bin(this.api, this.listed.project))) return;
    await this.read();
  }

  private get is_confirmed(): boolean {
    if (!this.tables_) return false;
    return this.tables_.length === 0 || is_name_of(this.typed_, this.listed.project);
  }

  private async delete_project(): Promise<void> {
    if (!this.tables_ || !this.is_confirmed || this.busy_) return;
    this.busy_ = true;
    this.problem_ = "";
    try {
      await remove_project(this.api, this.listed.project, this.tables_);
      this.answered_ = true;
      this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      await this.read(); // some of the tables may be gone
      this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }

  private finish(): void {
    this.answer(this.answered_);
    this.remove();
  }
}

/** Whether it was deleted. */
export function ask_to_delete_project(api: Api, listed: ListedProject): Promise<boolean> {
  return new Promise((resolve) => {
    const element = new StrataDeleteProjectDialog();
    Object.assign(element, { api, listed, answer: resolve });
    document.body.append(element);
  });
}
