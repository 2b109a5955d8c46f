// <strata-comment-panel>: the model's threads as a list that marks unread ones.

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { Thread, ThreadState } from "../../domain/comments";
import { formatCount } from "../../core/locale";
import { called } from "../../domain/people";
import { SidePanel, sidePanelStyles } from "../../session/side-panel";
import "../../ui/panel/empty-state";
import { icon } from "../../ui/icons";
import { panelLineStyles } from "../../ui/panel/panel-styles";
import { personMark, personMarkStyles } from "../../ui/person-mark";
import { radioGroup } from "../../ui/radio-group";
import { texts } from "../../texts";
import { toldTime } from "../../domain/times";

const words = texts.comments;
const kStates: readonly ThreadState[] = ["open", "resolved", "all"];
const kAtOnce = 50;

@customElement("strata-comment-panel")
export class StrataCommentPanel extends SidePanel {
  protected readonly heading = words.title;
  @state() private _most = kAtOnce;

  constructor() {
    super("comments", "layers", "tables", "together");
  }

  static override styles = [
    sidePanelStyles,
    panelLineStyles,
    personMarkStyles,
    css`
      :host {
        position: relative; /* contains visually hidden content */
      }
      .dot {
        flex: none;
        width: 0.5625rem;
        height: 0.5625rem;
        border-radius: 50%;
        background: var(--news);
      }
      .line[aria-current="true"] {
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
        font-size: var(--text-small);
        unicode-bidi: plaintext;
      }
      .said.gone {
        color: var(--ink-soft);
        font-style: italic;
      }
      .state {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-height: 1.25rem;
      }
      .state svg.glyph {
        width: 1rem;
        height: 1rem;
        color: var(--calm);
      }
    `,
  ];

  protected override tools(): TemplateResult {
    const { comments } = this.session;
    const label = comments.pinsShown ? words.hide_pins : words.show_pins;
    return html`<button class="icon quiet" aria-label=${label} title=${label} @click=${() => (comments.pinsShown = !comments.pinsShown)}>
      ${icon(comments.pinsShown ? "eye" : "eye_off")}
    </button>`;
  }

  protected content(): TemplateResult {
    const { comments } = this.session;
    if (comments.failed) {
      return html`<p class="error" role="alert">${words.failed}</p>
        <button @click=${() => void comments.load()}>${texts.try_again}</button>`;
    }
    const listed = comments.listed;
    const shown = listed.slice(0, this._most);
    return html`${radioGroup({
      label: words.state,
      class: "segments",
      choices: kStates.map((value) => ({ value, content: words.states[value] })),
      chosen: comments.state,
      choose: (value) => comments.chooseState(value),
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
      ${comments.unreadCount > 0 ? html`<div><button class="link" @click=${() => comments.markAllRead()}>${words.mark_all_read}</button></div>` : nothing}
      ${
        shown.length === 0
          ? this.nothingThere()
          : html`<ul>
            ${repeat(
              shown,
              ({ first }) => first.id,
              (thread) => this.row(thread),
            )}
          </ul>`
      }
      ${listed.length > shown.length ? html`<button @click=${() => (this._most += kAtOnce)}>${words.more(listed.length - shown.length)}</button>` : nothing}`;
  }

  private nothingThere(): TemplateResult {
    const { comments, canPaint } = this.session;
    const isNone = comments.loaded && comments.threads.length === 0;
    const line = isNone ? words.none : comments.loaded ? words.none_found : texts.loading;
    return html`<strata-empty line=${line} more=${isNone && canPaint ? words.none_more : ""}></strata-empty>`;
  }

  private row(thread: Thread): TemplateResult {
    const { comments } = this.session;
    const { first, replies } = thread;
    const newest = replies[replies.length - 1] ?? first;
    return html`<li>
      <button class="quiet line" data-comment=${first.id} aria-current=${comments.card === first.id} @click=${() => comments.goTo(first.id)}>
        ${personMark(first)}
        <span><b>${called(first)}</b> <span class="hint">${toldTime(newest.time)}</span></span>
        <span class="state">
          ${replies.length > 0 ? html`<span class="hint" role="img" aria-label=${words.replies(replies.length)} title=${words.replies(replies.length)}>${formatCount(replies.length)}</span>` : nothing}
          ${first.state === "resolved" ? html`<span role="img" aria-label=${words.resolved} title=${words.resolved}>${icon("check")}</span>` : nothing}
          ${comments.isUnread(thread) ? html`<span class="dot" role="img" aria-label=${words.unread_here} title=${words.unread_here}></span>` : nothing}
        </span>
        <span class="said ${first.deleted ? "gone" : ""}">${first.deleted ? words.deleted_line : first.text}</span>
      </button>
    </li>`;
  }
}
