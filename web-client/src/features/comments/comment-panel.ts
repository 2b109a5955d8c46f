// <strata-comment-panel>: the threads of the model as a list, with what is new to this person.

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { Thread, ThreadState } from "../../domain/comments";
import { format_count } from "../../core/locale";
import { called } from "../../domain/people";
import { FoldingPanel, folding_styles } from "../../session/folding-panel";
import { icon } from "../../ui/icons";
import { panel_line_styles } from "../../ui/panel-styles";
import { person_mark, person_mark_styles } from "../../ui/person-mark";
import { radio_group } from "../../ui/radio-group";
import { texts } from "../../texts";
import { told_time } from "../../domain/times";

const words = texts.comments;
const kStates: readonly ThreadState[] = ["open", "resolved", "all"];
const kAtOnce = 50;

@customElement("strata-comment-panel")
export class StrataCommentPanel extends FoldingPanel {
  protected readonly heading = words.title;
  @state() private most_ = kAtOnce;

  constructor() {
    super("comment");
  }

  static override styles = [
    folding_styles,
    panel_line_styles,
    person_mark_styles,
    css`
      :host {
        position: relative; /* of what is hidden for eyes */
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
        gap: 0.375rem;
        min-height: 1.25rem;
      }
      .state svg.glyph {
        width: 1rem;
        height: 1rem;
        color: var(--calm);
      }
    `,
  ];

  protected override beside_heading(): TemplateResult {
    const { open_count, unread_count } = this.session.comments;
    return html`${
      open_count > 0
        ? html`<span class="number numeric" aria-label=${words.open_count(open_count)} role="img">${format_count(open_count)}</span>`
        : nothing
    }
    ${
      unread_count > 0
        ? html`<span class="dot" role="img" aria-label=${words.unread(unread_count)} title=${words.unread(unread_count)}></span>`
        : nothing
    }`;
  }

  protected override tools(): TemplateResult {
    const { comments } = this.session;
    const label = comments.pins_shown ? words.hide_pins : words.show_pins;
    return html`<button class="icon quiet" aria-label=${label} title=${label} @click=${() => (comments.pins_shown = !comments.pins_shown)}>
      ${icon(comments.pins_shown ? "eye" : "eye_off")}
    </button>`;
  }

  protected content(): TemplateResult {
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
      ${comments.unread_count > 0 ? html`<div><button class="link" @click=${() => comments.mark_all_read()}>${words.mark_all_read}</button></div>` : nothing}
      ${
        shown.length === 0
          ? html`<p class="hint">${this.nothing_there()}</p>`
          : html`<ul>
            ${repeat(
              shown,
              ({ first }) => first.id,
              (thread) => this.row(thread),
            )}
          </ul>`
      }
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
      <button class="quiet line" data-comment=${first.id} aria-current=${comments.card === first.id} @click=${() => comments.go_to(first.id)}>
        ${person_mark(first)}
        <span><b>${called(first)}</b> <span class="hint">${told_time(newest.time)}</span></span>
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
