// <strata-sign-in>: for who opens the page without a session: name and password, or a token or the
// link that the server printed.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, type Api } from "../../net/api";
import { login_path_of, sign_in_problem } from "./entry";
import { entry_styles } from "./entry-styles";
import { icon, logo } from "../../ui/icons";
import { password_field, password_styles } from "./password-field";
import "./preferences-fields";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

@customElement("strata-sign-in")
export class StrataSignIn extends LitElement {
  @property({ attribute: false }) api!: Api;
  @state() private problem_ = "";
  @state() private token_problem_ = "";
  @state() private busy_ = false;
  @query("input[name=user]") private user_!: HTMLInputElement;
  @query("input[name=password]") private password_!: HTMLInputElement;
  @query("input[name=token]") private token_!: HTMLInputElement;

  static override styles = [
    shared_styles,
    entry_styles,
    password_styles,
    css`
      details {
        padding-top: 16px;
        border-top: var(--edge) solid var(--line);
      }
      summary {
        display: flex;
        align-items: center;
        gap: 6px;
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
        margin-top: 14px;
        gap: 14px;
      }
    `,
  ];

  override firstUpdated(): void {
    this.user_.focus();
  }

  override render(): TemplateResult {
    const words = texts.sign_in;
    return html`<main class="card">
      <div class="brand">
        ${logo()}
        <div><b>${texts.product}</b><span>${texts.tagline}</span></div>
      </div>
      <h1>${words.title}</h1>
      <form @submit=${this.on_submit} novalidate>
        <label class="field">
          <span>${words.user}</span>
          <input
            type="text"
            name="user"
            maxlength="200"
            autocomplete="username"
            autocapitalize="off"
            spellcheck="false"
            aria-invalid=${this.problem_ ? "true" : "false"}
            aria-describedby="problem"
          />
        </label>
        ${password_field({ name: "password", label: words.password, autocomplete: "current-password", wrong_by: this.problem_ ? "problem" : "" })}
        <p class="error" id="problem" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
        <button class="primary" ?disabled=${this.busy_}>${words.button}</button>
        <p class="hint">${words.forgotten}</p>
      </form>
      <details>
        <summary>${icon("chevron")}${words.otherwise}</summary>
        <form @submit=${this.on_token} novalidate>
          <p class="hint">${words.otherwise_lead}</p>
          <label class="field">
            <span>${words.token}</span>
            <input
              type="password"
              name="token"
              autocomplete="off"
              aria-invalid=${this.token_problem_ ? "true" : "false"}
              aria-describedby="token_problem"
            />
          </label>
          <p class="error" id="token_problem" role="alert" ?hidden=${!this.token_problem_}>${this.token_problem_}</p>
          <button ?disabled=${this.busy_}>${words.button}</button>
          <p class="hint">${words.token_hint} <code>${location.origin}/login?link=…</code></p>
        </form>
      </details>
      <strata-preferences></strata-preferences>
    </main>`;
  }

  private async on_submit(event: Event): Promise<void> {
    event.preventDefault();
    if (this.busy_) return;
    const user = this.user_.value.trim();
    const password = this.password_.value; // spaces count
    this.problem_ = this.token_problem_ = "";
    if (user === "" || password === "") {
      this.problem_ = texts.sign_in.empty;
      (user === "" ? this.user_ : this.password_).focus();
      return;
    }
    this.problem_ = await this.try_to("password", () => this.api.login({ user, password }));
    if (this.problem_) this.password_.select();
  }

  private async on_token(event: Event): Promise<void> {
    event.preventDefault();
    if (this.busy_) return;
    const token = this.token_.value.trim();
    const path = login_path_of(token);
    this.problem_ = this.token_problem_ = "";
    if (path) location.assign(path);
    else if (token === "") this.token_problem_ = texts.sign_in.token_empty;
    else this.token_problem_ = await this.try_to("token", () => this.api.login({ token }));
  }

  /** What is wrong, or nothing. */
  private async try_to(by: "password" | "token", login: () => Promise<unknown>): Promise<string> {
    this.busy_ = true;
    try {
      await login();
      this.dispatchEvent(new CustomEvent("signed-in"));
      return "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return sign_in_problem(error, by);
    } finally {
      this.busy_ = false;
    }
  }
}
