// <strata-home-page>: the projects, or the models of one of them, and the imports under way. Where
// there is one project only, its models.

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError, type Api } from "../../net/api";
import { format_area, format_size, metres_per } from "../../domain/measure";
import type { Project } from "../../core/protocol.gen";
import { may_administer, type Me, type Model } from "../../core/types";
import { ask_account } from "../../ui/account-menu";
import { ask_to_bin, tell_binned } from "../../ui/trash";
import { open_bin } from "../../ui/trash-dialog";
import "../../ui/status-page";
import { ask_to_delete_project } from "./delete-project-dialog";
import { icon, logo } from "../../ui/icons";
import type { ImportEntry, Imports } from "./imports";
import { has_keyboard } from "../../ui/keyboard";
import "../../ui/menu";
import { notices } from "../../ui/notices";
import "./project-card";
import { ask_project } from "./project-dialog";
import {
  curates,
  kDefaultProject,
  list_projects,
  sees_to_kiosks,
  type ListedProject,
} from "./project-list";
import { follow, path_of_model, path_of_project } from "../../ui/routes";
import { styled } from "../../ui/styled";
import { shared_styles } from "../../ui/styles";
import { card_styles, home_styles } from "./home-styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";

/** The server's name of a step of the import, where it is one that people know. */
const plain_step = (message: string): string =>
  /\b(atlas|texels?|uvs?|charts?)\b/i.test(message) ? texts.import.unfolding : message;

@customElement("strata-home-page")
export class StrataHomePage extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @property({ attribute: false }) imports!: Imports;
  /** All that this person sees. */
  @property({ attribute: false }) projects: readonly Project[] = [];
  /** The slug of the one whose models are looked at; null: all that there is. */
  @property({ attribute: false }) project: string | null = null;
  /** Where this person may import scans, and delete models. */
  @property({ attribute: false }) curated: readonly Project[] = [];
  /** The one of them that scans are imported into. */
  @property({ attribute: false }) into: Project | null = null;
  /** Counts imports that ended: the list is read again. */
  @property({ attribute: false }) imported = 0;
  @state() private models_: Model[] | null = null;
  @state() private problem_ = "";
  @query("h1") private heading_!: HTMLElement | null;
  @query("input[type=file]") private file_input_!: HTMLInputElement;
  private unsubscribe_: (() => void) | null = null;

  static override styles = [shared_styles, card_styles, home_styles];

  override connectedCallback(): void {
    super.connectedCallback();
    this.unsubscribe_ = this.imports.subscribe(() => this.requestUpdate());
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unsubscribe_?.();
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("imported")) void this.load();
    const { shown } = this;
    document.title = shown ? `${shown.name} – ${texts.product}` : texts.product;
  }

  /** Whoever came by the keyboard goes on at the head of what they came to. */
  override updated(changed: PropertyValues<this>): void {
    if (changed.has("project") && changed.get("project") !== undefined && has_keyboard() === null)
      this.heading_?.focus({ preventScroll: true });
  }

  /** The project whose page this is; null: there is none of that name. */
  private get shown(): Project | null {
    return this.projects.find(({ slug }) => slug === this.project) ?? null;
  }
  /** The one that is looked at, also where it is the only one. */
  private get about(): ListedProject | null {
    const { shown, listed } = this;
    if (!this.models_) return null;
    if (shown) return { project: shown, models: this.models };
    return this.project === null && listed.length === 1 ? listed[0]! : null;
  }
  /** There is something else than the one that is shown. */
  private get leads_up(): boolean {
    const { shown } = this;
    return (
      shown !== null &&
      (this.has_several || (this.models_ !== null && this.listed[0]?.project !== shown))
    );
  }
  /** There are several to choose among. Before it is known what is in them: surely. */
  private get has_several(): boolean {
    return this.models_
      ? this.listed.length > 1
      : this.projects.filter(({ slug }) => slug !== kDefaultProject).length > 1;
  }
  private get is_gallery(): boolean {
    return (
      this.project === null &&
      this.has_several &&
      (this.models_?.length !== 0 || this.can_administer)
    );
  }
  private get is_missing(): boolean {
    return this.project !== null && !this.projects.some(({ slug }) => slug === this.project);
  }
  private get listed(): ListedProject[] {
    return list_projects(this.projects, this.models_ ?? []);
  }
  private get models(): Model[] {
    const { shown } = this;
    return (this.models_ ?? []).filter(({ project }) => !shown || project === shown.slug);
  }

  /** It is known that there is none here: what to do about it stands in the middle. */
  private get has_none(): boolean {
    return this.models_ !== null && this.models.length === 0;
  }

  private get can_curate(): boolean {
    return this.into !== null;
  }

  /** Who may make projects may change and delete all of them. */
  private get can_administer(): boolean {
    return may_administer(this.me.role);
  }

  private async load(): Promise<void> {
    try {
      this.models_ = await this.api.models();
      this.problem_ = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else this.problem_ = error.message;
    }
  }

  override render(): TemplateResult {
    return html`<header>
        <a class="brand" href="/" @click=${follow}>${logo()}<b>${texts.product}</b></a>
        <span class="grow tagline">${texts.tagline}</span>
        <strata-account-menu .me=${this.me} .kiosks=${sees_to_kiosks(this.me, this.projects)}></strata-account-menu>
      </header>
      <main>
        ${
          this.me.has_password
            ? nothing
            : html`<p class="no-password">
              <button class="link" @click=${() => ask_account(this, "account")}>${texts.account.no_password}</button>
              ${texts.account.no_password_why}
            </p>`
        }
        ${
          this.leads_up
            ? html`<a class="up" href="/" @click=${follow}>${icon("back")}${texts.home.all_projects}</a>`
            : nothing
        }
        ${this.is_missing ? nothing : this.title_row()}
        ${this.shown?.description ? html`<p class="description">${this.shown.description}</p>` : nothing}
        ${
          this.imports.entries.length > 0
            ? html`<section class="imports" aria-live="polite">
              ${repeat(
                this.imports.entries,
                (entry) => entry.key,
                (entry) => this.import_row(entry),
              )}
            </section>`
            : nothing
        }
        ${this.content()}
      </main>`;
  }

  private title_row(): TemplateResult {
    return html`<div class="title">
      <h1 tabindex="-1">${this.heading}</h1>
      ${this.about ? this.project_menu(this.about) : nothing}
      <span class="hint grow">${this.counted}</span>
      ${this.project === null && this.curated.length > 1 ? this.project_choice(this.curated) : nothing}
      ${
        this.can_curate
          ? html`<button class=${this.has_none ? "" : "primary"} @click=${() => this.file_input_.click()}>${icon("upload")}${texts.home.import}</button>
            <input type="file" accept=".ply,.obj,.stl,.gltf,.glb,.zip,.mtl,.bin,.png,.jpg,.jpeg,.tif,.tiff,.webp,.bmp,.tga" multiple hidden aria-label=${texts.home.import} @change=${this.on_files} />`
          : nothing
      }
      ${
        this.project === null && this.can_administer
          ? html`<button @click=${() => void this.make_project()}>${icon("plus")}${texts.projects.new}</button>`
          : nothing
      }
    </div>`;
  }

  private get heading(): string {
    const words = texts.home;
    return this.shown?.name ?? (this.is_gallery ? words.projects : words.title);
  }
  private get counted(): string {
    const words = texts.home;
    if (!this.models_ || this.models.length === 0) return ""; // that is said below
    return this.is_gallery
      ? words.count_projects(this.listed.length)
      : words.count(this.models.length);
  }

  private project_choice(projects: readonly Project[]): TemplateResult {
    return html`<label class="into">
      <span class="hint">${texts.home.into}</span>
      <select @change=${(event: Event) => this.dispatchEvent(new CustomEvent<string>("choose-project", { detail: (event.target as HTMLSelectElement).value }))}>
        ${projects.map(({ slug, name }) => html`<option value=${slug} ?selected=${slug === this.into?.slug}>${name}</option>`)}
      </select>
    </label>`;
  }

  private content(): TemplateResult {
    if (this.is_missing) return this.missing();
    if (this.problem_) {
      return html`<div class="empty">
        <h2>${this.problem_}</h2>
        <button @click=${() => void this.load()}>${texts.try_again}</button>
      </div>`;
    }
    if (!this.models_) return html`<p class="hint" role="status">${texts.loading}</p>`;
    if (this.is_gallery) {
      return html`<ul class="gallery projects">
          ${repeat(
            this.listed,
            ({ project }) => project.id,
            (listed) =>
              html`<li>
                <a href=${path_of_project(listed.project.slug)} @click=${follow}>
                  <strata-project-card .api=${this.api} .listed=${listed}></strata-project-card>
                </a>
                ${this.project_menu(listed, "options")}
              </li>`,
          )}
        </ul>
        ${this.has_none ? this.nothing_yet() : nothing}`;
    }
    if (this.has_none) return this.nothing_yet();
    return html`<ul class="gallery">
      ${repeat(
        this.models,
        (model) => model.id,
        (model) => this.card(model),
      )}
    </ul>`;
  }

  /** As where a model is not here. */
  private missing(): TemplateResult {
    const words = texts.home;
    return html`<div class="empty">
      ${logo()}
      <h1 tabindex="-1">${words.missing_title}</h1>
      <p>${words.missing_lead}</p>
      <a class="button" href="/" @click=${follow}>${icon("back")}${words.all_projects}</a>
    </div>`;
  }

  private nothing_yet(): TemplateResult {
    const in_none = this.projects.length === 0;
    const words = texts.home;
    return html`<div class="empty">
      ${logo()}
      <h2>${in_none ? words.no_projects : words.empty_title}</h2>
      <p>${this.can_curate ? words.empty_lead : in_none ? words.empty_guest : words.empty_viewer}</p>
      ${
        this.can_curate
          ? html`<button class="primary" @click=${() => this.file_input_.click()}>${texts.home.choose_file}</button>`
          : nothing
      }
    </div>`;
  }

  private project_menu(listed: ListedProject, place = ""): TemplateResult | typeof nothing {
    const { project } = listed;
    if (!curates(project)) return nothing; // who administers curates everywhere
    return html`<strata-menu class=${place} label=${texts.home.options(project.name)} .quiet=${place === ""}>
      ${
        this.can_administer
          ? html`<button class="quiet" role="menuitem" @click=${() => void this.describe_project(project)}>${icon("edit")}${texts.projects.describe}</button>`
          : nothing
      }
      <button class="quiet" role="menuitem" @click=${() => void this.look_into_bin(project)}>${icon("trash")}${texts.bin.open}</button>
      ${
        project.slug === kDefaultProject || !this.can_administer
          ? nothing
          : html`<hr />
            <button class="quiet" role="menuitem" @click=${() => void this.delete_project(listed)}>${icon("trash")}${texts.layers.delete}</button>`
      }
    </strata-menu>`;
  }

  private card(model: Model): TemplateResult {
    const metres = metres_per(model.unit);
    const sides = [0, 1, 2].map(
      (axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres,
    );
    return html`<li>
      <a href=${path_of_model(model.id)} aria-label=${texts.home.open(model.name)} @click=${follow}>
        <strata-thumbnail .api=${this.api} .model=${model}></strata-thumbnail>
        <div class="about">
          <b class="ellipsis">${model.name || texts.unnamed}</b>
          <span class="numeric">${format_size(sides)}</span>
          <span class="numeric faint">${format_area(model.area_m2)} · ${texts.home.triangles(model.triangles)}</span>
          ${model.scale_verified ? nothing : html`<span class="chip">${texts.home.scale_open}</span>`}
        </div>
      </a>
      ${
        this.curated.some(({ slug }) => slug === model.project)
          ? html`<strata-menu class="options" label=${texts.home.options(model.name)} .quiet=${false}>
            <button class="quiet" role="menuitem" @click=${() => void this.delete_model(model)}>
              ${icon("trash")}${texts.layers.delete}
            </button>
          </strata-menu>`
          : nothing
      }
    </li>`;
  }

  private import_row(entry: ImportEntry): TemplateResult {
    const words = texts.import;
    const busy =
      entry.state === "uploading" || entry.state === "queued" || entry.state === "running";
    const said =
      entry.state === "uploading"
        ? words.uploading(`${Math.round(entry.progress * 100)} %`)
        : entry.state === "failed"
          ? [entry.problem?.title ?? words.failed, entry.problem?.detail].filter(Boolean).join(". ")
          : plain_step(entry.message) || (entry.state === "queued" ? words.queued : words.running);
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
              entry.may_repeat
                ? html`<button
                  aria-label=${words.repeat_named(entry.name)}
                  @click=${() => this.dispatchEvent(new CustomEvent<ImportEntry>("repeat-import", { detail: entry }))}
                >
                  ${words.repeat}
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

  private on_files(): void {
    const files = [...(this.file_input_.files ?? [])];
    this.file_input_.value = "";
    this.dispatchEvent(new CustomEvent<File[]>("import-files", { detail: files }));
  }

  /** `next`: where to go once the page knows of it. */
  private projects_changed(next: string | null = null): void {
    this.dispatchEvent(new CustomEvent("projects-changed", { detail: next }));
  }

  private async make_project(): Promise<void> {
    const made = await ask_project(this.api, null);
    if (!made) return;
    notices.show("success", texts.projects.made(made.name), texts.projects.made_next);
    this.projects_changed(path_of_project(made.slug));
  }

  private async describe_project(project: Project): Promise<void> {
    if (await ask_project(this.api, project)) this.projects_changed();
  }

  private async delete_project(listed: ListedProject): Promise<void> {
    // something may have been restored
    if (!(await ask_to_delete_project(this.api, listed))) return this.load();
    notices.show("success", texts.home.deleted(listed.project.name));
    this.projects_changed("/");
  }

  private async look_into_bin(project: Project): Promise<void> {
    if (await open_bin(this.api, project)) await this.load();
  }

  private async delete_model(model: Model): Promise<void> {
    const words = texts.home;
    const gone = {
      kind: "model",
      entry: `model-${model.id}`,
      name: model.name,
      project: model.project,
    } as const;
    if (!(await ask_to_bin(this.api, gone, { title: words.delete_title, lead: words.delete_lead })))
      return;
    try {
      await this.api.delete_model(model.id);
      tell_binned(this.api, gone, () => void this.load());
    } catch (error) {
      notices.error(error);
    }
    await this.load();
  }
}
