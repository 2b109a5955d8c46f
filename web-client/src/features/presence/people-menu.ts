// <strata-people-menu>: the initials of the participants, and a menu to follow a participant.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { formatList } from "../../core/locale";
import { called, initials, nameWith } from "../../domain/people";
import { inkOn, type PersonHere } from "../../domain/people-here";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const kMostFaces = 5;
const kMostFacesOnPhone = 2;

@customElement("strata-people-menu")
export class StrataPeopleMenu extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  private readonly _narrow = matchMedia("(max-width: 820px)");
  private readonly _resized = (): void => this.requestUpdate();

  constructor() {
    super();
    followSession(this, "together");
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this._narrow.addEventListener("change", this._resized);
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._narrow.removeEventListener("change", this._resized);
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: inline-flex;
        flex: none;
      }
      .faces {
        display: flex;
        padding: 0 var(--space-half) 0 var(--space-2);
        pointer-events: auto; /* each element has a tooltip with the name */
      }
      .face {
        display: grid;
        flex: none;
        place-items: center;
        width: 1.75rem;
        height: 1.75rem;
        border: 2px solid var(--surface);
        border-radius: 50%;
        font-size: var(--text-tiny);
        font-weight: 700;
        letter-spacing: 0.02em;
      }
      .faces .face {
        margin-left: calc(-1 * var(--space-1));
      }
      .face.rest {
        background: var(--ink-soft);
        color: var(--surface);
      }
      .face.leading {
        border-color: var(--ink);
      }
      button .face {
        border-color: transparent;
      }
      .who {
        display: grid;
        min-width: 0;
        max-width: 17.5rem;
        text-align: left;
        line-height: 1.25;
      }
      .who span {
        color: var(--ink-soft);
        font-size: var(--text-small);
      }
      button {
        min-height: 2.625rem;
        gap: var(--space-2);
        padding: var(--space-1) var(--space-3) var(--space-1) var(--space-2);
      }
      .sign {
        display: grid;
        flex: none;
        place-items: center;
        width: 1.75rem;
      }
      .alone {
        padding: var(--space-2) var(--space-3);
        color: var(--ink-soft);
      }
    `,
  ];

  override render(): TemplateResult {
    const { together } = this.session;
    const { people } = together;
    if (people.length === 0) return html``;
    const words = texts.together;
    const others = people.filter(({ viewer }) => viewer !== null);
    // On a phone, the account menu already shows a user who is alone, and the title needs the
    // space.
    if (this._narrow.matches && people.length === 1 && others.length === 0 && !together.leading)
      return html``;
    const most = this._narrow.matches ? kMostFacesOnPhone : kMostFaces;
    const seen = [
      ...people.slice(0, most).map(initials),
      ...(people.length > most ? [`+${people.length - most}`] : []),
    ].join(" ");
    const label = `${texts.people.here(people.length)}: ${formatList(people.map((person) => this.name(person)))}`;
    return html`<strata-menu wide label=${nameWith(label, seen)}>
      <span class="faces" slot="face">${this.faces(most)}</span>
      ${others.length === 0 ? html`<p class="alone">${words.nobody_else}</p>` : nothing}
      ${repeat(
        others,
        ({ user }) => user,
        (person) => this.entry(person),
      )}
      <hr />
      <button class="quiet" role="menuitem" ?disabled=${others.length === 0 && !together.leading} @click=${() => together.lead(!together.leading)}>
        <span class="sign">${icon("eye")}</span
        ><span class="who"
          ><b>${together.leading ? words.stop_leading : words.lead}</b
          ><span>${together.leading ? words.followers(together.followers.length) : words.lead_hint}</span></span
        >
      </button>
    </strata-menu>`;
  }

  private name(person: PersonHere): string {
    return person.own ? `${called(person)} (${texts.people.you})` : called(person);
  }

  private faces(most: number): TemplateResult {
    const { people } = this.session.together;
    const rest = people.slice(most);
    return html`${people.slice(0, most).map((person) => html`${face(person, this.name(person))} `)}${rest.length > 0 ? html`<span class="face rest" title=${rest.map((person) => this.name(person)).join("\n")}>+${rest.length}</span>` : nothing}`;
  }

  private entry(person: PersonHere): TemplateResult {
    const { together, session } = this.session;
    const words = texts.together;
    const { viewer } = person;
    if (!viewer) return html``;
    const follows = together.followed?.session === viewer.session;
    const able = follows || together.canFollow(person);
    const followsBack = person.following.includes(session);
    const hint = !able
      ? words.follows_you
      : person.leading
        ? words.asks
        : followsBack
          ? words.follows_you
          : "";
    const label = follows
      ? words.stop_following
      : person.own
        ? words.follow_own
        : words.follow(called(person));
    return html`<button
      class="quiet"
      role="menuitem"
      ?disabled=${!able}
      @click=${() => (follows ? together.stopFollowing() : together.follow(viewer))}
    >
      ${face(person, "")}<span class="who"><b class="ellipsis">${label}</b>${hint ? html`<span>${hint}</span>` : nothing}</span>
    </button>`;
  }
}

function face(person: PersonHere, title: string): TemplateResult {
  const { color } = person;
  return html`<span class="face ${person.leading ? "leading" : ""}" title=${title} ${styled({ background: color, color: inkOn(color) })}
    >${initials(person)}</span
  >`;
}
