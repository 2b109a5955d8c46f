// <strata-kiosks-dialog>: the links for screens that show tours: of one tour, with a form that
// makes one, or all that this person sees to.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { ApiError, type Api } from "../../net/api";
import { kSilent_ms, state_of_kiosk } from "../../domain/kiosks";
import { read_number } from "../../core/locale";
import type { Kiosk, KioskMade } from "../../core/protocol.gen";
import "../../ui/copy-field";
import { ask } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import { number_input } from "../../ui/number-input";
import { follow, path_of_model } from "../../ui/routes";
import {
  chip_styles,
  link_making_styles,
  number_field_styles,
  shared_styles,
} from "../../ui/styles";
import { texts } from "../../texts";
import { told_ago, told_date } from "../../domain/times";

const words = texts.kiosks;
const kDays = [1, 3650] as const;

type Field = "name" | "days";

@customElement("strata-kiosks-dialog")
export class StrataKiosksDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** Null: those of all tours. By slugs. */
  @property({ attribute: false }) tour: {
    project: string;
    model: string;
    slug: string;
    name: string;
  } | null = null;
  @state() private kiosks_: readonly Kiosk[] | null = null;
  @state() private making_ = false;
  @state() private made_: KioskMade | null = null;
  @state() private days_ = "365";
  @state() private wrong_: { field: Field; text: string } | null = null;
  @state() private note_: { id: number; kind: "error" | "done"; text: string } | null = null;
  @state() private problem_ = "";
  @state() private busy_ = false;
  private timer_ = 0;

  static override styles = [
    shared_styles,
    chip_styles,
    link_making_styles,
    number_field_styles,
    css`
      .fields {
        grid-template-columns: minmax(0, 1fr) 9.375rem;
        align-items: end;
      }
      button.new {
        justify-self: start;
      }
      ul {
        display: grid;
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: minmax(0, 1fr) auto;
        align-items: center;
        gap: 4px 0.875rem;
        padding: 0.625rem 0;
        border-top: var(--edge) solid var(--line);
      }
      li:first-child {
        border-top: 0;
      }
      .about {
        display: grid;
        gap: 2px;
        min-width: 0;
      }
      .about > .row {
        flex-wrap: wrap;
        gap: 4px 0.5rem;
      }
      b {
        font-weight: 600;
        overflow-wrap: anywhere;
        unicode-bidi: plaintext;
      }
      .hint {
        overflow-wrap: anywhere;
      }
      li .buttons {
        display: flex;
        flex-wrap: wrap;
        gap: 0.5rem;
      }
      li .error,
      li .done {
        grid-column: 1 / -1;
        font-size: 0.86rem;
      }
      li .done {
        color: var(--calm);
      }
      .chip.silent,
      .chip.asked {
        background: var(--warn-soft);
        color: var(--warn);
      }
      .chip.revoked,
      .chip.expired {
        background: var(--danger-soft);
        color: var(--danger);
      }
      .chip.unopened {
        background: var(--accent-soft);
        color: var(--accent);
      }
      @media (max-width: 560px) {
        li,
        .fields {
          grid-template-columns: minmax(0, 1fr);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt(() => this.read());
    // what could not be read is read the next time
    this.timer_ = window.setInterval(() => void this.read().catch(() => {}), kSilent_ms / 6);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clearInterval(this.timer_);
  }

  private async read(): Promise<void> {
    const { tour } = this;
    const all = await this.api.kiosks();
    this.kiosks_ = tour
      ? all.filter(
          (each) =>
            each.project === tour.project && each.model === tour.model && each.tour === tour.slug,
        )
      : all;
  }

  override render(): TemplateResult {
    const { tour, kiosks_: kiosks } = this;
    return html`<strata-dialog broad heading=${tour ? words.title_of(tour.name) : words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${tour ? words.lead_of : words.lead}</p>
      ${tour && !this.making_ ? html`<button class="new ${this.made_ ? "" : "primary"}" @click=${this.begin}>${icon("plus")}${words.new}</button>` : nothing}
      ${this.making_ ? this.form() : nothing} ${this.made_ ? this.link(this.made_) : nothing}
      ${
        kiosks
          ? kiosks.length === 0
            ? html`<p>${tour ? words.none_of : words.none}</p>`
            : html`<ul>
              ${repeat(
                [...kiosks].reverse(),
                ({ id }) => id,
                (kiosk) => this.row(kiosk),
              )}
            </ul>`
          : html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${texts.loading}</p>`
      }
      ${
        this.problem_
          ? html`<p class="error" role="alert">${this.problem_}</p>
            <div><button @click=${() => void this.attempt(() => this.read())}>${texts.try_again}</button></div>`
          : nothing
      }
    </strata-dialog>`;
  }

  private row(kiosk: Kiosk): TemplateResult {
    const state = state_of_kiosk(kiosk);
    const ended = state === "revoked" || state === "expired";
    const note = this.note_?.id === kiosk.id ? this.note_ : null;
    return html`<li aria-label=${kiosk.name}>
      <div class="about">
        <div class="row">
          <b>${kiosk.name}</b>
          <span class="chip ${state}">${words.states[state]}</span>
          ${kiosk.wants_reload && !ended ? html`<span class="chip asked">${words.asked}</span>` : nothing}
        </div>
        ${
          this.tour
            ? nothing
            : html`<span class="hint">${kiosk.tour_name} · <a class="text" href=${path_of_model(kiosk.model)} @click=${this.on_link}>${kiosk.model_name}</a></span>`
        }
        <span class="hint">${this.told(kiosk)}</span>
      </div>
      ${
        ended
          ? nothing
          : html`<div class="buttons">
            <button ?disabled=${kiosk.wants_reload} aria-label=${words.reload_of(kiosk.name)} @click=${() => void this.reload(kiosk)}>${icon("redo")}${words.reload}</button>
            <button aria-label=${words.revoke_of(kiosk.name)} @click=${() => void this.revoke(kiosk)}>${words.revoke}</button>
          </div>`
      }
      ${note ? html`<span class=${note.kind} role=${note.kind === "error" ? "alert" : "status"}>${note.text}</span>` : nothing}
    </li>`;
  }

  private on_link(event: MouseEvent): void {
    follow(event);
    // or it opens in another tab
    if (event.defaultPrevented) this.dispatchEvent(new CustomEvent("closed"));
  }

  private told({ last_seen, expires, revoked, created, user }: Kiosk): string {
    const seen = last_seen ? words.seen(told_ago(last_seen)) : words.never_seen;
    const ends = revoked
      ? words.revoked_on(told_date(revoked))
      : expires
        ? words.expires_on(told_date(expires))
        : words.no_end;
    return [seen, ends, words.made_by(user, told_date(created))].join(" · ");
  }

  // ── a new one
  // ─────────────────────────────────────────────────────────────────────────────────────────────────────

  private form(): TemplateResult {
    const wrong = (field: Field): string => (this.wrong_?.field === field ? this.wrong_.text : "");
    return html`<form @submit=${this.on_submit} @input=${() => (this.wrong_ = null)} novalidate>
      <div class="fields">
        <label class="field">
          <span>${words.name}</span>
          <input type="text" name="name" maxlength="200" autocomplete="off" placeholder=${words.name_hint} aria-invalid=${wrong("name") ? "true" : "false"} />
        </label>
        <label class="field">
          <span>${words.days}</span>
          <span class="number">${number_input({ value: this.days_, name: "days", placeholder: words.days_hint, min: kDays[0], max: kDays[1], wrong: wrong("days") !== "", typed: (text) => (this.days_ = text) })}<span>${words.days_unit}</span></span>
        </label>
      </div>
      ${this.wrong_ ? html`<p class="error" role="alert">${this.wrong_.text}</p>` : html`<p class="hint">${words.days_lead}</p>`}
      <div class="row">
        <button class="primary" ?disabled=${this.busy_}>${words.make}</button>
        <button type="button" class="quiet" @click=${() => (this.making_ = false)}>${texts.cancel}</button>
      </div>
    </form>`;
  }

  private link({ path, kiosk }: KioskMade): TemplateResult {
    const title = words.link(kiosk.name);
    return html`<div class="made" role="status">
      <div>
        <b>${title}</b>
        <p>${words.link_lead}</p>
      </div>
      <strata-copy-field follows_form label=${title} .text=${new URL(path, location.origin).href}></strata-copy-field>
      <button @click=${() => (this.made_ = null)}>${words.link_done}</button>
    </div>`;
  }

  private begin(): void {
    this.making_ = true;
    this.made_ = null;
    this.wrong_ = null;
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector<HTMLInputElement>("input[name=name]")?.focus(),
    );
  }

  private refuse(field: Field, text: string): void {
    this.wrong_ = { field, text };
    this.renderRoot.querySelector<HTMLElement>(`input[name=${field}]`)?.focus();
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    const { tour } = this;
    const name =
      this.renderRoot.querySelector<HTMLInputElement>("input[name=name]")?.value.trim() ?? "";
    const days = read_number(this.days_);
    if (!tour || this.busy_) return;
    if (name === "") return this.refuse("name", words.name_missing);
    if (
      this.days_.trim() !== "" &&
      !(Number.isInteger(days) && days >= kDays[0] && days <= kDays[1])
    )
      return this.refuse("days", words.days_wrong(...kDays));
    void this.attempt(async () => {
      this.made_ = await this.api.create_kiosk(tour.model, tour.slug, {
        name,
        ...(this.days_.trim() === "" ? {} : { days }),
      });
      this.making_ = false;
      await this.read();
    });
  }

  // ── one that there is
  // ─────────────────────────────────────────────────────────────────────────────────────────────

  private async reload(kiosk: Kiosk): Promise<void> {
    await this.change(kiosk, async () => {
      const now = await this.api.reload_kiosk(kiosk.id);
      this.kiosks_ = (this.kiosks_ ?? []).map((each) => (each.id === now.id ? now : each));
      this.note_ = { id: kiosk.id, kind: "done", text: words.reload_asked };
    });
  }

  private async revoke(kiosk: Kiosk): Promise<void> {
    if (
      !(await ask({
        heading: words.revoke_title(kiosk.name),
        lead: words.revoke_lead,
        yes: words.revoke_yes,
        danger: true,
      }))
    )
      return;
    await this.change(kiosk, async () => {
      await this.api.revoke_kiosk(kiosk.id);
      if (this.made_?.kiosk.id === kiosk.id) this.made_ = null;
      await this.read();
    });
  }

  /** What is refused is said in the kiosk's row. */
  private async change({ id }: Kiosk, task: () => Promise<void>): Promise<void> {
    this.note_ = null;
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      this.note_ = { id, kind: "error", text: error.message };
    }
  }

  private async attempt(task: () => Promise<void>): Promise<void> {
    this.busy_ = true;
    this.problem_ = "";
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const { field } = error.problem;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else if (this.making_ && (field === "name" || field === "days"))
        this.refuse(field, error.message);
      else this.problem_ = error.message;
    } finally {
      this.busy_ = false;
    }
  }
}
