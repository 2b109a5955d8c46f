// <strata-kiosk>: the whole screen. It shows the object, and the texts of the stop and the controls
// below or next to the object.

import { html, LitElement, nothing, svg, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { guard } from "lit/directives/guard.js";
import { repeat } from "lit/directives/repeat.js";
import { styled } from "../ui/styled";
import { nameOfLanguage } from "../core/languages";
import { modeOf, propertiesOf } from "../domain/tour-theme";
import { fillScreen } from "./guard";
import { directionOfLanguage } from "./languages";
import { kioskStyles } from "./kiosk-styles";
import type { KioskSession } from "./kiosk-session";
import "./player";
import "./stage";
import { addressOfFile, type ShownMedium } from "./media";
import { nameOfLayer } from "./place";
import { codeOf, phoneAddress } from "./phone";
import { followSwipes } from "./swipe";
import { textsIn } from "./texts";

const kMostDots = 12;
const kMostInvitations = 3; // number of languages in the invitation

/**
 * Returns the capitalized name of a language. In many languages, these names begin with a
 * lower-case letter.
 */
function nameOnButton(tag: string): string {
  const name = nameOfLanguage(tag) || tag;
  return name.charAt(0).toLocaleUpperCase(tag) + name.slice(1);
}

const arrowBack = svg`<svg class="turns" viewBox="0 0 24 24" aria-hidden="true"><path d="M15 5l-7 7 7 7" /></svg>`;
const arrowOn = svg`<svg class="turns" viewBox="0 0 24 24" aria-hidden="true"><path d="m9 5 7 7-7 7" /></svg>`;

const soundSign = svg`<svg viewBox="0 0 24 24" aria-hidden="true"><path d="M4 9.5v5h3.5L12 18.5v-13L7.5 9.5zM15.5 9a4.2 4.2 0 0 1 0 6M18 6.5a8 8 0 0 1 0 11" /></svg>`;
const filmSign = svg`<svg viewBox="0 0 24 24" aria-hidden="true"><path d="M3 6h18v12H3zM10 9.2v5.6l4.6-2.8z" /></svg>`;

@customElement("strata-kiosk")
export class StrataKiosk extends LitElement {
  @property({ attribute: false }) session!: KioskSession;
  @state() private _changes = 0;
  @query(".panel") private _panel!: HTMLElement | null;
  private _stopFollowing: (() => void) | null = null;
  private _stopSwipes: (() => void) | null = null;
  private _swipedPanel: HTMLElement | null = null;

  static override styles = kioskStyles;

  override connectedCallback(): void {
    super.connectedCallback();
    this._stopFollowing = this.session.subscribe(() => (this._changes += 1));
    for (const name of ["pointerdown", "pointermove", "pointerup", "keydown", "wheel"])
      addEventListener(name, this.touched, { capture: true, passive: true });
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._stopFollowing?.();
    this._stopSwipes?.();
    for (const name of ["pointerdown", "pointermove", "pointerup", "keydown", "wheel"])
      removeEventListener(name, this.touched, { capture: true });
  }

  /**
   * Any event restarts the idle time. Only the start button begins the tour, so the first touch has
   * no other effect.
   */
  private readonly touched = (event: Event): void => {
    // without a button, a mouse may move because its table shakes
    const restsAMouse = event.type === "pointermove" && (event as PointerEvent).buttons === 0;
    if (!restsAMouse && this.session.idle.presence.is === "visited") this.session.touched();
  };

  protected override updated(changed: PropertyValues): void {
    super.updated(changed);
    const { session, _panel: panel } = this;
    const root = document.documentElement;
    root.lang = session.language;
    root.dir = directionOfLanguage(session.language);
    const theme = session.tour?.theme;
    this.dataset["mode"] = modeOf(theme);
    for (const [name, value] of Object.entries(propertiesOf(theme)))
      this.style.setProperty(name, value);
    const title = session.tour?.name ?? "Strata";
    if (document.title !== title) document.title = title;
    if (panel !== this._swipedPanel) {
      this._stopSwipes?.();
      this._swipedPanel = panel;
      this._stopSwipes = panel
        ? followSwipes(panel, (by) => session.swipe(root.dir === "rtl" ? (-by as 1 | -1) : by))
        : null;
    }
    this.renderRoot
      .querySelector('.layers [aria-pressed="true"]')
      ?.scrollIntoView({ inline: "center", block: "nearest" });
    this.holdFocus();
  }

  /** Focuses each overlay once, when it opens. */
  private holdFocus(): void {
    const { session } = this;
    const open =
      session.idle.presence.is === "asked"
        ? ".asking button"
        : session.resting
          ? ".begin"
          : session.medium
            ? "strata-kiosk-player"
            : session.enlarged
              ? ".enlarged button"
              : session.card
                ? ".card h2"
                : "";
    if (open === this._focused) return;
    this._focused = open;
    this.renderRoot.querySelector<HTMLElement>(open || ".panel h1")?.focus({ preventScroll: true });
  }
  private _focused = "";

  override render(): TemplateResult {
    const { session } = this;
    const { words, show } = session;
    if (session.worthless) return this.alone(words.worthless, words.worthless_detail);
    if (!session.ready || !show) return this.alone(words.waiting, "");
    if (!session.stop) return this.alone(words.nothing, words.nothing_detail);
    const asked = session.idle.presence.is === "asked";
    const { medium } = session;
    const covered = asked || session.resting || session.enlarged !== null || medium !== null;
    return html`
      ${repeat(
        [show],
        (each) => each,
        () =>
          html`<strata-kiosk-stage class=${session.resting ? "resting" : ""} .session=${session} .show=${show} .changes=${this._changes} ?inert=${covered}></strata-kiosk-stage>`,
      )}
      ${this.logo()} ${this.phone()}
      ${show.away ? html`<p class="sign away" role="status">${words.stored}</p>` : nothing}
      ${!session.resting && session.index === 0 && show.untouched && show.drawn ? html`<p class="sign">${words.hint}</p>` : nothing}
      ${session.place && !covered ? this.place(session.place) : nothing} ${this.panel(covered)} ${session.enlarged ? this.enlarged(asked) : nothing} ${session.resting ? this.invitation() : nothing}
      ${
        medium && !session.resting
          ? repeat(
              [medium],
              ({ id }) => id,
              () =>
                html`<strata-kiosk-player role="dialog" aria-modal="true" aria-label=${medium.alt} .session=${session} .medium=${medium} language=${session.language} ?inert=${asked}></strata-kiosk-player>`,
            )
          : nothing
      }
      ${asked ? this.question() : nothing}
    `;
  }

  /** Shows a text next to the tapped point, above it if there is enough space. */
  private place({
    title,
    about,
    x,
    y,
  }: {
    title: string;
    about: string;
    x: number;
    y: number;
  }): TemplateResult {
    return html`<div class="place-of-tap" role="status" ${styled({ "--x": `${x}px`, "--y": `${y}px` })}>
      <p><b>${title}</b>${about ? html`<span>${about}</span>` : nothing}</p>
    </div>`;
  }

  private logo(): TemplateResult | typeof nothing {
    const { self } = this.session;
    const { logo, logo_alt: alt = "" } = self?.tour.theme ?? {};
    return self && logo !== undefined
      ? html`<img class="logo" src=${addressOfFile(self, logo)} alt=${alt} draggable="false" />`
      : nothing;
  }

  private phone(): TemplateResult | typeof nothing {
    const { self, index, language, words, resting } = this.session;
    if (!self?.phone_path || resting) return nothing;
    const address = phoneAddress(location.origin, self.phone_path, { stop: index, language });
    return html`<figure class="phone" role="img" aria-label=${words.phone_code}>
      ${guard([address], () => codeOf(address))}
      <figcaption aria-hidden="true">${words.phone}</figcaption>
    </figure>`;
  }

  private alone(title: string, detail: string): TemplateResult {
    return html`<main class="alone" role="status">
      <h1>${title}</h1>
      ${detail ? html`<p>${detail}</p>` : nothing}
    </main>`;
  }

  private panel(covered: boolean): TemplateResult {
    const { session } = this;
    const { words, stops, index, resting } = session;
    const place = words.stop(index + 1, stops.length);
    return html`<main class="panel ${resting ? "resting" : ""}" ?inert=${covered}>
      <div class="words" ?inert=${session.card !== null} tabindex=${resting ? nothing : "0"} role="region" aria-label=${session.title || place}>
        ${resting ? html`<p class="tour">${session.tour?.name}</p>` : html`<p class="where">${place}${this.dots()}</p>`}
        <h1 tabindex="-1">${session.title}</h1>
        ${session.text ? html`<p>${session.text}</p>` : nothing}
      </div>
      ${resting ? nothing : html`${this.media()}${this.controls()}`} ${session.card ? this.card() : nothing}
    </main>`;
  }

  private dots(): TemplateResult | typeof nothing {
    const { stops, index } = this.session;
    return stops.length > 1 && stops.length <= kMostDots
      ? html`<span class="dots" aria-hidden="true">${stops.map((_, at) => html`<i class=${at === index ? "here" : ""}></i>`)}</span>`
      : nothing;
  }

  private controls(): TemplateResult {
    const { session } = this;
    const { words, index, stops } = session;
    const behind = session.card !== null;
    return html`${this.choices(behind)}
      <div class="row steps" ?inert=${behind}>
        <button class="previous" ?disabled=${index === 0} @click=${() => session.step(-1)}>${arrowBack}${words.previous}</button>
        ${session.languages.length > 1 ? this.languages() : nothing}
        <button class="next main" ?disabled=${index === stops.length - 1} @click=${() => session.step(1)}>${words.next}${arrowOn}</button>
      </div>`;
  }

  /** Shows the media of a stop: images as thumbnails, sounds and videos as buttons. */
  private media(): TemplateResult | typeof nothing {
    const { session } = this;
    const { words, media } = session;
    if (media.length === 0) return nothing;
    const content = (medium: ShownMedium): TemplateResult =>
      medium.kind === "picture"
        ? html`<img src=${medium.thumbnail} alt="" draggable="false" />`
        : html`${medium.kind === "video" ? filmSign : soundSign}<span>${medium.caption || medium.alt}</span>`;
    return html`<div class="row scrolls pictures media" role="group" aria-label=${words.media} ?inert=${session.card !== null}>
      ${media.map(
        (medium) =>
          html`<button class=${medium.kind} aria-label=${(medium.kind === "picture" ? words.enlarge : words.play_of)(medium.alt)} @click=${() => session.showMedium(medium)}>${content(medium)}</button>`,
      )}
    </div>`;
  }

  private choices(behind: boolean): TemplateResult | typeof nothing {
    const { session } = this;
    const { words, named } = session;
    const layers = session.show?.away ? [] : session.choices;
    if (named.length === 0 && layers.length < 2) return nothing;
    return html`<div class="choices" ?inert=${behind}>
      ${
        named.length > 0
          ? html`<div class="row scrolls" role="group" aria-label=${words.records}>
              <span class="label" aria-hidden="true">${words.records}</span>
              ${named.map(({ table, key, name }) => html`<button class="record" @click=${() => void session.openCard(table, key)}>${name}</button>`)}
            </div>`
          : nothing
      }
      ${
        layers.length > 1
          ? html`<div class="row scrolls layers" role="group" aria-label=${words.layers}>
              ${layers.map(
                (choice) =>
                  html`<button aria-pressed=${String(choice === session.choice)} @click=${() => session.chooseLayer(choice)}>${choice ? nameOfLayer(choice, session.language) : words.as_kept}</button>`,
              )}
            </div>`
          : nothing
      }
    </div>`;
  }

  private languages(): TemplateResult {
    const { session } = this;
    return html`<div class="row scrolls languages" role="group" aria-label=${session.words.languages}>
      ${session.languages.map(
        (tag) =>
          html`<button lang=${tag} aria-pressed=${String(tag === session.language)} @click=${() => session.chooseLanguage(tag)}>
            ${nameOnButton(tag)}
          </button>`,
      )}
    </div>`;
  }

  private card(): TemplateResult {
    const { session } = this;
    const { words } = session;
    const card = session.card!;
    return html`<section class="card" aria-label=${card.title}>
      <div class="words" tabindex="0" role="region" aria-label=${card.title}>
        <h2 tabindex="-1">${card.title}</h2>
        <dl>
          ${card.lines.map(
            ({ label, text }) =>
              html`<dt>${label}</dt>
                <dd>${text}</dd>`,
          )}
        </dl>
      </div>
      ${
        card.pictures.length > 0
          ? html`<div class="row scrolls pictures">
            ${card.pictures.map(
              (picture) =>
                html`<button aria-label=${words.enlarge(picture.name)} @click=${() => session.enlarge(picture)}><img src=${picture.small} alt="" draggable="false" /></button>`,
            )}
          </div>`
          : nothing
      }
      <div class="row ends"><button class="main close" @click=${() => session.closeCard()}>${words.close}</button></div>
    </section>`;
  }

  private enlarged(asked: boolean): TemplateResult {
    const { session } = this;
    const { name, large } = session.enlarged!;
    return html`<section class="over enlarged" role="dialog" aria-modal="true" aria-label=${name} ?inert=${asked} @click=${() => session.enlarge(null)}>
      <img src=${large} alt=${name} draggable="false" />
      <button>${session.words.close}</button>
    </section>`;
  }

  /** Shows the invitation in the first languages of the tour for which the page has texts. */
  private invitation(): TemplateResult {
    const { session } = this;
    const { languages } = session;
    const [first, ...others] = [
      ...new Set(languages.map((tag) => textsIn(tag, languages).begin)),
    ].slice(0, kMostInvitations);
    const begin = (): void => {
      fillScreen();
      session.touched();
    };
    return html`<button class="begin" @click=${begin}>
      <b>${first}</b>
      ${others.length > 0 ? html`<span>${others.join(" · ")}</span>` : nothing}
    </button>`;
  }

  private question(): TemplateResult {
    const { session } = this;
    const { words } = session;
    const { presence } = session.idle;
    const leftS = presence.is === "asked" ? presence.leftS : 0;
    return html`<div class="over asking" @click=${() => session.touched()}>
      <section role="alertdialog" aria-modal="true" aria-labelledby="asked" aria-describedby="anew">
        <h2 id="asked">${words.still_there}</h2>
        <span class="count" aria-hidden="true">${leftS}</span>
        <p id="anew">${words.begins_anew(leftS)}</p>
        <button class="main">${words.here}</button>
      </section>
    </div>`;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-kiosk": StrataKiosk;
  }
}
