// <strata-kiosks-dialog>: the links for screens that show tours. It shows the links of one tour
// with a form for a new link, or all links that this user manages.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { kSilentMs, stateOfKiosk } from "../../domain/kiosks";
import { readNumber } from "../../core/locale";
import type { Kiosk, KioskMade } from "../../core/protocol.gen";
import "../../ui/made-link";
import { rowList, rowListStyles, type ListedRow } from "../../ui/row-list";
import { ask } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import { numberInput } from "../../ui/number-input";
import { follow, pathOfModel } from "../../ui/routes";
import { chipStyles, linkMakingStyles, numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { toldAgo, toldDate } from "../../domain/times";

const words = texts.kiosks;
const kDays = [1, 3650] as const;

type Field = "name" | "days";

@customElement("strata-kiosks-dialog")
export class StrataKiosksDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** The tour, by slugs. Null shows the links of all tours. */
  @property({ attribute: false }) tour: {
    project: string;
    model: string;
    slug: string;
    name: string;
  } | null = null;
  @state() private _kiosks: readonly Kiosk[] | null = null;
  @state() private _making = false;
  @state() private _made: KioskMade | null = null;
  @state() private _days = "365";
  @state() private _wrong: { field: Field; text: string } | null = null;
  @state() private _note: { id: number; kind: "error" | "done"; text: string } | null = null;
  @state() private _problem = "";
  @state() private _busy = false;
  private _timer = 0;

  static override styles = [
    sharedStyles,
    chipStyles,
    linkMakingStyles,
    rowListStyles,
    numberFieldStyles,
    css`
      .fields {
        grid-template-columns: minmax(0, 1fr) 9.375rem;
        align-items: end;
      }
      button.new {
        justify-self: start;
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
        .fields {
          grid-template-columns: minmax(0, 1fr);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.attempt(() => this.read());
    // a failed read is repeated after the next interval
    this._timer = window.setInterval(() => void this.read().catch(() => {}), kSilentMs / 6);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clearInterval(this._timer);
  }

  private async read(): Promise<void> {
    const { tour } = this;
    const all = await this.api.all("GET /kiosks", "kiosks");
    this._kiosks = tour
      ? all.filter(
          (each) =>
            each.project === tour.project && each.model === tour.model && each.tour === tour.slug,
        )
      : all;
  }

  override render(): TemplateResult {
    const { tour, _kiosks: kiosks } = this;
    return html`<strata-dialog broad heading=${tour ? words.title_of(tour.name) : words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${tour ? words.lead_of : words.lead}</p>
      ${tour && !this._making ? html`<button class="new ${this._made ? "" : "primary"}" @click=${this.begin}>${icon("plus")}${words.new}</button>` : nothing}
      ${this._making ? this.form() : nothing} ${this._made ? this.link(this._made) : nothing}
      ${
        kiosks
          ? kiosks.length === 0
            ? html`<p>${tour ? words.none_of : words.none}</p>`
            : rowList([...kiosks].reverse(), (kiosk) => this.row(kiosk))
          : html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`
      }
      ${
        this._problem
          ? html`<p class="error" role="alert">${this._problem}</p>
            <div><button @click=${() => void this.attempt(() => this.read())}>${texts.try_again}</button></div>`
          : nothing
      }
    </strata-dialog>`;
  }

  private row(kiosk: Kiosk): ListedRow {
    const state = stateOfKiosk(kiosk);
    const ended = state === "revoked" || state === "expired";
    return {
      name: kiosk.name,
      label: kiosk.name,
      beside: html`<span class="chip ${state}">${words.states[state]}</span>
        ${kiosk.wants_reload && !ended ? html`<span class="chip asked">${words.asked}</span>` : nothing}`,
      about: html`${
        this.tour
          ? nothing
          : html`<span class="hint">${kiosk.tour_name} · <a class="text" href=${pathOfModel(kiosk.model)} @click=${this.onLink}>${kiosk.model_name}</a></span>`
      }
        <span class="hint">${this.told(kiosk)}</span>`,
      tools: ended
        ? undefined
        : html`<label class="check" title=${words.phones_hint}><input type="checkbox" aria-label=${words.phones_of(kiosk.name)} .checked=${kiosk.phones ?? false} @change=${(event: Event) => void this.allowPhones(kiosk, (event.target as HTMLInputElement).checked)} /> <span>QR</span></label>
            <button ?disabled=${kiosk.wants_reload} aria-label=${words.reload_of(kiosk.name)} @click=${() => void this.reload(kiosk)}>${icon("redo")}${words.reload}</button>
            <button aria-label=${words.revoke_of(kiosk.name)} @click=${() => void this.revoke(kiosk)}>${words.revoke}</button>`,
      note: this._note?.id === kiosk.id ? this._note : null,
    };
  }

  private onLink(event: MouseEvent): void {
    follow(event);
    // a link that opens in another tab leaves the dialog open
    if (event.defaultPrevented) this.dispatchEvent(new CustomEvent("closed"));
  }

  private told({ last_seen: lastSeen, expires, revoked, created, user }: Kiosk): string {
    const seen = lastSeen ? words.seen(toldAgo(lastSeen)) : words.never_seen;
    const ends = revoked
      ? words.revoked_on(toldDate(revoked))
      : expires
        ? words.expires_on(toldDate(expires))
        : words.no_end;
    return [seen, ends, words.made_by(user, toldDate(created))].join(" · ");
  }

  // ── new link ───────────────────────────────────────────────────────────────────────────────────

  private form(): TemplateResult {
    const wrong = (field: Field): string => (this._wrong?.field === field ? this._wrong.text : "");
    return html`<form @submit=${this.onSubmit} @input=${() => (this._wrong = null)} novalidate>
      <div class="fields">
        <label class="field">
          <span>${words.name}</span>
          <input type="text" name="name" maxlength="200" autocomplete="off" placeholder=${words.name_hint} aria-invalid=${wrong("name") ? "true" : "false"} />
        </label>
        <label class="field">
          <span>${words.days}</span>
          <span class="number">${numberInput({ value: this._days, name: "days", placeholder: words.days_hint, min: kDays[0], max: kDays[1], wrong: wrong("days") !== "", typed: (text) => (this._days = text) })}<span>${words.days_unit}</span></span>
        </label>
      </div>
      ${this._wrong ? html`<p class="error" role="alert">${this._wrong.text}</p>` : html`<p class="hint">${words.days_lead}</p>`}
      <label class="check"><input type="checkbox" name="phones" /> <span>${words.phones}</span></label>
      <p class="hint">${words.phones_hint}</p>
      <div class="row">
        <button class="primary" ?disabled=${this._busy}>${words.make}</button>
        <button type="button" class="quiet" @click=${() => (this._making = false)}>${texts.cancel}</button>
      </div>
    </form>`;
  }

  private link({ path, kiosk }: KioskMade): TemplateResult {
    return html`<strata-made-link
      heading=${words.link(kiosk.name)}
      lead=${words.link_lead}
      text=${new URL(path, location.origin).href}
      done=${words.link_done}
      @done=${() => (this._made = null)}
    ></strata-made-link>`;
  }

  private begin(): void {
    this._making = true;
    this._made = null;
    this._wrong = null;
    void this.updateComplete.then(() =>
      this.renderRoot.querySelector<HTMLInputElement>("input[name=name]")?.focus(),
    );
  }

  private refuse(field: Field, text: string): void {
    this._wrong = { field, text };
    this.renderRoot.querySelector<HTMLElement>(`input[name=${field}]`)?.focus();
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
    const { tour } = this;
    const name =
      this.renderRoot.querySelector<HTMLInputElement>("input[name=name]")?.value.trim() ?? "";
    const days = readNumber(this._days);
    if (!tour || this._busy) return;
    if (name === "") return this.refuse("name", words.name_missing);
    if (
      this._days.trim() !== "" &&
      !(Number.isInteger(days) && days >= kDays[0] && days <= kDays[1])
    )
      return this.refuse("days", words.days_wrong(...kDays));
    void this.attempt(async () => {
      this._made = await this.api.json("POST /models/{model}/tours/{tour}/kiosks", {
        path: { model: tour.model, tour: tour.slug },
        body: {
          name,
          ...(this._days.trim() === "" ? {} : { days }),
          phones:
            this.renderRoot.querySelector<HTMLInputElement>("input[name=phones]")?.checked === true,
        },
      });
      this._making = false;
      await this.read();
    });
  }

  // ── existing links ─────────────────────────────────────────────────────────────────────────────

  private async reload(kiosk: Kiosk): Promise<void> {
    await this.change(kiosk, async () => {
      const now = await this.api.json("POST /kiosks/{kiosk}/reload", { path: { kiosk: kiosk.id } });
      this._kiosks = (this._kiosks ?? []).map((each) => (each.id === now.id ? now : each));
      this._note = { id: kiosk.id, kind: "done", text: words.reload_asked };
    });
  }

  private async allowPhones(kiosk: Kiosk, phones: boolean): Promise<void> {
    await this.change(kiosk, async () => {
      const now = await this.api.json("PATCH /kiosks/{kiosk}", {
        path: { kiosk: kiosk.id },
        body: { phones },
      });
      this._kiosks = (this._kiosks ?? []).map((each) => (each.id === now.id ? now : each));
    });
    this.requestUpdate(); // after a refusal the checkbox shows the stored state
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
      await this.api.send("DELETE /kiosks/{kiosk}", { path: { kiosk: kiosk.id } });
      if (this._made?.kiosk.id === kiosk.id) this._made = null;
      await this.read();
    });
  }

  /** Runs a change. If the server refuses it, the kiosk's row shows the reason. */
  private async change({ id }: Kiosk, task: () => Promise<void>): Promise<void> {
    this._note = null;
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      this._note = { id, kind: "error", text: error.message };
    }
  }

  private async attempt(task: () => Promise<void>): Promise<void> {
    this._busy = true;
    this._problem = "";
    try {
      await task();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const { field } = error.problem;
      if (error.status === 401) this.dispatchEvent(new CustomEvent("signed-out"));
      else if (this._making && (field === "name" || field === "days"))
        this.refuse(field, error.message);
      else this._problem = error.message;
    } finally {
      this._busy = false;
    }
  }
}
