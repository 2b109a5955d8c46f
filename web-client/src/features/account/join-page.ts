// <strata-join-page>: an invited person sets a password and is signed in.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { formatList } from "../../core/locale";
import { called, kLeastPasswordLength, passwordMistake } from "../../domain/people";
import type { Person } from "../../core/protocol.gen";
import type { Me } from "../../core/types";
import { isUselessLink, passwordWords } from "./entry";
import { entryStyles } from "./entry-styles";
import { logo } from "../../ui/icons";
import { passwordField, passwordStyles } from "./password-field";
import "./preferences-fields";
import { follow } from "../../ui/routes";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.join;

@customElement("strata-join-page")
export class StrataJoinPage extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** The secret of the invitation; empty if the address has none. */
  @property() invitation = "";
  /** The signed-in user of this browser. */
  @property({ attribute: false }) me: Me | null = null;
  @state() private _person: Person | null = null;
  @state() private _useless = false;
  @state() private _problem = "";
  @state() private _fieldProblems: Partial<Record<"password" | "repeat" | "full_name", string>> =
    {};
  @state() private _busy = false;
  @query("form") private _form!: HTMLFormElement | null;

  static override styles = [sharedStyles, entryStyles, passwordStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    document.title = texts.product;
    if (this.invitation) void this.look();
  }

  private async look(): Promise<void> {
    this._problem = "";
    try {
      this._person = await this.api.json("POST /invitations/show", {
        body: { invitation: this.invitation },
      });
    } catch (error) {
      this.refused(error);
    }
  }

  private refused(error: unknown): void {
    if (!(error instanceof ApiError)) throw error;
    const { field } = error.problem;
    if (isUselessLink(error)) this._useless = true;
    else if (field === "password" || field === "full_name") this.refuse(field, error.message);
    else this._problem = error.message;
  }

  private refuse(field: "password" | "repeat" | "full_name", problem: string): void {
    this._fieldProblems = { [field]: problem };
    this._form?.querySelector<HTMLInputElement>(`input[name=${field}]`)?.focus();
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
    const { _person: person, me } = this;
    if (!this.invitation) return this.deadEnd(words.incomplete_title, words.incomplete_lead);
    if (this._useless) return this.deadEnd(words.useless_title, words.useless_lead);
    if (!person) {
      return this._problem
        ? html`<p class="error" role="alert">${this._problem}</p>
            <button @click=${() => void this.look()}>${texts.try_again}</button>`
        : html`<p class="hint" role="status">${words.looking}</p>`;
    }
    if (me && me.user !== person.user) return this.somebodyElse(me, person);
    return this.form(person);
  }

  private deadEnd(title: string, lead: string): TemplateResult {
    return html`<div>
        <h1>${title}</h1>
        <p role="alert">${lead}</p>
      </div>
      <a class="button" href="/" @click=${follow}>${this.me ? texts.model.back : words.to_sign_in}</a>`;
  }

  private somebodyElse(me: Me, person: Person): TemplateResult {
    return html`<div>
        <h1>${words.greeting(called(person))}</h1>
        <p role="alert">${words.other_person(called(me), called(person))}</p>
      </div>
      <button class="primary" @click=${() => this.dispatchEvent(new CustomEvent("sign-out"))}>${words.sign_out(called(me))}</button>`;
  }

  private form(person: Person): TemplateResult {
    const problems = this._fieldProblems;
    return html`<div>
        <h1>${words.greeting(called(person))}</h1>
        <p>${person.state === "invited" ? words.lead(texts.roles[person.role]) : words.lead_again}</p>
        ${person.groups.length > 0 ? html`<p>${words.groups(formatList(person.groups))}</p>` : nothing}
      </div>
      <form @submit=${this.onSubmit} novalidate>
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
        ${passwordField({
          name: "password",
          label: words.password,
          autocomplete: "new-password",
          hint: texts.password.hint(kLeastPasswordLength),
          problem: problems.password ?? "",
        })}
        ${passwordField({ name: "repeat", label: words.repeat, autocomplete: "new-password", problem: problems.repeat ?? "" })}
        <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
        <button class="primary" ?disabled=${this._busy}>${words.button}</button>
      </form>`;
  }

  private async onSubmit(event: Event): Promise<void> {
    event.preventDefault();
    if (this._busy || !this._person) return;
    const data = new FormData(event.target as HTMLFormElement);
    const password = String(data.get("password") ?? "");
    this._problem = "";
    this._fieldProblems = {};
    const mistake = passwordMistake(this._person.user, password, String(data.get("repeat") ?? ""));
    if (mistake) {
      this.refuse(mistake.field, passwordWords(mistake));
      return;
    }
    this._busy = true;
    try {
      await this.api.json("POST /invitations/accept", {
        body: {
          invitation: this.invitation,
          password,
          full_name: String(data.get("full_name") ?? "").trim(),
        },
      });
      this.dispatchEvent(new CustomEvent("joined"));
    } catch (error) {
      this.refused(error);
    } finally {
      this._busy = false;
    }
  }
}
