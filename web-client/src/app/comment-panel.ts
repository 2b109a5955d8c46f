// <strata-comment-panel>: the threads of the model as a list, with what is new to this person.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { Thread, ThreadState } from "../core/comments";
import { format_count } from "../core/locale";
import { folding_heading_styles } from "./folding-heading";
import { follow_session } from "./follow-session";
import { icon } from "./icons";
import { Kept } from "./kept";
import type { ModelSession } from "./model-session";
import { person_mark, person_mark_styles } from "./person-mark";
import { radio_group } from "./radio-group";
import { shared_styles } from "./styles";
import { texts } from "./texts";
import { told_time } from "./times";

const words = texts.comments;
const kStates: readonly ThreadState[] = ["open", "resolved", "all"];
const kAtOnce = 50;

@customElement("strata-comment-panel")
export class StrataCommentPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private most_ = kAtOnce;
  private readonly open_ = new Kept(() => localStorage, "strata.comment_panel_open", false);

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    folding_heading_styles,
    person_mark_styles,
    css`
      :host {
        display: block;
        position: relative; /* of what is hidden for eyes */
      }
      .number {
        font: 600 0.82rem var(--sans, inherit);
        color: var(--ink-soft);
      }
      .dot {
        flex: none;
        width: 9px;
        height: 9px;
        border-radius: 50%;
        background: var(--news);
      }
      .parts {
        display: grid;
        gap: 10px;
        margin-top: 8px;
      }
      .segments {
        display: flex;
      }
      ul {
        display: grid;
        gap: 2px;
        margin: 0 -8px;
        padding: 0;
        list-style: none;
      }
      li button {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr) auto;
        justify-content: stretch;
        align-items: start;
        gap: 1px 10px;
        width: 100%;
        min-height: 0;
        padding: 8px;
        text-align: left;
        white-space: normal;
      }
      li button .person-mark {
        grid-row: span 2;
      }
      li button[aria-current="true"] {
        background: var(--accent-soft);
      }
      li b {
        overflow-wrap: anywhere;
      }
      .said {
        grid-column: 2 / 4;
        display: -webkit-box;
        -webkit-box-orient: vertical;
        -webkit-line-clamp: 2;
        overflow: hidden;
        overflow-wrap: anywhere;
        font-size: 0.88rem;
        unicode-bidi: plaintext;
      }
      .said.gone {
        color: var(--ink-soft);
        font-style: italic;
      }
      .state {
        display: flex;
        align-items: center;
        gap: 6px;
        min-height: 20px;
      }
      .state svg.glyph {
        width: 16px;
        height: 16px;
        color: var(--calm);
      }
    `,
  ];

  override render(): TemplateResult {
    const { comments } = this.session;
    const open = this.open_.value;
    const unread = comments.unread_count;
    return html`<div class="heading">
        <h2>
          <button class="quiet" aria-expanded=${open} aria-controls="parts" @click=${this.toggle}>
            ${icon("up")}${words.title}
            ${comments.open_count > 0
              ? html`<span class="number numeric" aria-label=${words.open_count(comments.open_count)} role="img">${format_count(comments.open_count)}</span>`
              : nothing}
            ${unread > 0 ? html`<span class="dot" role="img" aria-label=${words.unread(unread)} title=${words.unread(unread)}></span>` : nothing}
          </button>
        </h2>
        <button
          class="icon quiet"
          aria-label=${comments.pins_shown ? words.hide_pins : words.show_pins}
          title=${comments.pins_shown ? words.hide_pins : words.show_pins}
          @click=${() => (comments.pins_shown = !comments.pins_shown)}
        >
          ${icon(comments.pins_shown ? "eye" : "eye_off")}
        </button>
      </div>
      <div id="parts" class="parts" ?hidden=${!open}>${open ? this.content(unread) : nothing}</div>`;
  }

  private readonly toggle = (): void => {
    this.open_.value = !this.open_.value;
    this.requestUpdate();
  };

  private content(unread: number): TemplateResult {
    const { comments } = this.session;
    if (comments.failed) {
      return html`<p class="error" role="alert">${words.failed}</p>
        <button @click=${() => void comments.load()}>${texts.try_again}</button>`;
    }
    const listed = comments.listed;
    const shown = listed.slice(0, this.most_);
    return html`${radio_group({
        label: words.state,
        class: "segments",
        choices: kStates.map((value) => ({ value, content: words.states[value] })),
        chosen: comments.state,
        choose: (value) => comments.choose_state(value),
      })}
      <div class="row">
        <input
          type="text"
          autocomplete="off"
          aria-label=${words.find}
          placeholder=${words.find_hint}
          .value=${comments.words}
          @input=${(event: Event) => comments.list({ words: (event.target as HTMLInputElement).value })}
        />
        <button class="quiet" aria-pressed=${comments.mine} title=${words.mine_hint} @click=${() => comments.list({ mine: !comments.mine })}>
          ${comments.mine ? icon("check") : nothing}${words.mine}
        </button>
      </div>
      ${unread > 0 ? html`<div><button class="link" @click=${() => comments.mark_all_read()}>${words.mark_all_read}</button></div>` : nothing}
      ${shown.length === 0
        ? html`<p class="hint">${this.nothing_there()}</p>`
        : html`<ul>
            ${repeat(
              shown,
              ({ first }) => first.id,
              (thread) => this.row(thread),
            )}
          </ul>`}
      ${listed.length > shown.length ? html`<button @click=${() => (this.most_ += kAtOnce)}>${words.more(listed.length - shown.length)}</button>` : nothing}`;
  }

  private nothing_there(): string {
    const { comments, can_paint } = this.session;
    if (!comments.loaded) return texts.loading;
    if (comments.threads.length > 0) return words.none_found;
    return can_paint ? words.none : words.none_viewer;
  }

  private row(thread: Thread): TemplateResult {
    const { comments } = this.session;
    const { first, replies } = thread;
    const newest = replies[replies.length - 1] ?? first;
    return html`<li>
      <button class="quiet" data-comment=${first.id} aria-current=${comments.card === first.id} @click=${() => comments.go_to(first.id)}>
        ${person_mark(first.user)}
        <span><b>${first.user}</b> <span class="hint">${told_time(newest.time)}</span></span>
        <span class="state">
          ${replies.length > 0 ? html`<span class="hint numeric" role="img" aria-label=${words.replies(replies.length)} title=${words.replies(replies.length)}>${format_count(replies.length)}</span>` : nothing}
          ${first.state === "resolved" ? html`<span role="img" aria-label=${words.resolved} title=${words.resolved}>${icon("check")}</span>` : nothing}
          ${comments.is_unread(thread) ? html`<span class="dot" role="img" aria-label=${words.unread_here} title=${words.unread_here}></span>` : nothing}
        </span>
        <span class="said ${first.deleted ? "gone" : ""}">${first.deleted ? words.deleted_line : first.text}</span>
      </button>
    </li>`;
  }
}
