// <strata-home-page>: the projects, or the models of one project, and running imports. If only one
// project exists, the page shows its models.

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { formatArea, formatSize, metresPer } from "../../domain/measure";
import { cardsOf, toldSurveyDate } from "../../domain/surveys";
import type { Project, SurveyedObject } from "../../core/protocol.gen";
import { mayAdminister, type Me, type Model } from "../../core/types";
import { askAccount } from "../../ui/account-menu";
import { askToTrash, tellTrashed } from "../../ui/trash";
import { openTrash } from "../../ui/trash-dialog";
import "../../ui/status-page";
import { askToDeleteProject } from "./delete-project-dialog";
import { askToResetDemo, kDemoProject } from "./reset-demo-dialog";
import { icon, logo } from "../../ui/icons";
import { hasSeveralScans, type ImportEntry, type Imports } from "./imports";
import { hasKeyboard } from "../../ui/keyboard";
import "../../ui/menu";
import { notices } from "../../ui/notices";
import "./project-card";
import { deleteObject, renameObject } from "./object-actions";
import { askProject } from "./project-dialog";
import {
  curates,
  kDefaultProject,
  listProjects,
  seesToKiosks,
  type ListedProject,
} from "./project-list";
import { follow, pathOfModel, pathOfProject } from "../../ui/routes";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { cardStyles, homeStyles } from "./home-styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";

/** Returns the text for a step of the import. The default is the server's message. */
const plainStep = (message: string): string =>
  /\b(atlas|texels?|uvs?|charts?)\b/i.test(message) ? texts.import.unfolding : message;

@customElement("strata-home-page")
export class StrataHomePage extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @property({ attribute: false }) imports!: Imports;
  /** All projects that this user can see. */
  @property({ attribute: false }) projects: readonly Project[] = [];
  /** The slug of the open project; null shows all projects. */
  @property({ attribute: false }) project: string | null = null;
  /** The projects in which this user may import scans and delete models. */
  @property({ attribute: false }) curated: readonly Project[] = [];
  /** The project that receives imports; one of `curated`. */
  @property({ attribute: false }) into: Project | null = null;
  /** The number of finished imports. A change reloads the list. */
  @property({ attribute: false }) imported = 0;
  @state() private _models: Model[] | null = null;
  /** The objects of the listed models. */
  @state() private _objects: readonly SurveyedObject[] = [];
  @state() private _problem = "";
  @query("h1") private _heading!: HTMLElement | null;
  @query("input[type=file]") private _fileInput!: HTMLInputElement;
  private _unsubscribe: (() => void) | null = null;

  static override styles = [sharedStyles, cardStyles, homeStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    this._unsubscribe = this.imports.subscribe(() => this.requestUpdate());
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._unsubscribe?.();
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("imported")) void this.load();
    else if (changed.has("project") && this._models) void this.loadObjects(this._models);
    const { shown } = this;
    document.title = shown ? `${shown.name} – ${texts.product}` : texts.product;
  }

  /** Moves the keyboard focus to the heading of the new page. */
  override updated(changed: PropertyValues<this>): void {
    if (changed.has("project") && changed.get("project") !== undefined && hasKeyboard() === null)
      this._heading?.focus({ preventScroll: true });
  }

  /** The open project; null if no project, or an unknown one, is open. */
  private get shown(): Project | null {
    return this.projects.find(({ slug }) => slug === this.project) ?? null;
  }
  /** The project whose models are shown: the open project, or the only one. */
  private get about(): ListedProject | null {
    const { shown, listed } = this;
    if (!this._models) return null;
    if (shown) return { project: shown, models: this.models };
    return this.project === null && listed.length === 1 ? listed[0]! : null;
  }
  /** Whether the page links to other projects. */
  private get leadsUp(): boolean {
    const { shown } = this;
    return (
      shown !== null &&
      (this.hasSeveral || (this._models !== null && this.listed[0]?.project !== shown))
    );
  }
  /**
   * Whether the user can choose among several projects. Until the models are loaded, the result
   * depends only on the number of projects.
   */
  private get hasSeveral(): boolean {
    return this._models
      ? this.listed.length > 1
      : this.projects.filter(({ slug }) => slug !== kDefaultProject).length > 1;
  }
  private get isGallery(): boolean {
    return (
      this.project === null && this.hasSeveral && (this._models?.length !== 0 || this.canAdminister)
    );
  }
  private get isMissing(): boolean {
    return this.project !== null && !this.projects.some(({ slug }) => slug === this.project);
  }
  private get listed(): ListedProject[] {
    return listProjects(this.projects, this._models ?? []);
  }
  private get models(): Model[] {
    const { shown } = this;
    return (this._models ?? []).filter(({ project }) => !shown || project === shown.slug);
  }

  /** Whether the list is loaded and empty. If so, the page shows what the user can do next. */
  private get hasNone(): boolean {
    return this._models !== null && this.models.length === 0;
  }

  private get canCurate(): boolean {
    return this.into !== null;
  }

  /** Whether this user may create projects, and change and delete all of them. */
  private get canAdminister(): boolean {
    return mayAdminister(this.me.role);
  }

  private async load(): Promise<void> {
    try {
      const models = await this.api.all("GET /models", "models");
      await this.loadObjects(models); // before the cards of the models appear
      this._models = models;
      this._problem = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else this._problem = error.message;
    }
  }

  /** Reads the objects of the models on the page. The list of projects shows no models. */
  private async loadObjects(models: readonly Model[]): Promise<void> {
    const { project: shown } = this;
    if (shown === null && listProjects(this.projects, models).length > 1) return;
    const projects = new Set(
      models
        .filter(({ object, project }) => object !== undefined && (project === shown || !shown))
        .map(({ project }) => project),
    );
    try {
      const lists = await Promise.all(
        [...projects].map((project) =>
          this.api.all("GET /projects/{project}/objects", "objects", { path: { project } }),
        ),
      );
      // Another project may be open by now.
      if (shown === this.project) this._objects = lists.flat();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (shown === this.project) this._objects = []; // each model has its own card
    }
  }

  override render(): TemplateResult {
    return html`<header>
        <a class="brand" href="/" @click=${follow}>${logo()}<b>${texts.product}</b></a>
        <span class="grow tagline">${texts.tagline}</span>
        <strata-account-menu .me=${this.me} .kiosks=${seesToKiosks(this.me, this.projects)}></strata-account-menu>
      </header>
      <main>
        ${
          this.me.has_password || this.me.has_sign_on
            ? nothing
            : html`<p class="no-password">
              <button class="link" @click=${() => askAccount(this, "account")}>${texts.account.no_password}</button>
              ${texts.account.no_password_why}
            </p>`
        }
        ${
          this.leadsUp
            ? html`<a class="up" href="/" @click=${follow}>${icon("back")}${texts.home.all_projects}</a>`
            : nothing
        }
        ${this.isMissing ? nothing : this.titleRow()}
        ${this.shown?.description ? html`<p class="description">${this.shown.description}</p>` : nothing}
        ${
          this.imports.entries.length > 0
            ? html`<section class="imports" aria-live="polite">
              ${repeat(
                this.imports.entries,
                (entry) => entry.key,
                (entry) => this.importRow(entry),
              )}
            </section>`
            : nothing
        }
        ${this.content()}
      </main>`;
  }

  private titleRow(): TemplateResult {
    return html`<div class="title">
      <h1 tabindex="-1">${this.heading}</h1>
      ${this.about ? this.projectMenu(this.about) : nothing}
      <span class="hint grow">${this.counted}</span>
      ${this.project === null && this.curated.length > 1 ? this.projectChoice(this.curated) : nothing}
      ${
        this.canCurate
          ? html`<button class=${this.hasNone ? "" : "primary"} @click=${() => this._fileInput.click()}>${icon("upload")}${texts.home.import}</button>
            <input type="file" accept=".ply,.obj,.stl,.gltf,.glb,.zip,.mtl,.bin,.png,.jpg,.jpeg,.tif,.tiff,.webp,.bmp,.tga" multiple hidden aria-label=${texts.home.import} @change=${this.onFiles} />`
          : nothing
      }
      ${
        this.project === null && this.canAdminister
          ? html`<button @click=${() => void this.makeProject()}>${icon("plus")}${texts.projects.new}</button>`
          : nothing
      }
    </div>`;
  }

  private get heading(): string {
    const words = texts.home;
    return this.shown?.name ?? (this.isGallery ? words.projects : words.title);
  }
  private get counted(): string {
    const words = texts.home;
    if (!this._models || this.models.length === 0) return ""; // a text below reports the empty list
    return this.isGallery
      ? words.count_projects(this.listed.length)
      : words.count(this.models.length);
  }

  private projectChoice(projects: readonly Project[]): TemplateResult {
    return html`<label class="into">
      <span class="hint">${texts.home.into}</span>
      <select @change=${(event: Event) => this.dispatchEvent(new CustomEvent<string>("choose-project", { detail: (event.target as HTMLSelectElement).value }))}>
        ${projects.map(({ slug, name }) => html`<option value=${slug} ?selected=${slug === this.into?.slug}>${name}</option>`)}
      </select>
    </label>`;
  }

  private content(): TemplateResult {
    if (this.isMissing) return this.missing();
    if (this._problem) {
      return html`<div class="empty">
        <h2>${this._problem}</h2>
        <button @click=${() => void this.load()}>${texts.try_again}</button>
      </div>`;
    }
    if (!this._models) return html`<p class="hint" role="status">${texts.loading}</p>`;
    if (this.isGallery) {
      return html`<ul class="gallery projects">
          ${repeat(
            this.listed,
            ({ project }) => project.id,
            (listed) =>
              html`<li>
                <a href=${pathOfProject(listed.project.slug)} @click=${follow}>
                  <strata-project-card .api=${this.api} .listed=${listed}></strata-project-card>
                </a>
                ${this.projectMenu(listed, "options")}
              </li>`,
          )}
        </ul>
        ${this.hasNone ? this.nothingYet() : nothing}`;
    }
    if (this.hasNone) return this.nothingYet();
    return html`<ul class="gallery">
      ${repeat(
        cardsOf(this.models, this._objects),
        (card) => ("object" in card ? `object ${card.object.id}` : card.model.id),
        (card) =>
          "object" in card ? this.objectCard(card.object, card.models) : this.card(card.model),
      )}
    </ul>`;
  }

  /** Renders the page for an unknown project. */
  private missing(): TemplateResult {
    const words = texts.home;
    return html`<div class="empty">
      ${logo()}
      <h1 tabindex="-1">${words.missing_title}</h1>
      <p>${words.missing_lead}</p>
      <a class="button" href="/" @click=${follow}>${icon("back")}${words.all_projects}</a>
    </div>`;
  }

  private nothingYet(): TemplateResult {
    const inNone = this.projects.length === 0;
    const words = texts.home;
    return html`<div class="empty">
      ${logo()}
      <h2>${inNone ? words.no_projects : words.empty_title}</h2>
      <p>${this.canCurate ? words.empty_lead : inNone ? words.empty_guest : words.empty_viewer}</p>
      ${
        this.canCurate
          ? html`<button class="primary" @click=${() => this._fileInput.click()}>${texts.home.choose_file}</button>`
          : nothing
      }
    </div>`;
  }

  private projectMenu(listed: ListedProject, place = ""): TemplateResult | typeof nothing {
    const { project } = listed;
    if (!curates(project)) return nothing; // administrators are curators of all projects
    return html`<strata-menu class=${place} label=${texts.home.options(project.name)} .quiet=${place === ""}>
      ${
        this.canAdminister
          ? html`<button class="quiet" role="menuitem" @click=${() => void this.describeProject(project)}>${icon("edit")}${texts.projects.describe}</button>`
          : nothing
      }
      <button class="quiet" role="menuitem" @click=${() => this.dispatchEvent(new CustomEvent("bills", { detail: project.slug }))}>${icon("table")}${texts.billing.open}</button>
      <button class="quiet" role="menuitem" @click=${() => void this.lookIntoTrash(project)}>${icon("trash")}${texts.bin.open}</button>
      ${
        project.slug === kDemoProject && this.canAdminister
          ? html`<button class="quiet" role="menuitem" @click=${() => void this.resetDemo()}>${icon("undo")}${texts.demo.open}</button>`
          : nothing
      }
      ${
        project.slug === kDefaultProject || !this.canAdminister
          ? nothing
          : html`<hr />
            <button class="quiet" role="menuitem" @click=${() => void this.deleteProject(listed)}>${icon("trash")}${texts.layers.delete}</button>`
      }
    </strata-menu>`;
  }

  private card(model: Model): TemplateResult {
    const metres = metresPer(model.unit);
    const sides = [0, 1, 2].map(
      (axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres,
    );
    return html`<li>
      <a href=${pathOfModel(model.id)} aria-label=${texts.home.open(model.name)} @click=${follow}>
        <strata-thumbnail .api=${this.api} .model=${model}></strata-thumbnail>
        <div class="about">
          <b class="ellipsis">${model.name || texts.unnamed}</b>
          <span>${formatSize(sides)}</span>
          <span class="faint">${formatArea(model.area_m2)} · ${texts.home.triangles(model.triangles)}</span>
          ${model.scale_verified ? nothing : html`<span class="chip">${texts.home.scale_open}</span>`}
        </div>
      </a>
      ${
        this.curated.some(({ slug }) => slug === model.project)
          ? html`<strata-menu class="options" label=${texts.home.options(model.name)} .quiet=${false}>
            <button class="quiet" role="menuitem" @click=${() => void this.deleteModel(model)}>
              ${icon("trash")}${texts.layers.delete}
            </button>
          </strata-menu>`
          : nothing
      }
    </li>`;
  }

  /** Renders an object with its surveys, the oldest first. The card opens the newest one. */
  private objectCard(object: SurveyedObject, models: readonly Model[]): TemplateResult {
    const words = texts.home;
    const { name } = object;
    const newest = models[models.length - 1]!;
    const dateOf = (model: Model): string => toldSurveyDate(model.survey_date ?? "");
    return html`<li>
      <a href=${pathOfModel(newest.id)} aria-label=${words.open(name)} @click=${follow}>
        <strata-thumbnail .api=${this.api} .model=${newest}></strata-thumbnail>
        <div class="about">
          <b class="ellipsis">${name}</b>
          <span>${words.surveys(models.length)}</span>
        </div>
      </a>
      <div class="dates" role="group" aria-label=${words.surveys_of(name)}>
        ${models.map((model) => html`<a href=${pathOfModel(model.id)} title=${model.name} @click=${follow}>${dateOf(model)}</a>`)}
      </div>
      ${
        this.curated.some(({ slug }) => slug === newest.project)
          ? html`<strata-menu class="options" label=${words.options(name)} .quiet=${false}>
            <button class="quiet" role="menuitem" @click=${() => void this.changeObject(() => renameObject(this.api, newest.project, object))}>
              ${icon("edit")}${words.rename_object}
            </button>
            <button class="quiet" role="menuitem" @click=${() => void this.changeObject(() => deleteObject(this.api, newest.project, object))}>
              ${icon("trash")}${words.delete_object}
            </button>
            <hr />
            ${models.map(
              (model) =>
                html`<button class="quiet" role="menuitem" @click=${() => void this.deleteModel(model)}>
                  ${icon("trash")}${words.delete_survey(dateOf(model))}
                </button>`,
            )}
          </strata-menu>`
          : nothing
      }
    </li>`;
  }

  private importRow(entry: ImportEntry): TemplateResult {
    const words = texts.import;
    const busy =
      entry.state === "uploading" || entry.state === "queued" || entry.state === "running";
    const said =
      entry.state === "uploading"
        ? words.uploading(`${Math.round(entry.progress * 100)} %`)
        : entry.state === "failed"
          ? [entry.problem?.title ?? words.failed, entry.problem?.detail].filter(Boolean).join(". ")
          : plainStep(entry.message) || (entry.state === "queued" ? words.queued : words.running);
    return html`<div class="import ${entry.state}">
      <div class="grow">
        <b class="ellipsis">${entry.name}</b>
        <span class="said">${said}</span>
        ${
          busy
            ? html`<div
              class="bar ${entry.state === "queued" ? "waiting" : ""}"
              role="progressbar"
              aria-label=${entry.name}
              aria-valuemin="0"
              aria-valuemax="100"
              aria-valuenow=${Math.round(entry.progress * 100)}
            >
              <i ${styled({ width: `${(entry.progress * 100).toFixed(1)}%` })}></i>
            </div>`
            : nothing
        }
      </div>
      ${
        busy
          ? html`<button aria-label=${words.cancel(entry.name)} @click=${() => void this.cancel(entry)}>${texts.cancel}</button>`
          : html`${
              entry.mayRepeat || hasSeveralScans(entry)
                ? html`<button
                  aria-label=${entry.mayRepeat ? words.repeat_named(entry.name) : words.as_parts_named(entry.name)}
                  @click=${() => this.dispatchEvent(new CustomEvent<ImportEntry>("repeat-import", { detail: entry }))}
                >
                  ${entry.mayRepeat ? words.repeat : words.as_parts}
                </button>`
                : nothing
            }
          <button
            class="icon quiet"
            aria-label=${words.dismiss(entry.name)}
            @click=${() => this.imports.dismiss(entry.key)}
          >
            ${icon("close")}
          </button>`
      }
    </div>`;
  }

  private async cancel(entry: ImportEntry): Promise<void> {
    await this.imports.cancel(entry.key).catch((error: unknown) => notices.error(error));
  }

  private onFiles(): void {
    const files = [...(this._fileInput.files ?? [])];
    this._fileInput.value = "";
    this.dispatchEvent(new CustomEvent<File[]>("import-files", { detail: files }));
  }

  /** `next` is the path to open after the projects are reloaded. */
  private projectsChanged(next: string | null = null): void {
    this.dispatchEvent(new CustomEvent("projects-changed", { detail: next }));
  }

  private async makeProject(): Promise<void> {
    const made = await askProject(this.api, null);
    if (!made) return;
    notices.show("success", texts.projects.made(made.name), texts.projects.made_next);
    this.projectsChanged(pathOfProject(made.slug));
  }

  private async describeProject(project: Project): Promise<void> {
    if (await askProject(this.api, project)) this.projectsChanged();
  }

  private async deleteProject(listed: ListedProject): Promise<void> {
    // the user may have restored models in the dialog
    if (!(await askToDeleteProject(this.api, listed))) return this.load();
    notices.show("success", texts.home.deleted(listed.project.name));
    this.projectsChanged("/");
  }

  private async resetDemo(): Promise<void> {
    if (await askToResetDemo(this.api)) notices.show("success", texts.demo.done);
    await this.load();
  }

  private async lookIntoTrash(project: Project): Promise<void> {
    if (await openTrash(this.api, project)) await this.load();
  }

  private async changeObject(change: () => Promise<void>): Promise<void> {
    await change().catch((error: unknown) => notices.error(error));
    await this.load();
  }

  private async deleteModel(model: Model): Promise<void> {
    const words = texts.home;
    const gone = {
      kind: "model",
      entry: `model-${model.id}`,
      name: model.name,
      project: model.project,
    } as const;
    if (!(await askToTrash(this.api, gone, { title: words.delete_title, lead: words.delete_lead })))
      return;
    try {
      await this.api.deleteAsRead("DELETE /models/{model}", { path: { model: model.id } });
      tellTrashed(this.api, gone, () => void this.load());
    } catch (error) {
      notices.error(error);
    }
    await this.load();
  }
}
