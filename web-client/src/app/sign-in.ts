// <strata-sign-in>: for who opens the page without a session. Takes a token, or the whole link that the server printed.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError, type Api } from "../core/api";
import { logo } from "./icons";
import { shared_styles } from "./styles";
import { texts } from "./texts";

/** The path to open for a pasted owner link; null when it is not one. */
export function login_path_of(pasted: string): string | null {
  const found = /\/login\?link=[A-Za-z0-9._~%-]+/.exec(pasted);
  return found ? found[0] : null;
}

@customElement("strata-sign-in")
export class StrataSignIn extends LitElement {
  @property({ attribute: false }) api!: Api;
  @state() private error_ = "";
  @state() private busy_ = false;

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        place-items: center;
        min-height: 100dvh;
        padding: 20px;
      }
      main {
        width: min(420px, 100%);
      }
      form {
        display: grid;
        gap: 18px;
        padding: 36px 34px 32px;
        border: 1px solid var(--line);
        border-radius: 16px;
        background: var(--surface);
        box-shadow: var(--shadow);
      }
      .logo {
        width: 44px;
        height: 44px;
      }
      .brand {
        display: flex;
        align-items: center;
        gap: 14px;
      }
      .brand b {
        font: 600 1.5rem/1.1 var(--serif);
      }
      .brand span {
        display: block;
        font-size: 0.85rem;
        color: var(--ink-soft);
      }
      h1 {
        font-size: 1.2rem;
      }
      code {
        font: 0.8rem var(--mono);
        overflow-wrap: anywhere;
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.sign_in;
    return html`<main><form @submit=${this.on_submit} novalidate>
      <div class="brand">
        ${logo()}
        <div><b>${texts.product}</b><span>${texts.tagline}</span></div>
      </div>
      <div>
        <h1>${words.title}</h1>
        <p>${words.lead}</p>
      </div>
      <label class="field">
        <span>${words.token}</span>
        <input
          type="password"
          name="token"
          autocomplete="current-password"
          autofocus
          aria-invalid=${this.error_ ? "true" : "false"}
          aria-describedby="error"
        />
      </label>
      <p class="error" id="error" role="alert" ?hidden=${!this.error_}>${this.error_}</p>
      <button class="primary" ?disabled=${this.busy_}>${words.button}</button>
      <p class="hint">${words.hint} <code>${location.origin}/login?link=…</code></p>
    </form></main>`;
  }

  private async on_submit(event: Event): Promise<void> {
    event.preventDefault();
    const token = String(new FormData(event.target as HTMLFormElement).get("token") ?? "").trim();
    if (!token) {
      this.error_ = texts.sign_in.empty;
      return;
    }
    const path = login_path_of(token);
    if (path) {
      location.assign(path);
      return;
    }
    this.busy_ = true;
    this.error_ = "";
    try {
      await this.api.login(token);
      this.dispatchEvent(new CustomEvent("signed-in"));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.error_ = error.status === 401 || error.status === 403 || error.status === 400 ? texts.sign_in.wrong : error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
