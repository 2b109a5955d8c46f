// <strata-comment-pins>: pins over the 3D view, at the positions of comments. Positions behind the
// surface have no pin.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { Thread } from "../../domain/comments";
import { called, initials } from "../../domain/people";
import type { Vec3 } from "../../math/vector";
import { kPaintingTools } from "../../tools/tool";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const words = texts.comments;
const kMostPins = 10_000; // the server's limit on the comments of a model
const kMostSaid = 80; // the number of characters of the text in a pin's accessible name

interface Placed {
  thread: Thread;
  x: number;
  y: number;
  depth: number;
}

@customElement("strata-comment-pins")
export class StrataCommentPins extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "comments", "tools", "view", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        position: absolute;
        inset: 0;
        overflow: hidden;
        pointer-events: none;
      }
      button {
        position: absolute;
        left: 0;
        top: 0;
        width: 30px;
        height: 30px;
        min-height: 0;
        padding: 0;
        border: 2px solid var(--mark-light);
        border-radius: 50% 50% 50% var(--radius-tiny);
        color: var(--mark-light);
        font-size: var(--text-tiny);
        font-weight: 700;
        pointer-events: auto;
        filter: drop-shadow(0 1px 2px var(--mark-shadow));
        transition: none;
      }
      button:hover:not(:disabled) {
        border-color: var(--mark-light);
      }
      button::before {
        content: "";
        position: absolute;
        inset: -5px; /* a larger target for fingers, although pins may be close together */
      }
      button.chosen {
        outline: 3px solid var(--mark-dark);
        outline-offset: 1px;
      }
      button.resolved {
        background: var(--mark-settled);
      }
      button.draft {
        border-style: dashed;
        border-color: var(--accent);
        background: var(--raised);
        color: var(--accent);
      }
      button svg.glyph {
        width: 16px;
        height: 16px;
      }
      .aside button {
        opacity: var(--unavailable);
        pointer-events: none; /* pointer events reach the surface for painting */
      }
      i {
        position: absolute;
        top: -5px;
        right: -5px;
        width: 11px;
        height: 11px;
        border: 2px solid var(--mark-light);
        border-radius: 50%;
        background: var(--mark-news);
      }
    `,
  ];

  override render(): TemplateResult {
    const { comments, tools, view } = this.session;
    if (view.framesDrawn === 0) return html``;
    const placed = comments.pins.flatMap((thread) => this.place(thread));
    // Nearer pins cover farther ones. The Tab order follows the age of the threads.
    const order = new Map(
      [...placed]
        .sort((a, b) => b.depth - a.depth)
        .map(({ thread }, index) => [thread.first.id, index]),
    );
    placed.sort((a, b) => a.thread.first.id - b.thread.first.id);
    return html`<div class=${kPaintingTools.includes(tools.active) ? "aside" : ""} role="group" aria-label=${words.title}>
        ${repeat(
          placed,
          ({ thread }) => thread.first.id,
          (each) => this.pin(each, order.get(each.thread.first.id)!),
        )}
        ${this.draft()}
      </div>
      <span class="visually-hidden" role="status">${comments.said}</span>`;
  }

  /** Returns an empty list if the surface hides the position. */
  private place(thread: Thread): Placed[] {
    const at = this.at(thread.first.position);
    return at && this.session.comments.isSeen(thread) ? [{ thread, ...at }] : [];
  }

  private at(position: Vec3): { x: number; y: number; depth: number } | null {
    const { camera, scale } = this.session.view;
    const at = camera.projectInside(position);
    return at && { x: at.x / scale, y: at.y / scale, depth: at.depth };
  }

  private pin({ thread, x, y }: Placed, order: number): TemplateResult {
    const { comments } = this.session;
    const { id, text, state, deleted, color = null } = thread.first;
    const name = called(thread.first);
    const unread = comments.isUnread(thread);
    const resolved = state === "resolved";
    const about = deleted ? words.deleted_line : text.replace(/\s+/g, " ").slice(0, kMostSaid);
    const states = [resolved ? words.resolved : "", unread ? words.unread_here : ""]
      .filter(Boolean)
      .join(", ");
    return html`<button
      class="${resolved ? "resolved" : ""} ${comments.card === id ? "chosen" : ""}"
      data-comment=${id}
      aria-label=${words.pin(name, about, states)}
      title="${name}: ${about}"
      aria-expanded=${comments.card === id}
      ${styled({ ...tipAt(x, y), "z-index": comments.card === id ? kMostPins : order, background: resolved ? null : color })}
      @click=${() => comments.show(id)}
    >
      ${resolved ? icon("check") : initials(thread.first)}${unread ? html`<i></i>` : nothing}
    </button>`;
  }

  /**
   * Draws the pin of the unsent thread. It also appears behind the surface, so its author can find
   * it.
   */
  private draft(): TemplateResult | typeof nothing {
    const { comments } = this.session;
    const draft = comments.draft("new");
    const at = draft?.position ? this.at(draft.position) : null;
    if (!at) return nothing;
    return html`<button
      class="draft ${comments.card === "new" ? "chosen" : ""}"
      aria-label=${words.pin_draft}
      title=${words.pin_draft}
      aria-expanded=${comments.card === "new"}
      ${styled({ ...tipAt(at.x, at.y), "z-index": kMostPins })}
      @click=${() => comments.goOn()}
    >
      ${icon("edit")}
    </button>`;
  }
}

/** Places the pin with its tip, the lower left corner, at the position. */
const tipAt = (x: number, y: number): Record<string, string> => ({
  transform: `translate(${x.toFixed(1)}px, ${(y - 30).toFixed(1)}px)`,
});
