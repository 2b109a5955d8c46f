// <strata-together-bar>: a frame in the leader's color while this view follows another participant,
// or the names of this user's followers.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatList } from "../../core/locale";
import { called } from "../../domain/people";
import { inkOn } from "../../domain/people-here";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";
import { nameOf } from "./together";

@customElement("strata-together-bar")
export class StrataTogetherBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "together");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        z-index: 4;
        inset: 0;
        pointer-events: none;
      }
      .frame {
        position: absolute;
        inset: 0;
        border: 4px solid;
      }
      button {
        position: absolute;
        top: 0;
        left: 50%;
        max-width: calc(100% - 1.5rem);
        min-height: 2rem;
        padding: 0 var(--space-2) 0 var(--space-3);
        border: 0;
        border-radius: 0 0 var(--radius) var(--radius);
        background: var(--calm);
        color: var(--calm-ink);
        font-size: var(--text-small);
        font-weight: 600;
        transform: translateX(-50%);
        pointer-events: auto;
        box-shadow: var(--shadow);
      }
      button svg.glyph {
        flex: none;
        width: 1rem;
        height: 1rem;
      }
      .key {
        font-weight: 400;
        white-space: nowrap;
      }
      @media (max-width: 820px), (hover: none) {
        .key {
          display: none;
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { together } = this.session;
    const words = texts.together;
    if (together.followed) {
      const { color } = together.followed;
      const name = nameOf(together.followed);
      return html`<div class="frame" ${styled({ "border-color": color })}></div>
        <div role="status">
          <button
            title=${words.stop_following}
            ${styled({ background: color, color: inkOn(color) })}
            @click=${() => together.stopFollowing()}
          >
            <span class="ellipsis">${words.following(name)}</span><span class="key"> · ${words.escape_stops}</span>${icon("close")}
          </button>
        </div>`;
    }
    if (!together.leading) return html``;
    const { followers } = together;
    const names = formatList(followers.map((person) => called(person)));
    return html`<div role="status">
      <button title=${names === "" ? words.stop_leading : `${names}\n${words.stop_leading}`} @click=${() => together.lead(false)}>
        <span class="ellipsis">${words.leading(followers.length)}</span>${icon("close")}
      </button>
    </div>`;
  }
}
