// <strata-account-dialog>: what somebody is called, their password, where they are signed in, and
// their tokens for scripts.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError, type Api } from "../../net/api";
import { format_list } from "../../core/locale";
import {
  browser_of,
  kLeastPasswordLength,
  password_mistake,
  roles_of_tokens,
  roles_of_tokens_in,
} from "../../domain/people";
import type { Project, ScriptToken, ScriptTokenMade, SignInSession } from "../../core/protocol.gen";
import { kRoles, type Me, type Role } from "../../core/types";
import "../../ui/copy-field";
import { ask } from "../../ui/dialog";
import { password_words } from "./entry";
import { icon } from "../../ui/icons";
import { password_field, password_styles } from "./password-field";
import { chip_styles, choices_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import { told_date, told_time } from "../../domain/times";

const words = texts.account;
const kUsualDays = 365;

type Field = "full_name" | "current" | "password" | "repeat" | "name";
type Section = "name" | "password" | "sessions" | "tokens";

@customElement("strata-account-dialog")
export class StrataAccountDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @state() private projects_: Project[] = []; // that they see
  @state() private sessions_: SignInSession[] = [];
  @state() private tokens_: ScriptToken[] | null = null;
  @state() private made_: ScriptTokenMade | null = null;
  @state() private adding_ = false;
  @state() private role_: Role = "viewer"; // of the token that is added
  @state() private only_ = ""; // slug of the project that it is for; empty: all
  @state() private field_problems_: Partial<Record<Field, string>> = {};
  @state() private note_: { section: Section; kind: "error" | "done"; text: string } | null = null;
  @state() private busy_ = false;
  @query("form.password-change") private password_form_!: HTMLFormElement;

  static override styles = [
    shared_styles,
    chip_styles,
    choices_styles,
    password_styles,
    css`
      section {
        display: grid;
        gap: 0.75rem;
      }
      section + section {
        padding-top: 1.125rem;
        border-top: var(--edge) solid var(--line);
      }
      h3 {
        font-size: 1rem;
      }
      form {
        display: grid;
        gap: 0.75rem;
      }
      .beside {
        display: flex;
        align-items: end;
        gap: 0.625rem;
      }
      .beside > label {
        flex: 1;
      }
      form > button {
        justify-self: start;
      }
      ul {
        display: grid;
        margin: 0;
        padding: 0;
        list-style: none;
      }
      ul:empty {
        display: none;
      }
      li {
        display: flex;
        align-items: center;
        gap: 0.75rem;
        padding: 0.4375rem 0;
      }
      li + li {
        border-top: var(--edge) solid var(--line);
      }
      li b {
        font-weight: 600;
        overflow-wrap: anywhere;
      }
      li .hint {
        display: block;
      }
      .done {
        color: var(--calm);
      }
      .end {
        justify-self: start;
      }
      .choices small {
        display: block;
        margin-top: 5px;
      }
      .made {
        display: grid;
        gap: 0.625rem;
        padding: 0.875rem;
        border-radius: var(--radius);
        background: var(--calm-soft);
      }
      .made p {
        overflow-wrap: anywhere;
      }
      pre {
        margin: 0;
        padding: 0.5625rem 0.6875rem;
        border-radius: var(--radius-small);
        background: var(--surface);
        font: 0.8rem/1.5 var(--mono);
        white-space: pre-wrap;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt("sessions", () =>
      Promise.all([this.read_projects(), this.read_sessions(), this.read_tokens()]),
    );
  }

  private async read_projects(): Promise<void> {
    this.projects_ = await this.api.projects();
  }
  private async read_sessions(): Promise<void> {
    this.sessions_ = await this.api.sign_in_sessions();
  }
  private async read_tokens(): Promise<void> {
    this.tokens_ = await this.api.script_tokens();
  }

  override render(): TemplateResult {
    const { me } = this;
    const rank = (role: Role | undefined): number => kRoles.indexOf(role ?? "guest");
    // than everywhere
    const with_more = this.projects_.filter(({ role }) => rank(role) > rank(me.role));
    return html`<strata-dialog wide heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <section>
        <p class="hint">${words.about(me.user, texts.roles[me.role])}</p>
        ${
          with_more.length > 0
            ? html`<p class="caption" id="in_projects">${words.in_projects}</p>
              <ul aria-labelledby="in_projects">
              ${with_more.map((project) => this.project_row(project))}
            </ul>`
            : nothing
        }
        ${this.name_form(me)} ${this.note("name")}
      </section>
      <section aria-labelledby="password_heading">
        <h3 id="password_heading">${words.password}</h3>
        ${this.password_form(me)} ${this.note("password")}
      </section>
      <section aria-labelledby="sessions">
        <h3 id="sessions">${words.sessions}</h3>
        <ul>
          ${repeat(
            this.sessions_,
            ({ id }) => id,
            (session) => this.session_row(session),
          )}
        </ul>
        ${
          this.sessions_.length > 1
            ? html`<button class="end" ?disabled=${this.busy_} @click=${() => void this.end_others()}>${words.sign_out_others}</button>`
            : nothing
        }
        ${this.note("sessions")}
      </section>
      <section aria-labelledby="tokens">
        <h3 id="tokens">${words.tokens}</h3>
        <p class="hint">${words.tokens_lead}</p>
        ${this.made_ ? this.made(this.made_) : nothing}
        ${this.tokens_?.length === 0 && !this.adding_ ? html`<p class="hint">${words.no_tokens}</p>` : nothing}
        <ul>
          ${repeat(
            this.tokens_ ?? [],
            ({ id }) => id,
            (token) => this.token_row(token),
          )}
        </ul>
        ${
          this.adding_
            ? this.token_form()
            : html`<button class="end" @click=${this.begin_to_add}>${icon("plus")}${words.token_new}</button>`
        }
        ${this.note("tokens")}
      </section>
    </strata-dialog>`;
  }

  private name_form(me: Me): TemplateResult {
    return html`<form @submit=${this.on_name} novalidate>
      <div class="beside">
        <label class="field">
          <span>${words.full_name}</span>
          <input
            type="text"
            name="full_name"
            maxlength="200"
            autocomplete="name"
            .value=${me.full_name}
            aria-invalid=${this.field_problems_.full_name ? "true" : "false"}
          />
        </label>
        <button ?disabled=${this.busy_}>${texts.save}</button>
      </div>
      ${this.mistake("full_name")}
    </form>`;
  }

  private password_form(me: Me): TemplateResult {
    const problems = this.field_problems_;
    return html`<form class="password-change" @submit=${this.on_password} novalidate>
      <input type="text" name="user" autocomplete="username" hidden .value=${me.user} />
      ${
        me.has_password
          ? password_field({
              name: "current",
              label: words.current,
              autocomplete: "current-password",
              problem: problems.current ?? "",
            })
          : html`<p class="hint">${words.password_set}</p>`
      }
      ${password_field({
        name: "password",
        label: words.new,
        autocomplete: "new-password",
        hint: texts.password.hint(kLeastPasswordLength),
        problem: problems.password ?? "",
      })}
      ${password_field({ name: "repeat", label: words.repeat, autocomplete: "new-password", problem: problems.repeat ?? "" })}
      <button ?disabled=${this.busy_}>${me.has_password ? words.password_change : words.password_choose}</button>
    </form>`;
  }

  /** Where a role comes from, too, so that they know whom to ask. */
  private project_row({ name, role, groups }: Project): TemplateResult {
    const told = texts.roles[role ?? "guest"];
    return html`<li>
      <div class="grow"><b>${name}</b> <span class="hint">${groups ? words.role_by_groups(told, format_list(groups)) : told}</span></div>
    </li>`;
  }

  private session_row(session: SignInSession): TemplateResult {
    const { browser, system } = browser_of(session.agent);
    const where = words.browser(browser, system);
    const when = session.last_used
      ? words.last_used(told_time(session.last_used))
      : words.since(told_time(session.created));
    return html`<li>
      <div class="grow"><b title=${session.agent}>${where}</b> <span class="hint">${when}</span></div>
      ${
        session.current
          ? html`<span class="chip">${words.this_browser}</span>`
          : html`<button ?disabled=${this.busy_} aria-label=${words.sign_out_of(where)} @click=${() => void this.end_session(session)}>${words.sign_out}</button>`
      }
    </li>`;
  }

  private token_row(token: ScriptToken): TemplateResult {
    const expired = token.expires !== undefined && new Date(token.expires) < new Date();
    const until =
      token.expires === undefined
        ? ""
        : (expired ? words.token_expired : words.token_until)(told_date(token.expires));
    const used =
      token.last_used === undefined
        ? words.token_unused
        : words.token_used(told_time(token.last_used));
    const where =
      token.project === undefined
        ? ""
        : words.token_only(
            this.projects_.find(({ slug }) => slug === token.project)?.name ?? token.project,
          );
    return html`<li>
      <div class="grow"><b>${token.name}</b> <span class="hint">${words.token_line(texts.roles[token.role], where, until, used)}</span></div>
      <button ?disabled=${this.busy_} aria-label=${words.token_revoke(token.name)} @click=${() => void this.revoke(token)}>${words.revoke}</button>
    </li>`;
  }

  private made({ secret, token }: ScriptTokenMade): TemplateResult {
    return html`<div class="made" role="status">
      <p>${words.token_made(token.name)}</p>
      <strata-copy-field follows_form label=${words.token_made(token.name)} .text=${secret}></strata-copy-field>
      <p class="caption">${words.token_example}</p>
      <pre>curl -H "Authorization: Bearer ${secret}" ${location.origin}/api/v1/models</pre>
    </div>`;
  }

  private roles_of_token(): Role[] {
    const only = this.projects_.find(({ slug }) => slug === this.only_);
    return only ? roles_of_tokens_in(only.role ?? "guest") : roles_of_tokens(this.me.role);
  }

  private choose_project(slug: string): void {
    this.only_ = slug;
    const roles = this.roles_of_token();
    if (!roles.includes(this.role_)) this.role_ = roles.at(-1) ?? "viewer";
  }

  private token_form(): TemplateResult {
    const roles = this.roles_of_token();
    return html`<form @submit=${this.on_token} novalidate>
      <label class="field">
        <span>${words.token_name}</span>
        <input
          type="text"
          name="name"
          maxlength="200"
          autocomplete="off"
          placeholder=${words.token_name_hint}
          aria-invalid=${this.field_problems_.name ? "true" : "false"}
        />
      </label>
      ${this.mistake("name")}
      <div class="choices">
        <label class="field">
          <span>${words.token_where}</span>
          <select name="project" @change=${(event: Event) => this.choose_project((event.target as HTMLSelectElement).value)}>
            <option value="" ?selected=${this.only_ === ""}>${words.token_everywhere}</option>
            ${this.projects_.map(({ slug, name }) => html`<option value=${slug} ?selected=${slug === this.only_}>${name}</option>`)}
          </select>
        </label>
        <div>
          <label class="field">
            <span>${words.token_role}</span>
            <select name="role" aria-describedby="role_hint" @change=${(event: Event) => (this.role_ = (event.target as HTMLSelectElement).value as Role)}>
              ${roles.map((role) => html`<option value=${role} ?selected=${role === this.role_}>${texts.roles[role]}</option>`)}
            </select>
          </label>
          <small class="hint" id="role_hint">${texts.role_hints[this.role_]}</small>
        </div>
        <label class="field">
          <span>${words.token_days}</span>
          <select name="days">
            ${words.token_day_choices.map(([days, told]) => html`<option value=${days} ?selected=${days === kUsualDays}>${told}</option>`)}
          </select>
        </label>
      </div>
      <div class="row">
        <button class="primary" ?disabled=${this.busy_}>${words.token_make}</button>
        <button type="button" class="quiet" @click=${() => (this.adding_ = false)}>${texts.cancel}</button>
      </div>
    </form>`;
  }

  private note(section: Section): TemplateResult | typeof nothing {
    const note = this.note_;
    if (note?.section !== section) return nothing;
    return html`<p class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</p>`;
  }

  private mistake(field: Field): TemplateResult {
    const problem = this.field_problems_[field] ?? "";
    return html`<p class="error" role="alert" ?hidden=${!problem}>${problem}</p>`;
  }

  private refuse(field: Field, problem: string): void {
    this.field_problems_ = { [field]: problem };
    this.renderRoot.querySelector<HTMLInputElement>(`input[name=${field}]`)?.focus();
  }

  private on_name(event: Event): void {
    event.preventDefault();
    const full_name = text_of(event, "full_name").trim();
    void this.attempt("name", async () => {
      this.changed(await this.api.change_me({ full_name }));
      this.note_ = { section: "name", kind: "done", text: words.full_name_saved };
    });
  }

  private on_password(event: Event): void {
    event.preventDefault();
    const { me } = this;
    const current = text_of(event, "current");
    const password = text_of(event, "password");
    const mistake = password_mistake(me.user, password, text_of(event, "repeat"));
    if (me.has_password && current === "") this.refuse("current", words.current_missing);
    else if (mistake) this.refuse(mistake.field, password_words(mistake));
    else
      void this.attempt("password", () =>
        this.set_password({ password, ...(me.has_password ? { current } : {}) }),
      );
  }

  private async set_password(change: { password: string; current?: string }): Promise<void> {
    await this.api.change_password(change);
    this.password_form_.reset();
    this.changed({ ...this.me, has_password: true });
    this.note_ = { section: "password", kind: "done", text: words.password_saved };
    await this.read_sessions();
  }

  private begin_to_add(): void {
    this.adding_ = true;
    this.role_ = "viewer";
    this.only_ = "";
    this.made_ = null;
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector<HTMLInputElement>("input[name=name]")?.focus(),
    );
  }

  private on_token(event: Event): void {
    event.preventDefault();
    const name = text_of(event, "name").trim();
    const [role, only, days] = [this.role_, this.only_, Number(text_of(event, "days"))];
    if (name === "") {
      this.refuse("name", words.token_name_missing);
      return;
    }
    void this.attempt("tokens", async () => {
      this.made_ = await this.api.create_token({
        name,
        role,
        days,
        ...(only ? { project: only } : {}),
      });
      this.adding_ = false;
      await this.read_tokens();
    });
  }

  private async end_session({ id }: SignInSession): Promise<void> {
    await this.attempt("sessions", async () => {
      await this.api.end_session(id).catch(unless_gone);
      await this.read_sessions();
    });
  }

  private async end_others(): Promise<void> {
    await this.attempt("sessions", async () => {
      await this.api.end_other_sessions();
      await this.read_sessions();
      this.note_ = { section: "sessions", kind: "done", text: words.signed_out_others };
    });
  }

  private async revoke({ id, name }: ScriptToken): Promise<void> {
    if (
      !(await ask({
        heading: words.token_revoke_title(name),
        lead: words.token_revoke_lead,
        yes: words.revoke,
        danger: true,
      }))
    )
      return;
    await this.attempt("tokens", async () => {
      await this.api.revoke_token(id).catch(unless_gone);
      if (this.made_?.token.id === id) this.made_ = null;
      await this.read_tokens();
    });
  }

  private changed(me: Me): void {
    this.dispatchEvent(new CustomEvent<Me>("changed", { detail: me }));
  }

  private async attempt(section: Section, task: () => Promise<unknown>): Promise<void> {
    this.busy_ = true;
    this.note_ = null;
    this.field_problems_ = {};
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refused(section, error);
    } finally {
      this.busy_ = false;
    }
  }

  private refused(section: Section, error: ApiError): void {
    const { field } = error.problem;
    if (field === "full_name" || field === "current" || field === "password" || field === "name")
      this.refuse(field, error.message);
    else if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
    else this.note_ = { section, kind: "error", text: error.message };
  }
}

const text_of = (event: Event, name: string): string =>
  String(new FormData(event.target as HTMLFormElement).get(name) ?? "");

/** What was to be ended has ended by itself. */
function unless_gone(error: unknown): void {
  if (!(error instanceof ApiError) || error.status !== 404) throw error;
}
