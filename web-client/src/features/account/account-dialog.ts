// <strata-account-dialog>: shows a user's names, password, sign-in sessions and tokens for scripts.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { formatList } from "../../core/locale";
import {
  browserOf,
  kLeastPasswordLength,
  passwordMistake,
  rolesOfTokens,
  rolesOfTokensIn,
} from "../../domain/people";
import type { Project, ScriptToken, ScriptTokenMade, SignInSession } from "../../core/protocol.gen";
import { kRoles, type Me, type Role } from "../../core/types";
import "../../ui/made-link";
import { rowList, rowListStyles, type ListedRow } from "../../ui/row-list";
import { ask } from "../../ui/dialog";
import { passwordWords } from "./entry";
import { icon } from "../../ui/icons";
import { passwordField, passwordStyles } from "./password-field";
import { chipStyles, choicesStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { toldDate, toldTime } from "../../domain/times";

const words = texts.account;
const kUsualDays = 365;

type Field = "full_name" | "current" | "password" | "repeat" | "name";
type Section = "name" | "password" | "sessions" | "tokens";

@customElement("strata-account-dialog")
export class StrataAccountDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) me!: Me;
  @state() private _projects: Project[] = []; // the projects that this user can see
  @state() private _sessions: SignInSession[] = [];
  @state() private _tokens: ScriptToken[] | null = null;
  @state() private _made: ScriptTokenMade | null = null;
  @state() private _adding = false;
  @state() private _role: Role = "viewer"; // the role of the new token
  @state() private _only = ""; // the slug of the new token's project; empty for all projects
  @state() private _fieldProblems: Partial<Record<Field, string>> = {};
  @state() private _note: { section: Section; kind: "error" | "done"; text: string } | null = null;
  @state() private _busy = false;
  @query("form.password-change") private _passwordForm!: HTMLFormElement;

  static override styles = [
    sharedStyles,
    chipStyles,
    choicesStyles,
    passwordStyles,
    rowListStyles,
    css`
      section {
        display: grid;
        gap: var(--space-3);
      }
      section + section {
        padding-top: var(--space-4);
        border-top: var(--edge) solid var(--line);
      }
      h3 {
        font-size: var(--text-large);
      }
      form {
        display: grid;
        gap: var(--space-3);
      }
      .beside {
        display: flex;
        align-items: end;
        gap: var(--space-2);
      }
      .beside > label {
        flex: 1;
      }
      form > button {
        justify-self: start;
      }
      .done {
        color: var(--calm);
      }
      .end {
        justify-self: start;
      }
      .choices small {
        display: block;
        margin-top: var(--space-1);
      }
      pre {
        margin: 0;
        padding: var(--space-2) var(--space-3);
        border-radius: var(--radius-small);
        background: var(--surface);
        font: var(--text-tiny)/1.5 var(--mono);
        white-space: pre-wrap;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt("sessions", () =>
      Promise.all([this.readProjects(), this.readSessions(), this.readTokens()]),
    );
  }

  private async readProjects(): Promise<void> {
    this._projects = await this.api.all("GET /projects", "projects");
  }
  private async readSessions(): Promise<void> {
    this._sessions = await this.api.all("GET /me/sessions", "sessions");
  }
  private async readTokens(): Promise<void> {
    this._tokens = await this.api.all("GET /me/tokens", "tokens");
  }

  override render(): TemplateResult {
    const { me } = this;
    const rank = (role: Role | undefined): number => kRoles.indexOf(role ?? "guest");
    // projects with a higher role than the user's role for all projects
    const withMore = this._projects.filter(({ role }) => rank(role) > rank(me.role));
    return html`<strata-dialog wide heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <section>
        <p class="hint">${words.about(me.user, texts.roles[me.role])}</p>
        ${
          withMore.length > 0
            ? html`<p class="caption" id="in_projects">${words.in_projects}</p>
              ${rowList(withMore, (project) => this.projectRow(project), { labelledBy: "in_projects" })}`
            : nothing
        }
        ${this.nameForm(me)} ${this.note("name")}
      </section>
      <section aria-labelledby="password_heading">
        <h3 id="password_heading">${words.password}</h3>
        ${me.has_sign_on && !me.has_password ? html`<p class="hint">${words.by_provider}</p>` : this.passwordForm(me)} ${this.note("password")}
      </section>
      <section aria-labelledby="sessions">
        <h3 id="sessions">${words.sessions}</h3>
        ${rowList(this._sessions, (session) => this.sessionRow(session))}
        ${
          this._sessions.length > 1
            ? html`<button class="end" ?disabled=${this._busy} @click=${() => void this.endOthers()}>${words.sign_out_others}</button>`
            : nothing
        }
        ${this.note("sessions")}
      </section>
      <section aria-labelledby="tokens">
        <h3 id="tokens">${words.tokens}</h3>
        <p class="hint">${words.tokens_lead}</p>
        ${this._made ? this.made(this._made) : nothing}
        ${this._tokens?.length === 0 && !this._adding ? html`<p class="hint">${words.no_tokens}</p>` : nothing}
        ${rowList(this._tokens ?? [], (token) => this.tokenRow(token))}
        ${
          this._adding
            ? this.tokenForm()
            : html`<button class="end" @click=${this.beginToAdd}>${icon("plus")}${words.token_new}</button>`
        }
        ${this.note("tokens")}
      </section>
    </strata-dialog>`;
  }

  private nameForm(me: Me): TemplateResult {
    return html`<form @submit=${this.onName} novalidate>
      <div class="beside">
        <label class="field">
          <span>${words.full_name}</span>
          <input
            type="text"
            name="full_name"
            maxlength="200"
            autocomplete="name"
            .value=${me.full_name}
            aria-invalid=${this._fieldProblems.full_name ? "true" : "false"}
          />
        </label>
        <button ?disabled=${this._busy}>${texts.save}</button>
      </div>
      ${this.mistake("full_name")}
    </form>`;
  }

  private passwordForm(me: Me): TemplateResult {
    const problems = this._fieldProblems;
    return html`<form class="password-change" @submit=${this.onPassword} novalidate>
      <input type="text" name="user" autocomplete="username" hidden .value=${me.user} />
      ${
        me.has_password
          ? passwordField({
              name: "current",
              label: words.current,
              autocomplete: "current-password",
              problem: problems.current ?? "",
            })
          : html`<p class="hint">${words.password_set}</p>`
      }
      ${passwordField({
        name: "password",
        label: words.new,
        autocomplete: "new-password",
        hint: texts.password.hint(kLeastPasswordLength),
        problem: problems.password ?? "",
      })}
      ${passwordField({ name: "repeat", label: words.repeat, autocomplete: "new-password", problem: problems.repeat ?? "" })}
      <button ?disabled=${this._busy}>${me.has_password ? words.password_change : words.password_choose}</button>
    </form>`;
  }

  /** The row includes the groups that give the role, so the user can contact the right person. */
  private projectRow({ name, role, groups }: Project): ListedRow {
    const told = texts.roles[role ?? "guest"];
    const where = groups ? words.role_by_groups(told, formatList(groups)) : told;
    return { name, about: html`<span class="hint">${where}</span>` };
  }

  private sessionRow(session: SignInSession): ListedRow {
    const { browser, system } = browserOf(session.agent);
    const where = words.browser(browser, system);
    const when = session.last_used
      ? words.last_used(toldTime(session.last_used))
      : words.since(toldTime(session.created));
    return {
      name: html`<span title=${session.agent}>${where}</span>`,
      about: html`<span class="hint">${when}</span>`,
      tools: session.current
        ? html`<span class="chip">${words.this_browser}</span>`
        : html`<button ?disabled=${this._busy} aria-label=${words.sign_out_of(where)} @click=${() => void this.endSession(session)}>${words.sign_out}</button>`,
    };
  }

  private tokenRow(token: ScriptToken): ListedRow {
    const expired = token.expires !== undefined && new Date(token.expires) < new Date();
    const until =
      token.expires === undefined
        ? ""
        : (expired ? words.token_expired : words.token_until)(toldDate(token.expires));
    const used =
      token.last_used === undefined
        ? words.token_unused
        : words.token_used(toldTime(token.last_used));
    const where =
      token.project === undefined
        ? ""
        : words.token_only(
            this._projects.find(({ slug }) => slug === token.project)?.name ?? token.project,
          );
    return {
      name: token.name,
      about: html`<span class="hint">${words.token_line(texts.roles[token.role], where, until, used)}</span>`,
      tools: html`<button ?disabled=${this._busy} aria-label=${words.token_revoke(token.name)} @click=${() => void this.revoke(token)}>${words.revoke}</button>`,
    };
  }

  private made({ secret, token }: ScriptTokenMade): TemplateResult {
    return html`<strata-made-link heading=${words.token_made(token.name)} text=${secret}>
      <p class="caption">${words.token_example}</p>
      <pre>curl -H "Authorization: Bearer ${secret}" ${location.origin}/api/v1/models</pre>
    </strata-made-link>`;
  }

  private rolesOfToken(): Role[] {
    const only = this._projects.find(({ slug }) => slug === this._only);
    return only ? rolesOfTokensIn(only.role ?? "guest") : rolesOfTokens(this.me.role);
  }

  private chooseProject(slug: string): void {
    this._only = slug;
    const roles = this.rolesOfToken();
    if (!roles.includes(this._role)) this._role = roles.at(-1) ?? "viewer";
  }

  private tokenForm(): TemplateResult {
    const roles = this.rolesOfToken();
    return html`<form @submit=${this.onToken} novalidate>
      <label class="field">
        <span>${words.token_name}</span>
        <input
          type="text"
          name="name"
          maxlength="200"
          autocomplete="off"
          placeholder=${words.token_name_hint}
          aria-invalid=${this._fieldProblems.name ? "true" : "false"}
        />
      </label>
      ${this.mistake("name")}
      <div class="choices">
        <label class="field">
          <span>${words.token_where}</span>
          <select name="project" @change=${(event: Event) => this.chooseProject((event.target as HTMLSelectElement).value)}>
            <option value="" ?selected=${this._only === ""}>${words.token_everywhere}</option>
            ${this._projects.map(({ slug, name }) => html`<option value=${slug} ?selected=${slug === this._only}>${name}</option>`)}
          </select>
        </label>
        <div>
          <label class="field">
            <span>${words.token_role}</span>
            <select name="role" aria-describedby="role_hint" @change=${(event: Event) => (this._role = (event.target as HTMLSelectElement).value as Role)}>
              ${roles.map((role) => html`<option value=${role} ?selected=${role === this._role}>${texts.roles[role]}</option>`)}
            </select>
          </label>
          <small class="hint" id="role_hint">${texts.role_hints[this._role]}</small>
        </div>
        <label class="field">
          <span>${words.token_days}</span>
          <select name="days">
            ${words.token_day_choices.map(([days, told]) => html`<option value=${days} ?selected=${days === kUsualDays}>${told}</option>`)}
          </select>
        </label>
      </div>
      <div class="row">
        <button class="primary" ?disabled=${this._busy}>${words.token_make}</button>
        <button type="button" class="quiet" @click=${() => (this._adding = false)}>${texts.cancel}</button>
      </div>
    </form>`;
  }

  private note(section: Section): TemplateResult | typeof nothing {
    const note = this._note;
    if (note?.section !== section) return nothing;
    return html`<p class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</p>`;
  }

  private mistake(field: Field): TemplateResult {
    const problem = this._fieldProblems[field] ?? "";
    return html`<p class="error" role="alert" ?hidden=${!problem}>${problem}</p>`;
  }

  private refuse(field: Field, problem: string): void {
    this._fieldProblems = { [field]: problem };
    this.renderRoot.querySelector<HTMLInputElement>(`input[name=${field}]`)?.focus();
  }

  private onName(event: Event): void {
    event.preventDefault();
    const fullName = textOf(event, "full_name").trim();
    void this.attempt("name", async () => {
      this.changed(await this.api.json("PATCH /me", { body: { full_name: fullName } }));
      this._note = { section: "name", kind: "done", text: words.full_name_saved };
    });
  }

  private onPassword(event: Event): void {
    event.preventDefault();
    const { me } = this;
    const current = textOf(event, "current");
    const password = textOf(event, "password");
    const mistake = passwordMistake(me.user, password, textOf(event, "repeat"));
    if (me.has_password && current === "") this.refuse("current", words.current_missing);
    else if (mistake) this.refuse(mistake.field, passwordWords(mistake));
    else
      void this.attempt("password", () =>
        this.setPassword({ password, ...(me.has_password ? { current } : {}) }),
      );
  }

  private async setPassword(change: { password: string; current?: string }): Promise<void> {
    await this.api.send("POST /me/password", { body: change });
    this._passwordForm.reset();
    this.changed({ ...this.me, has_password: true });
    this._note = { section: "password", kind: "done", text: words.password_saved };
    await this.readSessions();
  }

  private beginToAdd(): void {
    this._adding = true;
    this._role = "viewer";
    this._only = "";
    this._made = null;
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector<HTMLInputElement>("input[name=name]")?.focus(),
    );
  }

  private onToken(event: Event): void {
    event.preventDefault();
    const name = textOf(event, "name").trim();
    const [role, only, days] = [this._role, this._only, Number(textOf(event, "days"))];
    if (name === "") {
      this.refuse("name", words.token_name_missing);
      return;
    }
    void this.attempt("tokens", async () => {
      this._made = await this.api.json("POST /me/tokens", {
        body: {
          name,
          role,
          days,
          ...(only ? { project: only } : {}),
        },
      });
      this._adding = false;
      await this.readTokens();
    });
  }

  private async endSession({ id }: SignInSession): Promise<void> {
    await this.attempt("sessions", async () => {
      await this.api
        .send("DELETE /me/sessions/{session}", { path: { session: id } })
        .catch(unlessGone);
      await this.readSessions();
    });
  }

  private async endOthers(): Promise<void> {
    await this.attempt("sessions", async () => {
      await this.api.send("DELETE /me/sessions");
      await this.readSessions();
      this._note = { section: "sessions", kind: "done", text: words.signed_out_others };
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
      await this.api.send("DELETE /me/tokens/{token}", { path: { token: id } }).catch(unlessGone);
      if (this._made?.token.id === id) this._made = null;
      await this.readTokens();
    });
  }

  private changed(me: Me): void {
    this.dispatchEvent(new CustomEvent<Me>("changed", { detail: me }));
  }

  private async attempt(section: Section, task: () => Promise<unknown>): Promise<void> {
    this._busy = true;
    this._note = null;
    this._fieldProblems = {};
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refused(section, error);
    } finally {
      this._busy = false;
    }
  }

  private refused(section: Section, error: ApiError): void {
    const { field } = error.problem;
    if (field === "full_name" || field === "current" || field === "password" || field === "name")
      this.refuse(field, error.message);
    else if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
    else this._note = { section, kind: "error", text: error.message };
  }
}

const textOf = (event: Event, name: string): string =>
  String(new FormData(event.target as HTMLFormElement).get(name) ?? "");

/** Ignores a 404, because the session or token has already ended. */
function unlessGone(error: unknown): void {
  if (!(error instanceof ApiError) || error.status !== 404) throw error;
}
