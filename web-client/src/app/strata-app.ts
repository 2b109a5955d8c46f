// <strata-app>: who is signed in, and which page the address names.

import { html, LitElement, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { Api, ApiError } from "../core/api";
import "./home-page";
import "./model-page";
import { notices } from "./notices";
import "./notices-view";
import { on_navigate, path_now, route_of, type Route } from "./routes";
import { shared_styles } from "./styles";
import "./sign-in";
import { texts } from "./texts";
import type { Me } from "../core/types";

@customElement("strata-app")
export class StrataApp extends LitElement {
  private readonly api_ = new Api();
  @state() private route_: Route = route_of(path_now());
  @state() private me_: Me | null = null;
  @state() private session_: "unknown" | "signed-in" | "signed-out" | "unreachable" = "unknown";
  @state() private problem_ = "";

  static override styles = shared_styles;

  override connectedCallback(): void {
    super.connectedCallback();
    on_navigate(() => (this.route_ = route_of(path_now())));
    addEventListener("unhandledrejection", (event) => notices.error(event.reason));
    void this.check_session();
  }

  private async check_session(): Promise<void> {
    try {
      this.me_ = await this.api_.me();
      this.session_ = "signed-in";
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

  override render(): TemplateResult {
    return html`${this.page()}<strata-notices></strata-notices>`;
  }

  private page(): TemplateResult {
    const signed_out = (): void => {
      this.session_ = "signed-out";
    };
    switch (this.session_) {
      case "unknown":
        return html``;
      case "signed-out":
        return html`<strata-sign-in .api=${this.api_} @signed-in=${() => void this.check_session()}></strata-sign-in>`;
      case "unreachable":
        return html`<strata-blank heading=${texts.connection.lost} lead=${this.problem_}></strata-blank>`;
      case "signed-in":
        return this.route_.page === "model"
          ? html`<strata-model-page
              .api=${this.api_}
              .model_id=${this.route_.model}
              @signed-out=${signed_out}
            ></strata-model-page>`
          : html`<strata-home-page .api=${this.api_} .me=${this.me_} @signed-out=${signed_out}></strata-home-page>`;
    }
  }
}
