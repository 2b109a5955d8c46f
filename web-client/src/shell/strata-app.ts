// <strata-app>: who is signed in, which page the address names, and what all pages share: scans
// dropped anywhere, and changes that still wait to be saved.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { keyed } from "lit/directives/keyed.js";
import { Api, ApiError } from "../net/api";
import type { Project } from "../core/protocol.gen";
import type { Me } from "../core/types";
import type { AccountRequest } from "../ui/account-menu";
import "../ui/status-page";
import { ask } from "../ui/dialog";
import { invitation_of } from "../features/account/entry";
import { icon } from "../ui/icons";
import { dropped_files, has_files, without_folders, type DroppedFile } from "../ui/drop";
import {
  choose_scans,
  Imports,
  type ImportEntry,
  type ImportResult,
  type Scan,
} from "../features/home/imports";
import { notices } from "../ui/notices";
import "./notices-view";
import { has_part, load_part_later, set_part_loads } from "./page-parts";
import { curates, kDefaultProject } from "../features/home/project-list";
import {
  may_leave_page,
  navigate,
  on_navigate,
  path_now,
  path_of_model,
  replace_address,
  route_of,
  type Route,
} from "../ui/routes";
import {
  check_connections,
  discard_unsaved,
  keep_views,
  unsaved_changes,
} from "../session/sessions";
import { shared_styles } from "../ui/styles";
import { texts } from "../texts";

set_part_loads({
  home: () => import("../features/home/home-page"),
  model: () => import("./model-page"),
  model_dialogs: () => import("./model-dialogs"),
  join: () => import("../features/account/join-page"),
  sign_in: () => import("../features/account/sign-in"),
  account: () => import("../features/account/account-dialog"),
  people: () => import("../features/account/people-dialog"),
  kiosks: () => import("../features/account/kiosks-dialog"),
  preferences: () => import("../features/account/preferences-fields"),
});

@customElement("strata-app")
export class StrataApp extends LitElement {
  private readonly api_ = new Api();
  private readonly imports_ = new Imports(this.api_);
  @state() private route_: Route = route_of(path_now());
  @state() private me_: Me | null = null;
  @state() private projects_: readonly Project[] = [];
  @state() private chosen_project_ = ""; // for imports
  @state() private session_: "unknown" | "signed-in" | "signed-out" | "unreachable" = "unknown";
  @state() private problem_ = "";
  @state() private dialog_: "account" | "people" | "kiosks" | "preferences" | null = null;
  @state() private dropping_ = false;
  @state() private imported_ = 0;
  private drag_depth_ = 0;

  static override styles = [
    shared_styles,
    css`
      .drop-target {
        position: fixed;
        inset: 0;
        z-index: 40;
        display: grid;
        padding: 20px;
        background: var(--drop);
        pointer-events: none;
      }
      .drop-target > div {
        display: grid;
        place-content: center;
        justify-items: center;
        gap: 6px;
        border: 2px dashed var(--accent);
        border-radius: 18px;
        color: var(--accent);
      }
      .drop-target b {
        font: 600 1.6rem var(--serif);
      }
      .drop-target svg.glyph {
        width: 44px;
        height: 44px;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    on_navigate(() => (this.route_ = route_of(path_now())));
    addEventListener("unhandledrejection", (event) => notices.error(event.reason));
    addEventListener("online", check_connections);
    document.addEventListener("visibilitychange", () => {
      if (document.visibilityState !== "visible") return keep_views();
      check_connections();
      void this.refresh_me();
    });
    addEventListener("pagehide", keep_views);
    addEventListener("beforeunload", (event) => {
      if (unsaved_changes() > 0) event.preventDefault();
    });
    addEventListener("dragenter", this.on_drag_enter);
    addEventListener("dragover", this.on_drag_over);
    addEventListener("dragleave", this.on_drag_leave);
    addEventListener("drop", this.on_drop);
    void this.check_session();
  }

  private async check_session(): Promise<void> {
    try {
      await this.take_me(await this.api_.me());
      this.session_ = "signed-in";
      check_connections();
    } catch (error) {
      if (error instanceof ApiError && error.status === 401) {
        this.session_ = "signed-out";
        return;
      }
      this.session_ = "unreachable";
      this.problem_ = error instanceof Error ? error.message : "";
      setTimeout(() => void this.check_session(), 3000);
    }
  }

  private async take_me(me: Me): Promise<void> {
    const lost = this.me_ && this.me_.user !== me.user ? discard_unsaved() : 0;
    if (lost > 0) notices.show("problem", texts.saving.discarded(lost));
    this.projects_ = await this.api_.projects();
    this.me_ = me;
  }

  /** Others may have changed what this person may do, or signed them out. */
  private readonly refresh_me = async (): Promise<void> => {
    if (this.session_ !== "signed-in") return;
    try {
      await this.take_me(await this.api_.me());
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.signed_out(); // anything else is told where it matters
    }
  };

  /**
   * `next`: where what was changed is seen. It is gone to with nothing to come back to from there
   * where the place itself is gone.
   */
  private async take_projects(next: string | null): Promise<void> {
    await this.refresh_me();
    if (next === null || next === path_now()) return;
    if (next === "/") replace_address(next);
    else navigate(next);
  }

  private readonly signed_out = (): void => {
    this.session_ = "signed-out";
    this.dialog_ = null;
  };

  private async on_account({ detail }: CustomEvent<AccountRequest>): Promise<void> {
    if (detail === "sign-out") await this.sign_out();
    else this.dialog_ = detail;
  }

  private async sign_out(): Promise<void> {
    if (!(await may_leave_page())) return;
    const lost = unsaved_changes();
    const words = texts.account;
    const question = {
      heading: words.sign_out_title,
      lead: words.sign_out_lead(lost),
      yes: words.sign_out,
    };
    if (lost > 0 && !(await ask({ ...question, danger: true }))) return;
    try {
      await this.api_.logout();
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 401) {
        notices.error(error); // nobody must think that they are signed out while they are not
        return;
      }
    }
    discard_unsaved();
    this.signed_out();
  }

  override render(): TemplateResult {
    return html`${this.page()} ${this.session_ === "signed-in" && this.me_ ? this.dialog(this.me_) : nothing}
      ${
        this.dropping_
          ? html`<div class="drop-target">
            <div>${icon("upload")}<b>${texts.home.drop_title}</b><span>${texts.home.drop_lead}</span></div>
          </div>`
          : nothing
      }
      <strata-notices></strata-notices>`;
  }

  private page(): unknown {
    const { session_: session, me_: me } = this;
    if (session === "unknown") return nothing;
    if (session === "unreachable")
      return html`<strata-blank heading=${texts.connection.lost} lead=${this.problem_}></strata-blank>`;
    if (this.route_.page === "join") return this.join_page(session === "signed-in" ? me : null);
    if (session === "signed-out" || !me) {
      if (!has_part("sign_in", this)) return nothing;
      return html`<strata-sign-in .api=${this.api_} @signed-in=${() => void this.check_session()}></strata-sign-in>`;
    }
    const is_model = this.route_.page === "model";
    if (!has_part(is_model ? "model" : "home", this)) return nothing;
    if (!is_model) load_part_later("model"); // most people open one
    return this.route_.page === "model"
      ? keyed(
          this.route_.model, // everything of a model page belongs to its one model
          html`<strata-model-page
            .api=${this.api_}
            .me=${me}
            .model_id=${this.route_.model}
            .projects=${this.projects_}
            @account=${this.on_account}
            @role-changed=${this.refresh_me}
            @signed-out=${this.signed_out}
          ></strata-model-page>`,
        )
      : html`<strata-home-page
          .api=${this.api_}
          .me=${me}
          .projects=${this.projects_}
          .project=${this.route_.project}
          .curated=${this.curated}
          .into=${this.into}
          .imports=${this.imports_}
          @repeat-import=${this.repeat_import}
          .imported=${this.imported_}
          @account=${this.on_account}
          @signed-out=${this.signed_out}
          @choose-project=${({ detail }: CustomEvent<string>) => (this.chosen_project_ = detail)}
          @projects-changed=${({ detail }: CustomEvent<string | null>) => void this.take_projects(detail)}
          @import-files=${(event: CustomEvent<File[]>) => void this.import_files(without_folders(event.detail))}
        ></strata-home-page>`;
  }

  private join_page(me: Me | null): unknown {
    if (!has_part("join", this)) return nothing;
    const invitation = invitation_of(location.hash);
    return keyed(
      invitation,
      html`<strata-join-page
        .api=${this.api_}
        .invitation=${invitation}
        .me=${me}
        @sign-out=${this.sign_out}
        @joined=${() => {
          replace_address("/"); // the secret is used up, and none of the history's business
          void this.check_session();
        }}
      ></strata-join-page>`,
    );
  }

  private dialog(me: Me): unknown {
    const closed = (): void => {
      this.dialog_ = null;
    };
    if (this.dialog_ && !has_part(this.dialog_, this)) return nothing;
    if (this.dialog_ === "account") {
      return html`<strata-account-dialog
        .api=${this.api_}
        .me=${me}
        @changed=${(event: CustomEvent<Me>) => void this.take_me(event.detail)}
        @closed=${closed}
        @signed-out=${this.signed_out}
      ></strata-account-dialog>`;
    }
    if (this.dialog_ === "people") {
      return html`<strata-people-dialog .api=${this.api_} .me=${me} @closed=${closed} @signed-out=${this.signed_out}></strata-people-dialog>`;
    }
    if (this.dialog_ === "kiosks") {
      return html`<strata-kiosks-dialog .api=${this.api_} @closed=${closed} @signed-out=${this.signed_out}></strata-kiosks-dialog>`;
    }
    if (this.dialog_ === "preferences")
      return html`<strata-preferences-dialog @closed=${closed}></strata-preferences-dialog>`;
    return nothing;
  }

  private get import_refusal(): string | null {
    if (this.session_ !== "signed-in" || !this.me_) return texts.import.sign_in_first;
    return this.into ? null : texts.import.not_allowed;
  }

  /** Where they may import scans. */
  private get curated(): readonly Project[] {
    return this.projects_.filter(curates);
  }
  /**
   * The project that scans are imported into, which is the one that is looked at; null: they may
   * not import.
   */
  private get into(): Project | null {
    const by_slug = (slug: string): Project | undefined =>
      this.curated.find((project) => project.slug === slug);
    const { route_: route } = this;
    if (route.page === "home" && route.project !== null) return by_slug(route.project) ?? null;
    return by_slug(this.chosen_project_) ?? by_slug(kDefaultProject) ?? this.curated[0] ?? null;
  }

  private async import_files(dropped: readonly DroppedFile[]): Promise<void> {
    const scans = choose_scans(dropped);
    if (this.route_.page !== "home" && scans.length > 0) {
      notices.show("info", texts.import.started, "", { href: "/", label: texts.import.watch });
    }
    await Promise.all(scans.map((scan) => this.import_scan(scan, scans.length === 1)));
  }

  private async import_scan(scan: Scan, alone: boolean): Promise<void> {
    const { into } = this;
    if (into) await this.take_import(this.imports_.start(scan, into.slug), scan.name, alone);
  }

  private readonly repeat_import = ({ detail }: CustomEvent<ImportEntry>): void => {
    void this.take_import(
      this.imports_.repeat(detail.key),
      detail.name,
      this.imports_.entries.length === 1,
    );
  };

  private async take_import(
    ending: Promise<ImportResult>,
    name: string,
    alone: boolean,
  ): Promise<void> {
    const { model, problem } = await ending;
    this.imported_ += 1;
    if (problem && this.route_.page !== "home") notices.problem(problem); // the home page lists it
    if (model === null) return;
    // a person at work on another model is not carried off
    const opens = alone && this.route_.page === "home";
    const link = { href: path_of_model(model), label: texts.import.open };
    notices.show("success", texts.import.ready(name), "", opens ? null : link);
    if (opens) navigate(link.href);
  }

  private readonly on_drag_enter = (event: DragEvent): void => {
    if (!has_files(event)) return;
    event.preventDefault();
    this.drag_depth_ += 1;
    this.dropping_ = this.import_refusal === null;
  };
  private readonly on_drag_over = (event: DragEvent): void => {
    if (!has_files(event)) return;
    // something on the page may take the file itself
    this.dropping_ = !event.defaultPrevented && this.import_refusal === null;
    event.preventDefault(); // else the browser opens the file in place of the page
  };
  private readonly on_drag_leave = (): void => {
    this.drag_depth_ = Math.max(0, this.drag_depth_ - 1);
    if (this.drag_depth_ === 0) this.dropping_ = false;
  };
  private readonly on_drop = (event: DragEvent): void => {
    this.drag_depth_ = 0;
    this.dropping_ = false;
    if (!has_files(event) || event.defaultPrevented) return;
    event.preventDefault();
    const refusal = this.import_refusal;
    if (refusal) notices.show("problem", refusal);
    else if (event.dataTransfer)
      void dropped_files(event.dataTransfer).then((files) => this.import_files(files));
  };
}
