// <strata-project-dialog>: makes a project, or with `project` names and describes one anew. Opened by ask_project().

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, new_id, type Api, type Versioned } from "../core/api";
import type { Project } from "../core/protocol.gen";
import "./dialog";
import type { StrataDialog } from "./dialog";
import { path_of_project } from "./routes";
import { form_styles, shared_styles } from "./styles";
import { texts } from "./texts";

const words = texts.projects;

@customElement("strata-project-dialog")
class StrataProjectDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) project: Project | null = null;
  answer: (project: Project | null) => void = () => {};

  @state() private problem_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("form") private form_!: HTMLFormElement;
  @query("input") private name_!: HTMLInputElement;
  @query("textarea") private description_!: HTMLTextAreaElement;
  private base_: Versioned<Project> | null = null; // the project as this person knows it
  private answered_: Project | null = null;
  private key_ = new_id();

  static override styles = [shared_styles, form_styles];

  override render(): TemplateResult {
    const { project } = this;
    return html`<strata-dialog heading=${project ? words.describe_title(project.name) : words.new_title} @closed=${() => this.finish()}>
      <p class="hint">${project ? words.describe_lead(path_of_project(project.slug)) : words.new_lead}</p>
      <form @submit=${this.on_submit} @input=${this.on_input}>
        <label class="field">
          <span>${words.name}</span>
          <input type="text" required maxlength="200" autocomplete="off" autofocus .defaultValue=${project?.name ?? ""} placeholder=${project ? nothing : words.name_hint} />
        </label>
        <label class="field">
          <span>${words.description}</span>
          <textarea maxlength="10000" rows="4" .defaultValue=${project?.description ?? ""} placeholder=${words.description_hint}></textarea>
        </label>
      </form>
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button slot="actions" @click=${() => this.dialog_.close()}>${texts.cancel}</button>
      <button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => this.form_.requestSubmit()}>
        ${project ? texts.save : words.create}
      </button>
    </strata-dialog>`;
  }

  private readonly on_input = (): void => {
    this.key_ = new_id();
    this.problem_ = "";
  };

  private readonly on_submit = (event: Event): void => {
    event.preventDefault();
    const called = { name: this.name_.value.trim(), description: this.description_.value.trim() };
    if (called.name === "") {
      this.problem_ = words.name_empty;
      this.name_.focus();
    } else if (!this.busy_) {
      void this.save(called);
    }
  };

  private async save(called: { name: string; description: string }): Promise<void> {
    const { api, project } = this;
    this.busy_ = true;
    this.problem_ = "";
    try {
      this.answered_ = project ? await this.change(project, called) : await api.create_project(called, this.key_);
      if (this.answered_) this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }

  /** Null, and a word about it: somebody else changed it since this person saw it. */
  private async change(project: Project, called: { name: string; description: string }): Promise<Project | null> {
    const { value, etag } = this.base_ ?? (await this.api.project(project.slug));
    const known = this.base_?.value ?? project;
    try {
      if (value.name === known.name && value.description === known.description) return await this.api.change_project(project.slug, called, etag);
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 412) throw error;
    }
    this.base_ = await this.api.project(project.slug);
    this.problem_ = words.changed(this.base_.value.name);
    return null;
  }

  private finish(): void {
    this.answer(this.answered_);
    this.remove();
  }
}

/** The project that was made or changed; null: none was. Without `project` a new one. */
export function ask_project(api: Api, project: Project | null): Promise<Project | null> {
  return new Promise((resolve) => {
    const element = new StrataProjectDialog();
    Object.assign(element, { api, project, answer: resolve });
    document.body.append(element);
  });
}
