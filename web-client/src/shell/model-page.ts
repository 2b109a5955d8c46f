// <strata-model-page>: the page of one model. The stage is in the middle, the tools on the left,
// the layers and the brush on the right. On a phone, layers and brush are in a sheet at the bottom.

import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { cache } from "lit/directives/cache.js";
import { keyed } from "lit/directives/keyed.js";
import { ApiError } from "../net/api-error";
import type { Api } from "../net/api";
import type { Project, TourEntry } from "../core/protocol.gen";
import type { Column, Me, Model, Role } from "../core/types";
import { hasOptions, kPaintingTools, type ToolName } from "../tools/tool";
import { askAccount } from "../ui/account-menu";
import "../ui/status-page";
import type { WhereRequest } from "../features/painting/brush-panel";
import "../features/painting/brush-panel";
import "../features/comments/comment-pins";
import { modalIsOpen } from "../ui/dialog";
import { icon, logo } from "../ui/icons";
import { handleKey, opensCommands } from "./keyboard";
import { isForField } from "../ui/keyboard";
import { withKey } from "../ui/keys/command-keys";
import { growing, growth } from "../ui/growth";
import "../features/records/hover-card";
import "../features/layers/job-list";
import type { LayerPanelRequest } from "../features/layers/layer-panel";
import "../features/layers/layer-panel";
import "../features/painting/paint-chip";
import { modelStyles } from "./model-styles";
import type { OpenDialog, PageHost } from "./open-dialog";
import { OpenModelSession } from "./open-model-session";
import { notices } from "../ui/notices";
import { hasPart, loadPartLater, partOf } from "./page-parts";
import "../features/records/record-card";
import "../features/records/records-panel";
import "../features/presence/people-menu";
import { isOneOfSeveral, seesToKiosks } from "../features/home/project-list";
import {
  commentOf,
  follow,
  hashOfComment,
  hashOfView,
  pathOfProject,
  putHash,
  viewOf,
} from "../ui/routes";
import "./stage";
import type { StrataStage } from "./stage";
import { styled } from "../ui/styled";
import { sharedStyles } from "../ui/styles";
import type { SelectionRequest, TablePanelRequest } from "../session/requests";
import "../features/tours/tour-list";
import "../features/views/view-list";
import type { TableView } from "../features/tables/table-view";
import { texts } from "../texts";
import "../features/presence/together-bar";
import "./tool-rail";
import "../features/onboarding/onboarding";
import type { StrataOnboarding } from "../features/onboarding/onboarding";
import type { TourRequest } from "../session/requests";
import "../features/painting/value-readout";
import { wantsLessMotion } from "../session/view-control";
import { dropColumn } from "../features/tables/drop-column";
import type { ModelDialogRequest, ViewRequest } from "../session/requests";
import { Splitter } from "./splitter";
import { PanelTabs, type PanelTab } from "./panel-tabs";
import { tabId, tabListStyles } from "../ui/panel/tab-list";
import { lostBanner, savingStatus } from "./connection-status";
import "../features/appearance/picture-bar";
import "../features/appearance/view-panel";

const kNarrow = 820; // in windows up to this width, the panel covers the model
const kMaxPanelWidth = 620;
const kNotFound = { heading: texts.model.not_found_title, lead: texts.model.not_found_lead };

const paints = (tool: ToolName): boolean => kPaintingTools.includes(tool);

@customElement("strata-model-page")
export class StrataModelPage extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @property({ attribute: "model_id" }) modelId = "";
  /** All projects that the user can see. */
  @property({ attribute: false }) projects: readonly Project[] = [];
  @state() private _dialog: OpenDialog | null = null;
  // Separate from dialogs, because views can be saved while a stop is previewed.
  @state() private _tourEditor: { tour: TourEntry | null } | null = null;
  @state() private _missing: { heading: string; lead: string } | null = null;
  @state() private _panelShown = window.innerWidth > kNarrow;
  @query("strata-stage") private _stage!: StrataStage | null;
  @query("strata-tour") private _tour!: StrataOnboarding | null;
  @query(".scroll") private _panelContent!: HTMLElement | null;
  // The size is in pixels at the default text size, and scales with the text size.
  private readonly _panelSplitter = new Splitter(this, {
    label: texts.model.resize_panel,
    key: "strata.panel_width",
    first: 330,
    least: 270,
    most: () => Math.min(kMaxPanelWidth, (window.innerWidth * 0.6) / growth()),
    largest: kMaxPanelWidth,
    sizeAt: ({ clientX }) => (window.innerWidth - clientX) / growth(),
  });
  private readonly _tableSplitter = new Splitter(this, {
    label: texts.tables.resize,
    key: "strata.table_height",
    first: 280,
    least: 120,
    most: () => window.innerHeight * 0.75,
    isAcross: true,
    sizeAt: ({ clientY }) => window.innerHeight - clientY,
  });
  private readonly _tabs = new PanelTabs(this);
  private _session: OpenModelSession | null = null;
  private _askedScale = false;
  private _measures = false;
  private _tool: ToolName | null = null; // the tool whose options are visible
  private _role: Role | null = null; // role in the last welcome
  private _card: number | "new" | null = null; // the open comment
  private _hash = ""; // the part of the address that this page last read or wrote
  private _wantedComment: number | null = null; // comment in the address
  private _wantedView: string | null = null;

  static override styles = [sharedStyles, tabListStyles, modelStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    for (const part of [
      "comments",
      "model_dialogs",
      "table",
      "measuring",
      "activity",
      "past",
    ] as const)
      loadPartLater(part);
    addEventListener("keydown", this.onKeyDown);
    addEventListener("keyup", this.onKeyUp);
    addEventListener("blur", this.onBlur);
    addEventListener("hashchange", this.onHash);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("keydown", this.onKeyDown);
    removeEventListener("keyup", this.onKeyUp);
    removeEventListener("blur", this.onBlur);
    removeEventListener("hashchange", this.onHash);
    this.liftNotices(null);
    this._session?.close();
    this._session = null;
  }

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("modelId")) return;
    this._session?.close();
    this._session = new OpenModelSession(this.api, this.modelId);
    this._missing = this._tourEditor = null;
    this._askedScale = false;
    this.readAddress();
    void this.open(this._session);
  }

  override updated(): void {
    this._tour?.requestUpdate(); // the target of the tour may have moved
    const session = this._session;
    if (session) {
      this.bringOptions(session.tools.active);
      this.bringComment(session.comments.card);
    }
    const narrow = matchMedia(`(max-width: ${kNarrow}px)`).matches;
    if (session?.tables.view) this.liftNotices(narrow ? "52dvh" : `${this._tableSplitter.size}px`);
    else if (session?.past.isOpen) this.liftNotices("var(--past-height, 0px)");
    // In narrow windows, the sheet of a comment covers the tools.
    else
      this.liftNotices(
        narrow && session && session.comments.card !== null ? "calc(48dvh - 56px)" : null,
      );
  }

  /** Moves notices up, because they would cover the table or the sheet of a comment. */
  private liftNotices(height: string | null): void {
    const { style } = document.documentElement;
    if (height) style.setProperty("--beneath", height);
    else style.removeProperty("--beneath");
  }

  private async open(session: OpenModelSession): Promise<void> {
    session.subscribe(
      () => this.onSession(session),
      [
        "saving",
        "tools",
        "layers",
        "tables",
        "comments",
        "reviews",
        "activity",
        "appearance",
        "past",
        "surveys",
      ],
    );
    session.subscribe(
      () => this.onPlace(session),
      ["view", "views", "layers", "appearance", "comments"],
    );
    try {
      await session.open();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else if (error.status === 404) this._missing = kNotFound;
      else this._missing = { heading: error.problem.title, lead: error.problem.detail ?? "" };
    }
  }

  private onSession(session: OpenModelSession): void {
    if (session !== this._session) return;
    if (session.deleted) this._missing = kNotFound;
    if (session.signedOut) this.dispatchEvent(new CustomEvent("signed-out"));
    if (session.session !== "" && session.role !== this._role) {
      this._role = session.role;
      if (session.role !== this.me.role) this.dispatchEvent(new CustomEvent("role-changed"));
    }
    this.showMeasuring(session);
    if (session.model) document.title = `${session.model.name} – ${texts.product}`;
    this.requestUpdate();
  }

  /** Handles a change of the view, and the first frame. */
  private onPlace(session: OpenModelSession): void {
    if (session !== this._session) return;
    this.followAddress(session);
    const asksScale = session.model && !session.model.scale_verified && session.canCurate;
    if (asksScale && session.view.framesDrawn > 0 && !this._askedScale) {
      this._askedScale = true;
      this._dialog ??= { dialog: "scale" };
    }
  }

  /** Opens the panel when the measuring tool becomes active. */
  private showMeasuring(session: OpenModelSession): void {
    const measures = session.tools.active === "measure";
    if (measures && !this._measures) this._panelShown = true;
    this._measures = measures;
  }

  /** Shows the options of a newly chosen tool, which are above the layers. */
  private bringOptions(tool: ToolName): void {
    if (tool === this._tool) return;
    this._tool = tool;
    if (!hasOptions(tool)) return;
    this._tabs.choose("layers");
    this._panelContent?.scrollTo({
      top: 0,
      behavior: wantsLessMotion() ? "instant" : "smooth",
    });
  }

  /**
   * Shows the list of comments when a comment was opened on the stage or by a link. If the user
   * reads the activity, that tab stays open.
   */
  private bringComment(card: number | "new" | null): void {
    if (card === this._card) return;
    this._card = card;
    if (typeof card === "number" && this._tabs.chosen !== "activity") this._tabs.choose("comments");
  }

  /** Opens the panel at the options of the active tool. The panel may cover the model. */
  private showOptions(session: OpenModelSession): void {
    if (session.tables.view) session.tables.close();
    this._panelShown = true;
    this._tool = null; // the next update scrolls to the options
    this.requestUpdate();
  }

  private readonly onHash = (): void => {
    if (this._session) this.followAddress(this._session);
  };

  private readAddress(): void {
    this._hash = location.hash;
    this._wantedComment = commentOf(location.hash);
    this._wantedView = viewOf(location.hash);
  }

  /**
   * Opens the comment or view in the address as soon as it is loaded. After that, the address
   * always names the displayed comment or view.
   */
  private followAddress(session: OpenModelSession): void {
    const { comments, view, views } = session;
    if (view.framesDrawn === 0) return;
    // The browser sends its event only after it has changed the address.
    if (location.hash !== this._hash) this.readAddress();
    const [comment, kept] = [this._wantedComment, this._wantedView];
    if (comment !== null && comments.loaded) {
      this._wantedComment = null;
      this._tabs.choose("comments");
      comments.goTo(comment);
    }
    if (kept !== null && (views.loaded || views.failed)) {
      this._wantedView = null;
      this._tabs.choose("view");
      if (views.loaded) views.follow(kept);
      else notices.show("problem", texts.kept_views.failed);
    }
    if (this._wantedComment !== null || this._wantedView !== null) return;
    const seen = views.current;
    putHash(
      typeof comments.card === "number"
        ? hashOfComment(comments.card)
        : seen
          ? hashOfView(seen.slug)
          : "",
    );
    this._hash = location.hash;
  }

  override render(): TemplateResult {
    const session = this._session;
    if (this._missing) {
      return html`<strata-blank heading=${this._missing.heading} lead=${this._missing.lead}>
        <a class="button" href="/" @click=${follow}>${icon("back")}${texts.model.back}</a>
      </strata-blank>`;
    }
    if (!session) return html``;
    return html`<div
        class="page ${this._panelShown ? "" : "without-panel"} ${session.tables.view ? "with-table" : ""}"
        ${styled({ "--panel": growing(this._panelSplitter.size), "--table": `${this._tableSplitter.size}px` })}
        @click=${{ handleEvent: giveBackKeyboard, capture: true }}
      >
        <strata-tour .session=${session} .held=${this._dialog !== null || this._tourEditor !== null}></strata-tour>
        ${this.header(session)}
        <section class="tools" aria-label=${texts.model.tools}>
          <strata-paint-chip .session=${session} @options=${() => this.showOptions(session)}></strata-paint-chip>
          <strata-tool-rail role="toolbar" aria-label=${texts.model.tools} .session=${session}></strata-tool-rail>
        </section>
        <main>
          <strata-stage .session=${session} @request=${(event: CustomEvent<SelectionRequest | TablePanelRequest>) => (this._dialog = event.detail)}></strata-stage>
          ${session.past.isOpen && hasPart("past", this) ? html`<strata-past-overlay .session=${session}></strata-past-overlay>` : nothing}
          ${this.surveys(session)}
          <strata-together-bar .session=${session}></strata-together-bar>
          <strata-comment-pins .session=${session}></strata-comment-pins>
          ${session.comments.card === null || !hasPart("comments", this) ? nothing : html`<strata-comment-card .session=${session}></strata-comment-card>`}
          <strata-picture-bar .session=${session} .hasParts=${Boolean(session.model?.parts) && hasPart("parts", this)}></strata-picture-bar>
          ${lostBanner(session)}
          <div class="readings">
            ${
              session.tables.card
                ? html`<strata-record-card
                  .session=${session}
                  @request=${(event: CustomEvent<TablePanelRequest>) => (this._dialog = event.detail)}
                ></strata-record-card>`
                : nothing
            }
            <strata-value-readout .session=${session}></strata-value-readout>
          </div>
          <strata-hover-card .session=${session}></strata-hover-card>
          ${this.history(session)}
        </main>
        ${session.tables.view ? this.table(session, session.tables.view) : nothing} ${this._panelShown ? this.panel(session) : nothing}
      </div>
      ${this.dialog(session)}
      ${
        this._tourEditor && hasPart("model_dialogs", this)
          ? html`<strata-tour-dialog .session=${session} .tour=${this._tourEditor.tour} @try=${this.makeRoom} @closed=${() => (this._tourEditor = null)}></strata-tour-dialog>`
          : nothing
      }`;
  }

  /** Closes the panel in narrow windows, where it covers the model. */
  private makeRoom(): void {
    if (window.innerWidth <= kNarrow) this._panelShown = false;
  }

  private onViewRequest(request: ViewRequest | TourRequest | ModelDialogRequest): void {
    if (request.dialog === "tour") this._tourEditor ??= { tour: request.tour };
    else this._dialog = request;
  }

  private header(session: OpenModelSession): TemplateResult {
    const { model } = session;
    return html`<header>
      <a class="home" href=${model && isOneOfSeveral(model.project, this.projects) ? pathOfProject(model.project) : "/"} title=${texts.model.back} aria-label=${texts.model.back} @click=${follow}>${logo()}</a>
      <h1 class="ellipsis">${model?.name ?? ""}</h1>
      <button
        class="icon quiet"
        aria-label=${texts.model.details}
        title=${texts.model.details}
        ?disabled=${!model}
        @click=${() => (this._dialog = { dialog: "about" })}
      >
        ${icon("info")}
      </button>
      ${
        model && !model.scale_verified && session.canCurate
          ? html`<button class="scale-chip" @click=${() => (this._dialog = { dialog: "scale" })}>${texts.model.check_size}</button>`
          : nothing
      }
      <span class="grow"></span>
      <strata-people-menu .session=${session}></strata-people-menu>
      ${savingStatus(session)}
      <button
        class="icon quiet commands"
        aria-label=${texts.commands.title}
        title=${withKey(texts.commands.title, "commands")}
        @click=${() => (this._dialog = { dialog: "commands" })}
      >
        ${icon("search")}
      </button>
      <button
        class="icon quiet"
        data-tour="share"
        aria-label=${texts.model.help}
        title=${withKey(texts.model.help, "help")}
        @click=${() => (this._dialog = { dialog: "help" })}
      >
        ${icon("help")}
      </button>
      <button
        class="icon quiet"
        data-tour="panel"
        aria-pressed=${this._panelShown}
        aria-label=${this._panelShown ? texts.model.hide_panel : texts.model.show_panel}
        title=${this._panelShown ? texts.model.hide_panel : texts.model.show_panel}
        @click=${() => (this._panelShown = !this._panelShown)}
      >
        ${icon("panel")}${
          !this._panelShown && session.comments.unreadCount > 0
            ? html`<span class="unread" role="img" aria-label=${texts.comments.unread(session.comments.unreadCount)}></span>`
            : nothing
        }
      </button>
      <strata-account-menu .me=${this.me} .kiosks=${seesToKiosks(this.me, this.projects)}></strata-account-menu>
    </header>`;
  }

  private surveys(session: OpenModelSession): TemplateResult | typeof nothing {
    const { surveys, past } = session;
    if (!surveys.object || !hasPart("surveys", this)) return nothing;
    // Hidden, the overlay keeps its picture: the server sends a frame only after a change.
    return html`${
      surveys.other
        ? html`<strata-survey-overlay .session=${session} ?hidden=${past.isActive}></strata-survey-overlay>`
        : nothing
    }
      <strata-survey-bar .session=${session} @request=${(event: CustomEvent<OpenDialog>) => (this._dialog = event.detail)}></strata-survey-bar>`;
  }

  private history(session: OpenModelSession): TemplateResult | typeof nothing {
    const { past, visits } = session;
    if ((!past.isOpen && !visits.news) || !hasPart("past", this)) return nothing;
    return past.isOpen
      ? html`<strata-past-bar .session=${session}></strata-past-bar>`
      : html`<strata-past-since .session=${session}></strata-past-since>`;
  }

  private panel(session: OpenModelSession): TemplateResult {
    const { chosen } = this._tabs;
    return html`<aside aria-label=${texts.model.panel}>
      ${this._panelSplitter.render()} ${this._tabs.render(session, "panel")}
      <strata-job-list .session=${session}></strata-job-list>
      <div class="scroll" id="panel" role="tabpanel" aria-labelledby=${tabId(chosen)}>${cache(this.tab(session, chosen))}</div>
    </aside>`;
  }

  private tab(session: OpenModelSession, tab: PanelTab): TemplateResult {
    switch (tab) {
      case "layers":
        return this.layers(session);
      case "records":
        return html`<section>
          <strata-records-panel
            .session=${session}
            @request=${(event: CustomEvent<TablePanelRequest>) => (this._dialog = event.detail)}
          ></strata-records-panel>
        </section>`;
      case "view":
        return html`<section>
          <strata-view-panel
            .session=${session}
            @orthophoto=${() => (this._dialog = { dialog: "orthophoto" })}
            @request=${(event: CustomEvent<ViewRequest | TourRequest | ModelDialogRequest>) => this.onViewRequest(event.detail)}
          ></strata-view-panel>
        </section>`;
      case "comments":
        if (!hasPart("comments", this)) return html``;
        return html`<section><strata-comment-panel .session=${session}></strata-comment-panel></section>`;
      case "activity":
        if (!hasPart("activity", this)) return html``;
        return html`${session.canPaint && session.reviews.isUsed ? html`<section><strata-review-panel .session=${session}></strata-review-panel></section>` : nothing}
          <section><strata-activity-panel .session=${session}></strata-activity-panel></section>`;
    }
  }

  /** Shows the layers, and above them the options of the active tool. */
  private layers(session: OpenModelSession): TemplateResult {
    const { active } = session.tools;
    const request = (
      event: CustomEvent<LayerPanelRequest | WhereRequest | SelectionRequest>,
    ): void => {
      this._dialog = event.detail;
    };
    return html`${active === "measure" && hasPart("measuring", this) ? html`<section class="options"><strata-measure-panel .session=${session}></strata-measure-panel></section>` : nothing}
      ${active === "wand" && !session.lockedTarget && hasPart("model_dialogs", this) ? html`<section class="options"><strata-wand-panel .session=${session} @request=${request}></strata-wand-panel></section>` : paints(active) ? html`<section class="options"><strata-brush-panel .session=${session} @request=${request}></strata-brush-panel></section>` : nothing}
      <section><strata-layer-panel .session=${session} @request=${request}></strata-layer-panel></section>`;
  }

  private table(session: OpenModelSession, view: TableView): TemplateResult {
    return html`<section class="table" aria-label=${texts.tables.panel}>
      ${this._tableSplitter.render()}
      ${
        hasPart("table", this)
          ? keyed(
              view,
              html`<strata-table-panel
                .session=${session}
                .view=${view}
                @request=${(event: CustomEvent<TablePanelRequest>) => (this._dialog = event.detail)}
                @drop-column=${(event: CustomEvent<Column>) => void dropColumn(session, view.tableId, event.detail)}
              ></strata-table-panel>`,
            )
          : nothing
      }
    </section>`;
  }

  private dialog(session: OpenModelSession): TemplateResult | typeof nothing {
    if (!this._dialog || !hasPart("model_dialogs", this)) return nothing;
    const { modelDialog } = partOf("model_dialogs") as typeof import("./model-dialogs");
    return modelDialog(this._dialog, this.host(session));
  }

  private host(session: OpenModelSession): PageHost {
    return {
      session,
      me: this.me,
      seesToKiosks: seesToKiosks(this.me, this.projects),
      show: (dialog) => (this._dialog = dialog),
      aside: () => this.makeRoom(),
      panel: (tab) => this.showTab(tab),
      account: (request) => askAccount(this, request),
      editTour: (tour) => (this._tourEditor ??= { tour }),
      signedOut: () => this.dispatchEvent(new CustomEvent("signed-out")),
      startTour: () => void this._tour?.start(),
      sayWhoDownloads: (who) => void this.sayWhoDownloads(who),
    };
  }

  /** Shows a tab of the panel. Null shows or hides the panel. */
  private showTab(tab: PanelTab | null): void {
    this._panelShown = tab !== null || !this._panelShown;
    if (tab) this._tabs.choose(tab);
  }

  private async sayWhoDownloads(sourceDownload: Model["source_download"]): Promise<void> {
    try {
      await this._session?.changeModel({ source_download: sourceDownload });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      notices.error(error);
    }
  }

  private readonly onKeyDown = (event: KeyboardEvent): void => {
    const session = this._session;
    if (!session || modalIsOpen() || event.defaultPrevented) return;
    if (isForField(event) && !opensCommands(event)) return;
    const onButton = event.composedPath()[0] instanceof HTMLButtonElement;
    if (event.key === "Enter" && onButton) return;
    if (event.key === " ") {
      if (onButton) return;
      if (this._stage) this._stage.orbitHeld = true;
      event.preventDefault();
      return;
    }
    const does =
      handleKey(event, this.host(session)) || (event.key === "Escape" && this._tour?.end());
    if (does) event.preventDefault();
  };

  private readonly onKeyUp = (event: KeyboardEvent): void => {
    if (event.key === " " && this._stage) this._stage.orbitHeld = false;
  };

  /** Ends the rotation by a held key, because the key may be released in another window. */
  private readonly onBlur = (): void => {
    if (this._stage) this._stage.orbitHeld = false;
  };
}

/**
 * Removes the keyboard focus from a clicked button. Otherwise Space would press the button again
 * instead of rotating the model. A button that was pressed with a key keeps the focus.
 */
function giveBackKeyboard(event: MouseEvent): void {
  if (event.detail === 0) return;
  for (const element of event.composedPath())
    if (element instanceof HTMLButtonElement) element.blur();
}
