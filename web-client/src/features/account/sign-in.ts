// <strata-sign-in>: sign-in with a user name and a password, with an OpenID Connect provider, with a
// token, or with the link that the server printed.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import type { SignInWays } from "../../core/protocol.gen";
import { loginPathOf, signInProblem } from "./entry";
import { entryStyles } from "./entry-styles";
import { icon, logo } from "../../ui/icons";
import { passwordField, passwordStyles } from "./password-field";
import "./preferences-fields";
import { sharedStyles } from "../../ui/styles";
import { signOnAddress, signOnProblem, withoutProblem } from "./sign-on";
import { texts } from "../../texts";

@customElement("strata-sign-in")
export class StrataSignIn extends LitElement {
  @property({ attribute: false }) api!: Api;
  // null while the page loads them from the server
  @state() private _ways: SignInWays | null = null;
  @state() private _signOnProblem = "";
  @state() private _problem = "";
  @state() private _tokenProblem = "";
  @state() private _busy = false;
  @query("input[name=user]") private _user!: HTMLInputElement | null;
  @query("input[name=password]") private _password!: HTMLInputElement;
  @query("input[name=token]") private _token!: HTMLInputElement;

  static override styles = [
    sharedStyles,
    entryStyles,
    passwordStyles,
    css`
      .ways {
        display: grid;
        gap: var(--space-3);
      }
      .ways .button {
        padding-block: var(--space-2);
        overflow-wrap: anywhere;
        white-space: normal;
      }
      .ways + form {
        padding-top: var(--space-4);
        border-top: var(--edge) solid var(--line);
      }
      details {
        padding-top: var(--space-4);
        border-top: var(--edge) solid var(--line);
      }
      summary {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        color: var(--ink-soft);
        cursor: pointer;
        list-style: none;
      }
      summary::-webkit-details-marker {
        display: none;
      }
      summary svg.glyph {
        width: 16px;
        height: 16px;
      }
      details[open] summary svg.glyph {
        transform: rotate(90deg);
      }
      details form {
        margin-top: var(--space-3);
        gap: var(--space-3);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._signOnProblem = signOnProblem(location.search);
    // A reload must not show the problem again.
    const search = withoutProblem(location.search);
    if (search !== location.search)
      history.replaceState(history.state, "", location.pathname + search + location.hash);
    void this.readWays();
  }

  private async readWays(): Promise<void> {
    try {
      this._ways = await this.api.json("GET /sign-in/providers");
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._ways = { providers: [], local_accounts: true };
    }
    await this.updateComplete;
    this._user?.focus();
  }

  override render(): TemplateResult {
    const words = texts.sign_in;
    return html`<main class="card">
      <div class="brand">
        ${logo()}
        <div><b>${texts.product}</b><span>${texts.tagline}</span></div>
      </div>
      <h1>${words.title}</h1>
      <p class="error" role="alert" ?hidden=${!this._signOnProblem}>${this._signOnProblem}</p>
      ${this._ways ? [this.providers(this._ways), this._ways.local_accounts ? this.passwordForm() : nothing] : nothing}
      <details>
        <summary>${icon("chevron")}${words.otherwise}</summary>
        <form @submit=${this.onToken} novalidate>
          <p class="hint">${words.otherwise_lead}</p>
          <label class="field">
            <span>${words.token}</span>
            <input
              type="password"
              name="token"
              autocomplete="off"
              aria-invalid=${this._tokenProblem ? "true" : "false"}
              aria-describedby="token_problem"
            />
          </label>
          <p class="error" id="token_problem" role="alert" ?hidden=${!this._tokenProblem}>${this._tokenProblem}</p>
          <button ?disabled=${this._busy}>${words.button}</button>
          <p class="hint">${words.token_hint} <code>${location.origin}/login?link=…</code></p>
        </form>
      </details>
      <strata-preferences></strata-preferences>
    </main>`;
  }

  private providers({ providers }: SignInWays): unknown {
    if (providers.length === 0) return nothing;
    const here = location.pathname + location.search + location.hash;
    return html`<div class="ways">
      ${providers.map(
        ({ id, name }) =>
          html`<a class="button" href=${signOnAddress(id, here)}>${texts.sign_in.with_provider(name)}</a>`,
      )}
    </div>`;
  }

  private passwordForm(): TemplateResult {
    const words = texts.sign_in;
    return html`<form @submit=${this.onSubmit} novalidate>
        <label class="field">
          <span>${words.user}</span>
          <input
            type="text"
            name="user"
            maxlength="200"
            autocomplete="username"
            autocapitalize="off"
            spellcheck="false"
            aria-invalid=${this._problem ? "true" : "false"}
            aria-describedby="problem"
          />
        </label>
        ${passwordField({ name: "password", label: words.password, autocomplete: "current-password", wrongBy: this._problem ? "problem" : "" })}
        <p class="error" id="problem" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
        <button class="primary" ?disabled=${this._busy}>${words.button}</button>
        <p class="hint">${words.forgotten}</p>
      </form>`;
  }

  private async onSubmit(event: Event): Promise<void> {
    event.preventDefault();
    if (this._busy) return;
    const name = this._user!;
    const user = name.value.trim();
    const password = this._password.value; // spaces are part of a password
    this._problem = this._tokenProblem = "";
    if (user === "" || password === "") {
      this._problem = texts.sign_in.empty;
      (user === "" ? name : this._password).focus();
      return;
    }
    this._problem = await this.tryTo("password", () =>
      this.api.json("POST /login", { body: { user, password } }),
    );
    if (this._problem) this._password.select();
  }

  private async onToken(event: Event): Promise<void> {
    event.preventDefault();
    if (this._busy) return;
    const token = this._token.value.trim();
    const path = loginPathOf(token);
    this._problem = this._tokenProblem = "";
    if (path) location.assign(path);
    else if (token === "") this._tokenProblem = texts.sign_in.token_empty;
    else
      this._tokenProblem = await this.tryTo("token", () =>
        this.api.json("POST /login", { body: { token } }),
      );
  }

  /** Returns the error text, or an empty string after success. */
  private async tryTo(by: "password" | "token", login: () => Promise<unknown>): Promise<string> {
    this._busy = true;
    try {
      await login();
      this.dispatchEvent(new CustomEvent("signed-in"));
      return "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return signInProblem(error, by);
    } finally {
      this._busy = false;
    }
  }
}
