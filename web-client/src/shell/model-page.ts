// <strata-model-page>: one model: the stage in the middle, tools at its left, layers and brush at
// its right (on a phone: a sheet from below).

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { keyed } from "lit/directives/keyed.js";
import { ApiError, type Api } from "../net/api";
import { label_of } from "../domain/cells";
import type { Project, TourEntry } from "../core/protocol.gen";
import type { Column, Layer, Me, Model, Role } from "../core/types";
import { kPaintingTools, type ToolName } from "../tools/tool";
import "../ui/account-menu";
import "../ui/status-page";
import type { WhereRequest } from "../features/painting/brush-panel";
import "../features/painting/brush-panel";
import "../features/comments/comment-card";
import "../features/comments/comment-panel";
import "../features/comments/comment-pins";
import "../features/activity/activity-panel";
import "../features/review/review-panel";
import { ask, modal_is_open } from "../ui/dialog";
import { icon, logo } from "../ui/icons";
import { handle_key } from "./keyboard";
import { is_for_field } from "../ui/keyboard";
import { growing, growth } from "../ui/growth";
import "../features/records/hover-card";
import type { LayerPanelRequest } from "../features/layers/layer-panel";
import "../features/layers/layer-panel";
import "../features/painting/paint-chip";
import { model_styles } from "./model-styles";
import "../features/measuring/measure-panel";
import { OpenModelSession } from "./open-model-session";
import { notices } from "../ui/notices";
import { has_part, load_part_later } from "./page-parts";
import "../features/records/record-card";
import "../features/presence/people-menu";
import { is_one_of_several, sees_to_kiosks } from "../features/home/project-list";
import {
  comment_of,
  follow,
  hash_of_comment,
  hash_of_view,
  path_of_project,
  put_hash,
  view_of,
} from "../ui/routes";
import "./stage";
import type { StrataStage } from "./stage";
import { styled } from "../ui/styled";
import { shared_styles } from "../ui/styles";
import type { TablePanelRequest } from "../session/requests";
import "../features/tables/table-panel";
import "../features/tours/tour-list";
import "../features/views/view-list";
import type { TableView } from "../features/tables/table-view";
import { texts } from "../texts";
import "../features/presence/together-bar";
import "./tool-rail";
import "../features/onboarding/onboarding";
import type { StrataTour } from "../features/onboarding/onboarding";
import type { TourRequest } from "../session/requests";
import "../features/painting/value-readout";
import { wants_less_motion } from "../session/view-control";
import type { ViewRequest } from "../session/requests";
import "../features/appearance/view-panel";

type OpenDialog =
  | LayerPanelRequest
  | TablePanelRequest
  | ViewRequest
  | WhereRequest
  | Extract<TourRequest, { dialog: "kiosks" }>
  | { dialog: "scale" | "help" | "about" | "orthophoto" }
  | null;

const kNarrow = 820; // pixels of a window where the panel lies over the model
// pixels where words have their usual size; it grows with them
const kPanelWidth = { least: 270, first: 330, most: 620 };
const kPanelKey = "strata.panel_width";
const kTableHeight = { least: 120, first: 280 };
const kTableKey = "strata.table_height";
const kNotFound = { heading: texts.model.not_found_title, lead: texts.model.not_found_lead };

@customElement("strata-model-page")
export class StrataModelPage extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @property() model_id = "";
  /** All that this person sees. */
  @property({ attribute: false }) projects: readonly Project[] = [];
  @state() private dialog_: OpenDialog = null;
  // beside dialogs: while a stop is tried, views may be kept
  @state() private tour_editor_: { tour: TourEntry | null } | null = null;
  @state() private missing_: { heading: string; lead: string } | null = null;
  @state() private panel_width_ = Number(localStorage.getItem(kPanelKey)) || kPanelWidth.first;
  @state() private table_height_ = Number(localStorage.getItem(kTableKey)) || kTableHeight.first;
  @state() private panel_shown_ = window.innerWidth > kNarrow;
  @query("strata-stage") private stage_!: StrataStage | null;
  @query("strata-tour") private tour_!: StrataTour | null;
  @query(".options") private options_!: HTMLElement | null;
  private session_: OpenModelSession | null = null;
  private asked_scale_ = false;
  private measures_ = false;
  private tool_: ToolName | null = null; // whose options are in sight
  private role_: Role | null = null; // of the newest welcome
  private wanted_comment_: number | null = null; // by the address
  private wanted_view_: string | null = null;

  static override styles = [shared_styles, model_styles];

  override connectedCallback(): void {
    super.connectedCallback();
    load_part_later("model_dialogs");
    addEventListener("keydown", this.on_key_down);
    addEventListener("keyup", this.on_key_up);
    addEventListener("blur", this.on_blur);
    addEventListener("hashchange", this.on_hash);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("keydown", this.on_key_down);
    removeEventListener("keyup", this.on_key_up);
    removeEventListener("blur", this.on_blur);
    removeEventListener("hashchange", this.on_hash);
    this.lift_notices(null);
    this.session_?.close();
    this.session_ = null;
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("model_id")) return;
    this.session_?.close();
    this.session_ = new OpenModelSession(this.api, this.model_id);
    this.missing_ = this.tour_editor_ = null;
    this.asked_scale_ = false;
    this.read_address();
    void this.open(this.session_);
  }

  override updated(): void {
    this.tour_?.requestUpdate(); // what it speaks of may be elsewhere now
    const session = this.session_;
    if (session) this.bring_options(session.tools.active);
    const narrow = matchMedia(`(max-width: ${kNarrow}px)`).matches;
    if (session?.tables.view) this.lift_notices(narrow ? "52dvh" : `${this.table_height_}px`);
    // its sheet lies over the tools
    else
      this.lift_notices(
        narrow && session && session.comments.card !== null ? "calc(48dvh - 56px)" : null,
      );
  }

  /**
   * They are an element of the whole page, and would lie over the table, or the sheet of a comment.
   */
  private lift_notices(height: string | null): void {
    const { style } = document.documentElement;
    if (height) style.setProperty("--beneath", height);
    else style.removeProperty("--beneath");
  }

  private async open(session: OpenModelSession): Promise<void> {
    session.subscribe(() => this.on_session(session));
    try {
      await session.open();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else if (error.status === 404) this.missing_ = kNotFound;
      else this.missing_ = { heading: error.problem.title, lead: error.problem.detail ?? "" };
    }
  }

  private on_session(session: OpenModelSession): void {
    if (session !== this.session_) return;
    if (session.deleted) this.missing_ = kNotFound;
    if (session.signed_out) this.dispatchEvent(new CustomEvent("signed-out"));
    if (session.session !== "" && session.role !== this.role_) {
      this.role_ = session.role;
      if (session.role !== this.me.role) this.dispatchEvent(new CustomEvent("role-changed"));
    }
    this.show_measuring(session);
    if (session.model) document.title = `${session.model.name} – ${texts.product}`;
    this.follow_address(session);
    const asks_scale = session.model && !session.model.scale_verified && session.can_curate;
    if (asks_scale && session.view.frames_drawn > 0 && !this.asked_scale_) {
      this.asked_scale_ = true;
      this.dialog_ ??= { dialog: "scale" };
    }
    this.requestUpdate();
  }

  /** What is measured is told in the panel. */
  private show_measuring(session: OpenModelSession): void {
    const measures = session.tools.active === "measure";
    if (measures && !this.measures_) this.panel_shown_ = true;
    this.measures_ = measures;
  }

  /** Whoever takes up a tool sees what can be chosen for it, however far the panel was scrolled. */
  private bring_options(tool: ToolName): void {
    const { options_: options } = this;
    if (tool === this.tool_) return;
    this.tool_ = tool;
    options?.parentElement?.scrollTo({
      top: options.offsetTop,
      behavior: wants_less_motion() ? "instant" : "smooth",
    });
  }

  /** What can be chosen for the tool in hand, from where the panel lies over the model. */
  private show_options(session: OpenModelSession): void {
    if (session.tables.view) session.tables.close();
    this.panel_shown_ = true;
    this.tool_ = null; // brought into sight with the next update
    this.requestUpdate();
  }

  private readonly on_hash = (event: HashChangeEvent): void => {
    if (event.newURL !== location.href) return; // the page was held, and its address put back
    this.read_address();
    if (this.session_) this.follow_address(this.session_);
  };

  private read_address(): void {
    this.wanted_comment_ = comment_of(location.hash);
    this.wanted_view_ = view_of(location.hash);
  }

  /**
   * To the comment or view that the address names, once it can be gone to; from then on the address
   * names what is looked at.
   */
  private follow_address(session: OpenModelSession): void {
    const { comments, view, views } = session;
    if (view.frames_drawn === 0) return;
    const [comment, kept] = [this.wanted_comment_, this.wanted_view_];
    if (comment !== null && comments.loaded) {
      this.wanted_comment_ = null;
      comments.go_to(comment);
    }
    if (kept !== null && (views.loaded || views.failed)) {
      this.wanted_view_ = null;
      if (views.loaded) views.follow(kept);
      else notices.show("problem", texts.kept_views.failed);
    }
    if (this.wanted_comment_ !== null || this.wanted_view_ !== null) return;
    const seen = views.current;
    put_hash(
      typeof comments.card === "number"
        ? hash_of_comment(comments.card)
        : seen
          ? hash_of_view(seen.slug)
          : "",
    );
  }

  override render(): TemplateResult {
    const session = this.session_;
    if (this.missing_) {
      return html`<strata-blank heading=${this.missing_.heading} lead=${this.missing_.lead}>
        <a class="button" href="/" @click=${follow}>${icon("back")}${texts.model.back}</a>
      </strata-blank>`;
    }
    if (!session) return html``;
    return html`<div
        class="page ${this.panel_shown_ ? "" : "without-panel"} ${session.tables.view ? "with-table" : ""}"
        ${styled({ "--panel": growing(this.panel_width_), "--table": `${this.table_height_}px` })}
        @click=${{ handleEvent: give_back_keyboard, capture: true }}
      >
        <strata-tour .session=${session} .held=${this.dialog_ !== null || this.tour_editor_ !== null}></strata-tour>
        ${this.header(session)}
        <section class="tools" aria-label=${texts.model.tools}>
          <strata-paint-chip .session=${session} @options=${() => this.show_options(session)}></strata-paint-chip>
          <strata-tool-rail role="toolbar" aria-label=${texts.model.tools} .session=${session}></strata-tool-rail>
        </section>
        <main>
          <strata-stage .session=${session}></strata-stage>
          <strata-together-bar .session=${session}></strata-together-bar>
          <strata-comment-pins .session=${session}></strata-comment-pins>
          ${session.comments.card === null ? nothing : html`<strata-comment-card .session=${session}></strata-comment-card>`}
          ${this.banner(session)}
          <div class="readings">
            ${
              session.tables.card
                ? html`<strata-record-card
                  .session=${session}
                  @request=${(event: CustomEvent<TablePanelRequest>) => (this.dialog_ = event.detail)}
                ></strata-record-card>`
                : nothing
            }
            <strata-value-readout .session=${session}></strata-value-readout>
          </div>
          <strata-hover-card .session=${session}></strata-hover-card>
        </main>
        ${session.tables.view ? this.table(session, session.tables.view) : nothing} ${this.panel_shown_ ? this.panel(session) : nothing}
      </div>
      ${this.dialog(session)}
      ${
        this.tour_editor_ && has_part("model_dialogs", this)
          ? html`<strata-tour-dialog .session=${session} .tour=${this.tour_editor_.tour} @try=${this.make_room} @closed=${() => (this.tour_editor_ = null)}></strata-tour-dialog>`
          : nothing
      }`;
  }

  /** Something on the model is looked at: a narrow window has no room for the panel as well. */
  private make_room(): void {
    if (window.innerWidth <= kNarrow) this.panel_shown_ = false;
  }

  private on_view_request(request: ViewRequest | TourRequest): void {
    if (request.dialog === "tour") this.tour_editor_ ??= { tour: request.tour };
    else this.dialog_ = request;
  }

  private header(session: OpenModelSession): TemplateResult {
    const { model } = session;
    return html`<header>
      <a class="home" href=${model && is_one_of_several(model.project, this.projects) ? path_of_project(model.project) : "/"} title=${texts.model.back} aria-label=${texts.model.back} @click=${follow}>${logo()}</a>
      <h1 class="ellipsis">${model?.name ?? ""}</h1>
      <button
        class="icon quiet"
        aria-label=${texts.model.details}
        title=${texts.model.details}
        ?disabled=${!model}
        @click=${() => (this.dialog_ = { dialog: "about" })}
      >
        ${icon("info")}
      </button>
      ${
        model && !model.scale_verified && session.can_curate
          ? html`<button class="scale-chip" @click=${() => (this.dialog_ = { dialog: "scale" })}>${texts.model.check_size}</button>`
          : nothing
      }
      <span class="grow"></span>
      <strata-people-menu .session=${session}></strata-people-menu>
      ${this.saving(session)}
      <button
        class="icon quiet"
        data-tour="share"
        aria-label=${texts.model.help}
        title="${texts.model.help} (?)"
        @click=${() => (this.dialog_ = { dialog: "help" })}
      >
        ${icon("help")}
      </button>
      <button
        class="icon quiet"
        data-tour="panel"
        aria-pressed=${this.panel_shown_}
        aria-label=${this.panel_shown_ ? texts.model.hide_panel : texts.model.show_panel}
        title=${this.panel_shown_ ? texts.model.hide_panel : texts.model.show_panel}
        @click=${() => (this.panel_shown_ = !this.panel_shown_)}
      >
        ${icon("panel")}${
          !this.panel_shown_ && session.comments.unread_count > 0
            ? html`<span class="unread" role="img" aria-label=${texts.comments.unread(session.comments.unread_count)}></span>`
            : nothing
        }
      </button>
      <strata-account-menu .me=${this.me} .kiosks=${sees_to_kiosks(this.me, this.projects)}></strata-account-menu>
    </header>`;
  }

  private saving(session: OpenModelSession): TemplateResult {
    const { waiting, failing } = session.saving;
    const lost = session.connection_state !== "open";
    const state = waiting === 0 ? "saved" : failing || lost ? "not-saved" : "saving";
    const words =
      state === "saved"
        ? texts.saving.saved
        : state === "saving"
          ? texts.saving.saving
          : texts.saving.not_saved(waiting);
    return html`<div
      class="saving ${state}"
      role="status"
      data-state=${state}
      title=${state === "not-saved" ? texts.saving.not_saved_hint : words}
    >
      ${icon(state === "saved" ? "check" : state === "saving" ? "cloud" : "warning")}<span>${words}</span>
    </div>`;
  }

  private banner(session: OpenModelSession): TemplateResult {
    const reconnects = session.connection_state === "connecting" && session.view.frames_drawn > 0;
    if (session.connection_state !== "lost" && !reconnects) {
      return html``;
    }
    const { waiting } = session.saving;
    return html`<div class="banner" role="alert">
      ${icon("warning")}
      <span class="grow">${texts.connection.lost} ${waiting > 0 ? texts.connection.kept(waiting) : ""}</span>
      <button @click=${() => session.check_connection()}>${texts.connection.retry}</button>
    </div>`;
  }

  private panel(session: OpenModelSession): TemplateResult {
    const paints = kPaintingTools.includes(session.tools.active);
    const request = (event: CustomEvent<LayerPanelRequest | WhereRequest>): void => {
      this.dialog_ = event.detail;
    };
    return html`<aside aria-label=${texts.model.panel}>
      <div
        class="splitter"
        role="separator"
        aria-orientation="vertical"
        aria-label=${texts.model.resize_panel}
        aria-valuenow=${this.panel_width_}
        aria-valuemin=${kPanelWidth.least}
        aria-valuemax=${kPanelWidth.most}
        tabindex="0"
        @pointerdown=${(event: PointerEvent) => follow_drag(event, (at) => this.set_panel_width((window.innerWidth - at.clientX) / growth()))}
        @keydown=${this.on_splitter_key}
      ></div>
      <div class="scroll">
        ${session.tools.active === "measure" ? html`<section class="options"><strata-measure-panel .session=${session}></strata-measure-panel></section>` : nothing}
        ${paints ? html`<section class="options"><strata-brush-panel .session=${session} @request=${request}></strata-brush-panel></section>` : nothing}
        <section>
          <strata-layer-panel
            .session=${session}
            @request=${request}
          ></strata-layer-panel>
        </section>
        ${session.can_paint && session.reviews.is_used ? html`<section><strata-review-panel .session=${session}></strata-review-panel></section>` : nothing}
        <section><strata-comment-panel .session=${session}></strata-comment-panel></section>
        <section><strata-activity-panel .session=${session}></strata-activity-panel></section>
        <section>
          <strata-view-panel
            .session=${session}
            @orthophoto=${() => (this.dialog_ = { dialog: "orthophoto" })}
            @request=${(event: CustomEvent<ViewRequest | TourRequest>) => this.on_view_request(event.detail)}
          ></strata-view-panel>
        </section>
      </div>
    </aside>`;
  }

  private table(session: OpenModelSession, view: TableView): TemplateResult {
    return html`<section class="table" aria-label=${texts.tables.panel}>
      <div
        class="splitter across"
        role="separator"
        aria-orientation="horizontal"
        aria-label=${texts.tables.resize}
        aria-valuenow=${this.table_height_}
        aria-valuemin=${kTableHeight.least}
        tabindex="0"
        @pointerdown=${(event: PointerEvent) => follow_drag(event, (at) => this.set_table_height(window.innerHeight - at.clientY))}
        @keydown=${this.on_table_splitter_key}
      ></div>
      ${keyed(
        view,
        html`<strata-table-panel
          .session=${session}
          .view=${view}
          @request=${(event: CustomEvent<TablePanelRequest>) => (this.dialog_ = event.detail)}
          @drop-column=${(event: CustomEvent<Column>) => void drop_column(session, view, event.detail)}
        ></strata-table-panel>`,
      )}
    </section>`;
  }

  private dialog(session: OpenModelSession): TemplateResult {
    const closed = (): void => {
      this.dialog_ = null;
    };
    const dialog = this.dialog_;
    if (dialog && !has_part("model_dialogs", this)) return html``;
    switch (dialog?.dialog) {
      case undefined:
        return html``;
      case "create":
        return html`<strata-layer-dialog .session=${session} @closed=${closed}></strata-layer-dialog>`;
      case "template":
        return html`<strata-template-dialog .session=${session} @closed=${closed}></strata-template-dialog>`;
      case "terms":
        return html`<strata-terms-dialog .session=${session} .table=${dialog.table} .file=${dialog.file} @closed=${closed}></strata-terms-dialog>`;
      case "transfer":
        return html`<strata-transfer-dialog .session=${session} @closed=${closed}></strata-transfer-dialog>`;
      case "edit":
        return html`<strata-layer-dialog .session=${session} .layer=${newest(session, dialog.layer)} @closed=${closed}></strata-layer-dialog>`;
      case "colors":
        return html`<strata-color-dialog .session=${session} .layer=${newest(session, dialog.layer)} @closed=${closed}></strata-color-dialog>`;
      case "statistics":
        return html`<strata-statistics-dialog
          .session=${session}
          .layer=${newest(session, dialog.layer)}
          @closed=${closed}
        ></strata-statistics-dialog>`;
      case "where":
        return html`<strata-where-dialog
          .session=${session}
          .layer=${newest(session, dialog.layer)}
          @closed=${closed}
        ></strata-where-dialog>`;
      case "record":
        return html`<strata-record-dialog
          .session=${session}
          .layer=${newest(session, dialog.layer)}
          .key=${dialog.key}
          @closed=${closed}
        ></strata-record-dialog>`;
      case "delete-record":
        return html`<strata-delete-record-dialog
          .session=${session}
          .table=${dialog.layer.table ?? 0}
          .key=${dialog.key}
          @closed=${closed}
        ></strata-delete-record-dialog>`;
      case "column": {
        const table = session.tables.find(dialog.table);
        if (!table) return html``;
        return html`<strata-column-dialog .session=${session} .table=${table} .column=${dialog.column} @closed=${closed}></strata-column-dialog>`;
      }
      case "csv":
        return html`<strata-csv-dialog .session=${session} .table=${dialog.table} .file=${dialog.file} @closed=${closed}></strata-csv-dialog>`;
      case "photos":
        return html`<strata-photos-dialog .session=${session} .table=${dialog.table} .files=${dialog.files} @closed=${closed}></strata-photos-dialog>`;
      case "map":
        return html`<strata-map-dialog
          .session=${session}
          .layer=${newest(session, dialog.layer)}
          @closed=${closed}
        ></strata-map-dialog>`;
      case "view":
        return html`<strata-view-dialog .session=${session} .view=${dialog.view} @closed=${closed}></strata-view-dialog>`;
      case "figure":
        return html`<strata-figure-dialog
          .session=${session}
          .view=${dialog.view}
          @aside=${this.make_room}
          @correct=${() => (this.dialog_ = { dialog: "scale" })}
          @closed=${closed}
        ></strata-figure-dialog>`;
      case "kiosks":
        return session.model
          ? html`<strata-kiosks-dialog
              .api=${session.api}
              .tour=${{ project: session.model.project, model: session.model.slug, ...dialog.tour }}
              @closed=${closed}
              @signed-out=${() => this.dispatchEvent(new CustomEvent("signed-out"))}
            ></strata-kiosks-dialog>`
          : html``;
      case "orthophoto":
        return html`<strata-orthophoto-dialog .session=${session} @closed=${closed}></strata-orthophoto-dialog>`;
      case "scale":
        return html`<strata-scale-dialog .session=${session} @closed=${closed}></strata-scale-dialog>`;
      case "help":
        return html`<strata-help-sheet @closed=${closed} @tour=${() => void this.tour_?.start()}></strata-help-sheet>`;
      case "about":
        return session.model
          ? html`<strata-about-sheet
              .model=${session.model}
              .viewer=${session.role}
              .correctable=${session.can_curate}
              @download-for=${(event: CustomEvent<Model["source_download"]>) => void this.say_who_downloads(event.detail)}
              @closed=${closed}
              @correct=${() => (this.dialog_ = { dialog: "scale" })}
            ></strata-about-sheet>`
          : html``;
    }
  }

  private show(dialog: "help" | "figure"): void {
    this.dialog_ = dialog === "figure" ? { dialog, view: null } : { dialog };
  }

  private async say_who_downloads(source_download: Model["source_download"]): Promise<void> {
    try {
      await this.session_?.change_model({ source_download });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  private readonly on_key_down = (event: KeyboardEvent): void => {
    const session = this.session_;
    if (!session || modal_is_open() || event.defaultPrevented || is_for_field(event)) return;
    const on_button = event.composedPath()[0] instanceof HTMLButtonElement;
    if (event.key === "Enter" && on_button) return;
    if (event.key === " ") {
      if (on_button) return;
      if (this.stage_) this.stage_.orbit_held = true;
      event.preventDefault();
      return;
    }
    const does =
      handle_key(event, session, (dialog) => this.show(dialog)) ||
      (event.key === "Escape" && this.tour_?.end());
    if (does) event.preventDefault();
  };

  private readonly on_key_up = (event: KeyboardEvent): void => {
    if (event.key === " " && this.stage_) this.stage_.orbit_held = false;
  };

  /** The key may come up in another window. */
  private readonly on_blur = (): void => {
    if (this.stage_) this.stage_.orbit_held = false;
  };

  private on_splitter_key(event: KeyboardEvent): void {
    const step = { ArrowLeft: 20, ArrowRight: -20 }[event.key];
    if (!step) return;
    event.preventDefault();
    this.set_panel_width(this.panel_width_ + step);
  }

  private on_table_splitter_key(event: KeyboardEvent): void {
    const step = { ArrowUp: 20, ArrowDown: -20 }[event.key];
    if (!step) return;
    event.preventDefault();
    this.set_table_height(this.table_height_ + step);
  }

  private set_table_height(height: number): void {
    this.table_height_ = Math.round(
      Math.min(window.innerHeight * 0.75, Math.max(kTableHeight.least, height)),
    );
    localStorage.setItem(kTableKey, String(this.table_height_));
  }

  private set_panel_width(width: number): void {
    const most = Math.min(kPanelWidth.most, (window.innerWidth * 0.6) / growth());
    this.panel_width_ = Math.round(Math.min(most, Math.max(kPanelWidth.least, width)));
    localStorage.setItem(kPanelKey, String(this.panel_width_));
  }
}

function follow_drag(event: PointerEvent, move: (at: PointerEvent) => void): void {
  const splitter = event.currentTarget as HTMLElement;
  splitter.setPointerCapture(event.pointerId);
  splitter.addEventListener("pointermove", move);
  splitter.addEventListener(
    "lostpointercapture",
    () => splitter.removeEventListener("pointermove", move),
    { once: true },
  );
}

async function drop_column(
  session: OpenModelSession,
  view: TableView,
  column: Column,
): Promise<void> {
  const words = texts.tables;
  if (
    !(await ask({
      heading: words.drop_title(label_of(column)),
      lead: words.drop_lead,
      yes: words.drop,
      danger: true,
    }))
  )
    return;
  try {
    await session.api.drop_column(view.table_id, column.id);
    await session.tables.reload(view.table_id);
  } catch (error) {
    notices.error(error);
  }
}

/**
 * A button that was pressed with the pointer does not keep the keyboard: Space would press it again
 * instead of turning the model. One that was pressed by a key does.
 */
function give_back_keyboard(event: MouseEvent): void {
  if (event.detail === 0) return;
  for (const element of event.composedPath())
    if (element instanceof HTMLButtonElement) element.blur();
}

/** The layer as it is now: the request may be older. */
const newest = (session: OpenModelSession, layer: Layer): Layer =>
  session.layers.all.find((each) => each.id === layer.id) ?? layer;
