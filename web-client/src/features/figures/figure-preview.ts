// <strata-figure-preview>: the sheet as it would be now, drawn anew a moment after what is asked
// for has changed.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { preview_request } from "../../domain/figures";
import type { FigureRequest } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.figures;
const kWait_ms = 350; // until somebody has stopped to type

@customElement("strata-figure-preview")
export class StrataFigurePreview extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Null: nothing can be drawn yet. */
  @property({
    attribute: false,
    hasChanged: (now: FigureRequest | null, before?: FigureRequest | null) =>
      before === undefined || JSON.stringify(now) !== JSON.stringify(before),
  })
  request: FigureRequest | null = null;
  /** What the picture shows, for who does not see it. */
  @property() alt = "";
  @state() private state_: "nothing" | "waiting" | "drawn" | "failed" = "nothing";
  @state() private picture_ = ""; // address
  @state() private problem_ = "";
  private timer_ = 0;
  private asked_: AbortController | null = null;

  static override styles = [
    shared_styles,
    css`
      :host {
        display: block;
      }
      figure {
        position: relative;
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        place-items: center;
        min-height: var(--least-sheet, 260px);
        margin: 0;
        padding: 14px;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--paper);
      }
      img {
        display: block;
        max-width: 100%;
        max-height: var(--most-sheet, min(64dvh, 660px));
        background: var(--mark-light); /* paper is white in every theme */
        box-shadow: var(--shadow);
        outline: var(--edge) solid var(--line);
      }
      .waiting img {
        opacity: 0.5;
      }
      .told {
        display: grid;
        justify-items: center;
        gap: 10px;
        max-width: 34em;
        text-align: center;
        overflow-wrap: anywhere;
      }
      .working {
        display: flex;
        align-items: center;
        gap: 9px;
        padding: 6px 14px 6px 10px;
        border-radius: 99px;
        background: var(--surface);
        color: var(--ink);
        font-size: 0.86rem;
        box-shadow: var(--shadow);
      }
      img + .working {
        position: absolute;
        top: 24px;
      }
      .working i {
        width: 17px;
        height: 17px;
        border: 3px solid var(--accent-soft);
        border-top-color: var(--accent);
        border-radius: 50%;
        animation: turn 900ms linear infinite;
      }
      @keyframes turn {
        to {
          rotate: 1turn;
        }
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("request")) this.ask_soon();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stop();
    URL.revokeObjectURL(this.picture_);
    this.picture_ = "";
  }

  override render(): TemplateResult {
    const { state_: state, picture_: picture } = this;
    const shows = picture !== "" && (state === "drawn" || state === "waiting");
    return html`<figure class=${state} data-state=${state} aria-busy=${state === "waiting"}>
      ${shows ? html`<img src=${picture} alt=${this.alt} />` : nothing}
      ${state === "waiting" ? html`<span class="working" role="status"><i></i>${words.drawing}</span>` : nothing}
      ${state === "nothing" ? html`<p class="told hint">${words.no_face}</p>` : nothing}
      ${
        state === "failed"
          ? html`<div class="told">
            <p class="error" role="alert">${this.problem_ || words.see_field}</p>
            ${this.problem_ ? html`<button @click=${() => this.ask_soon()}>${texts.try_again}</button>` : nothing}
          </div>`
          : nothing
      }
    </figure>`;
  }

  private stop(): void {
    clearTimeout(this.timer_);
    this.asked_?.abort();
    this.asked_ = null;
  }

  private ask_soon(): void {
    this.stop();
    const { request } = this;
    this.state_ = request ? "waiting" : "nothing";
    if (!request) return;
    const asked = (this.asked_ = new AbortController());
    this.timer_ = window.setTimeout(
      () => void this.ask(request, asked),
      this.picture_ === "" ? 0 : kWait_ms,
    );
  }

  private async ask(request: FigureRequest, asked: AbortController): Promise<void> {
    const { api, model_id } = this.session;
    try {
      const picture = await api.figure(model_id, preview_request(request), asked.signal);
      if (asked !== this.asked_) return;
      URL.revokeObjectURL(this.picture_);
      this.picture_ = URL.createObjectURL(picture);
      this.state_ = "drawn";
      this.tell(null);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this.asked_) return; // something else is asked for
      this.state_ = "failed";
      this.problem_ = this.tell(error.problem) ? error.message : "";
    }
  }

  /**
   * What is wrong with the request, or null; who shows it at its field prevents the event's
   * default.
   */
  private tell(problem: ProblemBody | null): boolean {
    return this.dispatchEvent(
      new CustomEvent<ProblemBody | null>("told", { detail: problem, cancelable: true }),
    );
  }
}
