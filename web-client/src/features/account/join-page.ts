// <strata-join-page>: whoever comes by an invitation chooses a password, and is signed in.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, type Api } from "../../net/api";
import { format_list } from "../../core/locale";
import { called, kLeastPasswordLength, password_mistake } from "../../domain/people";
import type { Person } from "../../core/protocol.gen";
import type { Me } from "../../core/types";
import { is_useless_link, password_words } from "./entry";
import { entry_styles } from "./entry-styles";
import { logo } from "../../ui/icons";
import { password_field, password_styles } from "./password-field";
import "./preferences-fields";
import { follow } from "../../ui/routes";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.join;

@customElement("strata-join-page")
export class StrataJoinPage extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** The secret; empty: the address has none. */
  @property() invitation = "";
  /** Who is signed in at this browser. */
  @property({ attribute: false }) me: Me | null = null;
  @state() private person_: Person | null = null;
  @state() private useless_ = false;
  @state() private problem_ = "";
  @state() private field_problems_: Partial<Record<"password" | "repeat" | "full_name", string>> =
    {};
  @state() private busy_ = false;
  @query("form") private form_!: HTMLFormElement | null;

  static override styles = [shared_styles, entry_styles, password_styles];

  override connectedCallback(): void {
    super.connectedCallback();
    document.title = texts.product;
    if (this.invitation) void this.look();
  }

  private async look(): Promise<void> {
    this.problem_ = "";
    try {
      this.person_ = await this.api.show_invitation(this.invitation);
    } catch (error) {
      this.refused(error);
    }
  }

  private refused(error: unknown): void {
    if (!(error instanceof ApiError)) throw error;
    const { field } = error.problem;
    if (is_useless_link(error)) this.useless_ = true;
    else if (field === "password" || field === "full_name") this.refuse(field, error.message);
    else this.problem_ = error.message;
  }

  private refuse(field: "password" | "repeat" | "full_name", problem: string): void {
    this.field_problems_ = { [field]: problem };
    this.form_?.querySelector<HTMLInputElement>(`input[name=${field}]`)?.focus();
  }

  override render(): TemplateResult {
    return html`<main class="card">
      <div class="brand">
        ${logo()}
        <div><b>${texts.product}</b><span>${texts.tagline}</span></div>
      </div>
      ${this.content()}
      <strata-preferences></strata-preferences>
    </main>`;
  }

  private content(): TemplateResult {
    const { person_: person, me } = this;
    if (!this.invitation) return this.dead_end(words.incomplete_title, words.incomplete_lead);
    if (this.useless_) return this.dead_end(words.useless_title, words.useless_lead);
    if (!person) {
      return this.problem_
        ? html`<p class="error" role="alert">${this.problem_}</p>
            <button @click=${() => void this.look()}>${texts.try_again}</button>`
        : html`<p class="hint" role="status">${words.looking}</p>`;
    }
    if (me && me.user !== person.user) return this.somebody_else(me, person);
    return this.form(person);
  }

  private dead_end(title: string, lead: string): TemplateResult {
    return html`<div>
        <h1>${title}</h1>
        <p role="alert">${lead}</p>
      </div>
      <a class="button" href="/" @click=${follow}>${this.me ? texts.model.back : words.to_sign_in}</a>`;
  }

  private somebody_else(me: Me, person: Person): TemplateResult {
    return html`<div>
        <h1>${words.greeting(called(person))}</h1>
        <p role="alert">${words.other_person(called(me), called(person))}</p>
      </div>
      <button class="primary" @click=${() => this.dispatchEvent(new CustomEvent("sign-out"))}>${words.sign_out(called(me))}</button>`;
  }

  private form(person: Person): TemplateResult {
    const problems = this.field_problems_;
    return html`<div>
        <h1>${words.greeting(called(person))}</h1>
        <p>${person.state === "invited" ? words.lead(texts.roles[person.role]) : words.lead_again}</p>
        ${person.groups.length > 0 ? html`<p>${words.groups(format_list(person.groups))}</p>` : nothing}
      </div>
      <form @submit=${this.on_submit} novalidate>
        <label class="field">
          <span>${words.user}</span>
          <input type="text" name="user" autocomplete="username" readonly .value=${person.user} />
        </label>
        <label class="field">
          <span>${words.full_name}</span>
          <input
            type="text"
            name="full_name"
            maxlength="200"
            autocomplete="name"
            .value=${person.full_name}
            aria-invalid=${problems.full_name ? "true" : "false"}
            aria-describedby="full_name_problem"
          />
        </label>
        ${problems.full_name ? html`<p class="error" id="full_name_problem" role="alert">${problems.full_name}</p>` : nothing}
        ${password_field({
          name: "password",
          label: words.password,
          autocomplete: "new-password",
          hint: texts.password.hint(kLeastPasswordLength),
          problem: problems.password ?? "",
        })}
        ${password_field({ name: "repeat", label: words.repeat, autocomplete: "new-password", problem: problems.repeat ?? "" })}
        <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
        <button class="primary" ?disabled=${this.busy_}>${words.button}</button>
      </form>`;
  }

  private async on_submit(event: Event): Promise<void> {
    event.preventDefault();
    if (this.busy_ || !this.person_) return;
    const data = new FormData(event.target as HTMLFormElement);
    const password = String(data.get("password") ?? "");
    this.problem_ = "";
    this.field_problems_ = {};
    const mistake = password_mistake(this.person_.user, password, String(data.get("repeat") ?? ""));
    if (mistake) {
      this.refuse(mistake.field, password_words(mistake));
      return;
    }
    this.busy_ = true;
    try {
      await this.api.accept_invitation({
        invitation: this.invitation,
        password,
        full_name: String(data.get("full_name") ?? "").trim(),
      });
      this.dispatchEvent(new CustomEvent("joined"));
    } catch (error) {
      this.refused(error);
    } finally {
      this.busy_ = false;
    }
  }
}
