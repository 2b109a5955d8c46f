// <strata-account-menu>: the initials of the signed-in user, and a menu of account commands. The
// event "account" reports the chosen command.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { called, initials, nameWith } from "../domain/people";
import { mayAdminister, type Me } from "../core/types";
import { icon } from "./icons";
import "./menu";
import { styled } from "./styled";
import { sharedStyles } from "./styles";
import { texts } from "../texts";

export type AccountRequest = "account" | "people" | "nodes" | "kiosks" | "preferences" | "sign-out";

/** Dispatches an account request, which bubbles to the element that handles it. */
export const askAccount = (from: EventTarget, detail: AccountRequest): boolean =>
  from.dispatchEvent(
    new CustomEvent<AccountRequest>("account", { detail, bubbles: true, composed: true }),
  );

@customElement("strata-account-menu")
export class StrataAccountMenu extends LitElement {
  @property({ attribute: false }) me!: Me;
  /** Whether the user can manage links for kiosks. */
  @property({ type: Boolean }) kiosks = false;

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: inline-flex;
        flex: none;
      }
      .face {
        display: grid;
        place-items: center;
        width: 1.875rem;
        height: 1.875rem;
        border-radius: 50%;
        color: var(--mark-light);
        font-size: var(--text-tiny);
        font-weight: 700;
        letter-spacing: 0.02em;
      }
      .who {
        display: grid;
        max-width: 16.25rem;
        padding: var(--space-2) var(--space-3) var(--space-2);
        overflow-wrap: anywhere;
      }
      .who span {
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
    `,
  ];

  override render(): TemplateResult {
    const { me } = this;
    const words = texts.account;
    const role = texts.roles[me.role];
    return html`<strata-menu label=${nameWith(words.menu(called(me)), initials(me))}>
      <span class="face" slot="face" ${styled({ background: me.color })}>${initials(me)}</span>
      <div class="who"><b>${called(me)}</b><span>${me.full_name.trim() ? `${me.user} · ${role}` : role}</span></div>
      <hr />
      <button class="quiet" role="menuitem" @click=${() => askAccount(this, "account")}>${icon("person")}${words.open}</button>
      ${
        mayAdminister(me.role)
          ? html`<button class="quiet" role="menuitem" @click=${() => askAccount(this, "people")}>${icon("people")}${words.people}</button>
            <button class="quiet" role="menuitem" @click=${() => askAccount(this, "nodes")}>${icon("cloud")}${words.nodes}</button>`
          : nothing
      }
      ${
        this.kiosks
          ? html`<button class="quiet" role="menuitem" @click=${() => askAccount(this, "kiosks")}>${icon("picture")}${texts.kiosks.open}</button>`
          : nothing
      }
      <button class="quiet" role="menuitem" @click=${() => askAccount(this, "preferences")}>${icon("language")}${texts.settings.open}</button>
      <button class="quiet" role="menuitem" @click=${() => window.open("/guide/", "_blank", "noopener")}>${icon("book")}${texts.help.guide}</button>
      <hr />
      <button class="quiet" role="menuitem" @click=${() => askAccount(this, "sign-out")}>${icon("leave")}${words.sign_out}</button>
    </strata-menu>`;
  }
}
