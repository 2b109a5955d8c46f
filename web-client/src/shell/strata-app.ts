// <strata-app>: the root element. It handles the signed-in user and the page for the address. It
// also imports dropped scans and warns about unsaved changes.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { keyed } from "lit/directives/keyed.js";
import { Api } from "../net/api";
import { ApiError } from "../net/api-error";
import type { Project } from "../core/protocol.gen";
import type { Me } from "../core/types";
import type { AccountRequest } from "../ui/account-menu";
import "../ui/status-page";
import { ask } from "../ui/dialog";
import { invitationOf } from "../features/account/entry";
import { icon } from "../ui/icons";
import { droppedFiles, hasFiles, withoutFolders, type DroppedFile } from "../ui/drop";
import {
  chooseScans,
  Imports,
  tellLeftOut,
  type ImportEntry,
  type ImportResult,
  type Scan,
} from "../features/home/imports";
import { notices } from "../ui/notices";
import "./notices-view";
import { hasPart, loadPartLater, setPartLoads, withPart } from "./page-parts";
import { curates, kDefaultProject } from "../features/home/project-list";
import {
  mayLeavePage,
  navigate,
  onNavigate,
  pathNow,
  pathOfModel,
  replaceAddress,
  routeOf,
  type Route,
} from "../ui/routes";
import { checkConnections, discardUnsaved, keepViews, unsavedChanges } from "../session/sessions";
import { sharedStyles } from "../ui/styles";
import { loadLaterTexts, texts } from "../texts";

/** Wraps the load of a part whose texts are not loaded with the page. */
const later = (load: () => Promise<unknown>) => async (): Promise<unknown> => {
  await loadLaterTexts();
  return load();
};

setPartLoads({
  home: () => import("../features/home/home-page"),
  model: () => import("./model-page"),
  model_dialogs: later(() => import("./model-dialogs")),
  table: later(() => import("../features/tables/table-panel")),
  measuring: later(() => import("../features/measuring/measure-panel")),
  activity: later(() =>
    Promise.all([
      import("../features/activity/activity-panel"),
      import("../features/review/review-panel"),
    ]),
  ),
  comments: later(() =>
    Promise.all([
      import("../features/comments/comment-card"),
      import("../features/comments/comment-panel"),
    ]),
  ),
  past: later(() =>
    Promise.all([
      import("../features/past/past-bar"),
      import("../features/past/past-overlay"),
      import("../features/past/past-since"),
      import("../features/past/step-list"),
    ]),
  ),
  surveys: later(() =>
    Promise.all([
      import("../features/surveys/survey-bar"),
      import("../features/surveys/survey-overlay"),
    ]),
  ),
  parts: later(() => import("../features/parts/part-tree")),
  scans: later(() => import("../features/home/scans-dialog")),
  join: () => import("../features/account/join-page"),
  sign_in: () => import("../features/account/sign-in"),
  account: later(() => import("../features/account/account-dialog")),
  people: later(() => import("../features/account/people-dialog")),
  nodes: later(() => import("../features/account/nodes-dialog")),
  kiosks: later(() => import("../features/account/kiosks-dialog")),
  bills: later(() => import("../features/bills/bills-dialog")),
  preferences: later(() => import("../features/account/preferences-fields")),
});

@customElement("strata-app")
export class StrataApp extends LitElement {
  private readonly _api = new Api();
  private readonly _imports = new Imports(this._api);
  @state() private _route: Route = routeOf(pathNow());
  @state() private _me: Me | null = null;
  @state() private _projects: readonly Project[] = [];
  @state() private _chosenProject = ""; // slug of the project for imports
  @state() private _session: "unknown" | "signed-in" | "signed-out" | "unreachable" = "unknown";
  @state() private _problem = "";
  @state() private _dialog:
    "account" | "people" | "nodes" | "kiosks" | "preferences" | "bills" | null = null;
  private _billed = ""; // slug of the project whose bills are shown
  @state() private _dropping = false;
  @state() private _imported = 0;
  private _dragDepth = 0;

  static override styles = [
    sharedStyles,
    css`
      .drop-target {
        position: fixed;
        inset: 0;
        z-index: 40;
        display: grid;
        padding: var(--space-5);
        background: var(--drop);
        pointer-events: none;
      }
      .drop-target > div {
        display: grid;
        place-content: center;
        justify-items: center;
        gap: var(--space-2);
        border: 2px dashed var(--accent);
        border-radius: var(--radius-large);
        color: var(--accent);
      }
      .drop-target b {
        font: 600 var(--text-title-1) var(--serif);
      }
      .drop-target svg.glyph {
        width: 44px;
        height: 44px;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    onNavigate(() => (this._route = routeOf(pathNow())));
    addEventListener("unhandledrejection", (event) => notices.error(event.reason));
    addEventListener("online", checkConnections);
    document.addEventListener("visibilitychange", () => {
      if (document.visibilityState !== "visible") return keepViews();
      checkConnections();
      void this.refreshMe();
    });
    addEventListener("pagehide", keepViews);
    addEventListener("beforeunload", (event) => {
      if (unsavedChanges() > 0) event.preventDefault();
    });
    addEventListener("dragenter", this.onDragEnter);
    addEventListener("dragover", this.onDragOver);
    addEventListener("dragleave", this.onDragLeave);
    addEventListener("drop", this.onDrop);
    void this.checkSession();
  }

  private async checkSession(): Promise<void> {
    try {
      await this.takeMe(await this._api.json("GET /me"));
      this._session = "signed-in";
      checkConnections();
    } catch (error) {
      if (error instanceof ApiError && error.status === 401) {
        this._session = "signed-out";
        return;
      }
      this._session = "unreachable";
      this._problem = error instanceof Error ? error.message : "";
      setTimeout(() => void this.checkSession(), 3000);
    }
  }

  private async takeMe(me: Me): Promise<void> {
    const lost = this._me && this._me.user !== me.user ? discardUnsaved() : 0;
    if (lost > 0) notices.show("problem", texts.saving.discarded(lost));
    this._projects = await this._api.all("GET /projects", "projects");
    this._me = me;
  }

  /** Reads the user again, because the role may have changed or the session may have ended. */
  private readonly refreshMe = async (): Promise<void> => {
    if (this._session !== "signed-in") return;
    try {
      await this.takeMe(await this._api.json("GET /me"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.signedOut(); // the failing request itself reports other errors
    }
  };

  /**
   * Reads the projects again and opens `next`, the page that shows the change. If the current page
   * was deleted, `next` replaces the history entry.
   */
  private async takeProjects(next: string | null): Promise<void> {
    await this.refreshMe();
    if (next === null || next === pathNow()) return;
    if (next === "/") replaceAddress(next);
    else navigate(next);
  }

  private readonly signedOut = (): void => {
    this._session = "signed-out";
    this._dialog = null;
  };

  private async onAccount({ detail }: CustomEvent<AccountRequest>): Promise<void> {
    if (detail === "sign-out") await this.signOut();
    else this._dialog = detail;
  }

  private async signOut(): Promise<void> {
    if (!(await mayLeavePage())) return;
    const lost = unsavedChanges();
    const words = texts.account;
    const question = {
      heading: words.sign_out_title,
      lead: words.sign_out_lead(lost),
      yes: words.sign_out,
    };
    if (lost > 0 && !(await ask({ ...question, danger: true }))) return;
    try {
      await this._api.send("POST /logout");
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 401) {
        notices.error(error); // the page must not look signed out while the user is signed in
        return;
      }
    }
    discardUnsaved();
    this.signedOut();
  }

  override render(): TemplateResult {
    return html`${this.page()} ${this._session === "signed-in" && this._me ? this.dialog(this._me) : nothing}
      ${
        this._dropping
          ? html`<div class="drop-target">
            <div>${icon("upload")}<b>${texts.home.drop_title}</b><span>${texts.home.drop_lead}</span></div>
          </div>`
          : nothing
      }
      <strata-notices></strata-notices>`;
  }

  private page(): unknown {
    const { _session: session, _me: me } = this;
    if (session === "unknown") return nothing;
    if (session === "unreachable")
      return html`<strata-blank heading=${texts.connection.lost} lead=${this._problem}></strata-blank>`;
    if (this._route.page === "join") return this.joinPage(session === "signed-in" ? me : null);
    if (session === "signed-out" || !me) {
      if (!hasPart("sign_in", this)) return nothing;
      return html`<strata-sign-in .api=${this._api} @signed-in=${() => void this.checkSession()}></strata-sign-in>`;
    }
    const isModel = this._route.page === "model";
    if (!hasPart(isModel ? "model" : "home", this)) return nothing;
    if (!isModel) loadPartLater("model"); // most users open a model next
    return this._route.page === "model"
      ? keyed(
          this._route.model, // the pages of two models have no common state
          html`<strata-model-page
            .api=${this._api}
            .me=${me}
            .modelId=${this._route.model}
            .projects=${this._projects}
            @account=${this.onAccount}
            @role-changed=${this.refreshMe}
            @signed-out=${this.signedOut}
          ></strata-model-page>`,
        )
      : html`<strata-home-page
          .api=${this._api}
          .me=${me}
          .projects=${this._projects}
          .project=${this._route.project}
          .curated=${this.curated}
          .into=${this.into}
          .imports=${this._imports}
          @repeat-import=${this.repeatImport}
          .imported=${this._imported}
          @account=${this.onAccount}
          @signed-out=${this.signedOut}
          @choose-project=${({ detail }: CustomEvent<string>) => (this._chosenProject = detail)}
          @projects-changed=${({ detail }: CustomEvent<string | null>) => void this.takeProjects(detail)}
          @bills=${({ detail }: CustomEvent<string>) => this.showBills(detail)}
          @import-files=${(event: CustomEvent<File[]>) => void this.importFiles(withoutFolders(event.detail))}
        ></strata-home-page>`;
  }

  private showBills(project: string): void {
    this._billed = project;
    this._dialog = "bills";
  }

  private joinPage(me: Me | null): unknown {
    if (!hasPart("join", this)) return nothing;
    const invitation = invitationOf(location.hash);
    return keyed(
      invitation,
      html`<strata-join-page
        .api=${this._api}
        .invitation=${invitation}
        .me=${me}
        @sign-out=${this.signOut}
        @joined=${() => {
          replaceAddress("/"); // removes the used secret from the history
          void this.checkSession();
        }}
      ></strata-join-page>`,
    );
  }

  private dialog(me: Me): unknown {
    const closed = (): void => {
      this._dialog = null;
    };
    if (this._dialog && !hasPart(this._dialog, this)) return nothing;
    if (this._dialog === "account") {
      return html`<strata-account-dialog
        .api=${this._api}
        .me=${me}
        @changed=${(event: CustomEvent<Me>) => void this.takeMe(event.detail)}
        @closed=${closed}
        @signed-out=${this.signedOut}
      ></strata-account-dialog>`;
    }
    if (this._dialog === "people") {
      return html`<strata-people-dialog .api=${this._api} .me=${me} @closed=${closed} @signed-out=${this.signedOut}></strata-people-dialog>`;
    }
    if (this._dialog === "nodes") {
      return html`<strata-nodes-dialog .api=${this._api} @closed=${closed} @signed-out=${this.signedOut}></strata-nodes-dialog>`;
    }
    if (this._dialog === "kiosks") {
      return html`<strata-kiosks-dialog .api=${this._api} @closed=${closed} @signed-out=${this.signedOut}></strata-kiosks-dialog>`;
    }
    if (this._dialog === "bills") {
      return html`<strata-bills-dialog .api=${this._api} project=${this._billed} @closed=${closed}></strata-bills-dialog>`;
    }
    if (this._dialog === "preferences")
      return html`<strata-preferences-dialog @closed=${closed}></strata-preferences-dialog>`;
    return nothing;
  }

  private get importRefusal(): string | null {
    if (this._session !== "signed-in" || !this._me) return texts.import.sign_in_first;
    return this.into ? null : texts.import.not_allowed;
  }

  /** The projects in which the user can import scans. */
  private get curated(): readonly Project[] {
    return this._projects.filter(curates);
  }
  /**
   * The project for imports. This is the open project, if there is one. Null if imports are not
   * allowed.
   */
  private get into(): Project | null {
    const bySlug = (slug: string): Project | undefined =>
      this.curated.find((project) => project.slug === slug);
    const { _route: route } = this;
    if (route.page === "home" && route.project !== null) return bySlug(route.project) ?? null;
    return bySlug(this._chosenProject) ?? bySlug(kDefaultProject) ?? this.curated[0] ?? null;
  }

  private async importFiles(dropped: readonly DroppedFile[]): Promise<void> {
    let scans: readonly Scan[] = chooseScans(dropped);
    if (scans.length > 1)
      scans = await new Promise((resolve) =>
        withPart<typeof import("../features/home/scans-dialog")>("scans", ({ askAboutScans }) =>
          resolve(askAboutScans(scans, dropped)),
        ),
      );
    if (scans.length > 0) tellLeftOut(dropped, scans);
    if (this._route.page !== "home" && scans.length > 0) {
      notices.show("info", texts.import.started, "", { href: "/", label: texts.import.watch });
    }
    await Promise.all(scans.map((scan) => this.importScan(scan, scans.length === 1)));
  }

  private async importScan(scan: Scan, alone: boolean): Promise<void> {
    const { into } = this;
    if (into) await this.takeImport(this._imports.start(scan, into.slug), scan.name, alone);
  }

  private readonly repeatImport = ({ detail }: CustomEvent<ImportEntry>): void => {
    void this.takeImport(
      this._imports.repeat(detail.key),
      detail.name,
      this._imports.entries.length === 1,
    );
  };

  private async takeImport(
    ending: Promise<ImportResult>,
    name: string,
    alone: boolean,
  ): Promise<void> {
    const { model, problem } = await ending;
    this._imported += 1;
    // the home page lists the problem
    if (problem && this._route.page !== "home") notices.problem(problem);
    if (model === null) return;
    // Work on another model is not interrupted.
    const opens = alone && this._route.page === "home";
    const link = { href: pathOfModel(model), label: texts.import.open };
    notices.show("success", texts.import.ready(name), "", opens ? null : link);
    if (opens) navigate(link.href);
  }

  private readonly onDragEnter = (event: DragEvent): void => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    this._dragDepth += 1;
    this._dropping = this.importRefusal === null;
  };
  private readonly onDragOver = (event: DragEvent): void => {
    if (!hasFiles(event)) return;
    // An element of the page may accept the file.
    this._dropping = !event.defaultPrevented && this.importRefusal === null;
    event.preventDefault(); // otherwise the browser would open the file in place of the page
  };
  private readonly onDragLeave = (): void => {
    this._dragDepth = Math.max(0, this._dragDepth - 1);
    if (this._dragDepth === 0) this._dropping = false;
  };
  private readonly onDrop = (event: DragEvent): void => {
    this._dragDepth = 0;
    this._dropping = false;
    if (!hasFiles(event) || event.defaultPrevented) return;
    event.preventDefault();
    const refusal = this.importRefusal;
    if (refusal) notices.show("problem", refusal);
    else if (event.dataTransfer)
      void droppedFiles(event.dataTransfer).then((files) => this.importFiles(files));
  };
}
