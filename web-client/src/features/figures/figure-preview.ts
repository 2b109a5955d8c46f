// <strata-figure-preview>: the sheet with the current options, redrawn shortly after each change.

import { pageLocale } from "../../core/locale";
import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { previewRequest } from "../../domain/figures";
import type { FigureRequest } from "../../core/protocol.gen";
import type { ProblemBody } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.figures;
const kWaitMs = 350; // delay after the last key press

@customElement("strata-figure-preview")
export class StrataFigurePreview extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Null as long as the options are incomplete. */
  @property({
    attribute: false,
    hasChanged: (now: FigureRequest | null, before?: FigureRequest | null) =>
      before === undefined || JSON.stringify(now) !== JSON.stringify(before),
  })
  request: FigureRequest | null = null;
  /** The text that is shown as long as the options are incomplete. */
  @property() missing = "";
  /** The text alternative of the image. */
  @property() alt = "";
  @state() private _state: "nothing" | "waiting" | "drawn" | "failed" = "nothing";
  @state() private _picture = ""; // the object URL of the image
  @state() private _problem = "";
  private _timer = 0;
  private _asked: AbortController | null = null;

  static override styles = [
    sharedStyles,
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
        padding: var(--space-3);
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
        gap: var(--space-2);
        max-width: 34em;
        text-align: center;
        overflow-wrap: anywhere;
      }
      .working {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        padding: var(--space-2) var(--space-3) var(--space-2) var(--space-2);
        border-radius: var(--radius-round);
        background: var(--surface);
        color: var(--ink);
        font-size: var(--text-small);
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
    if (changed.has("request")) this.askSoon();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stop();
    URL.revokeObjectURL(this._picture);
    this._picture = "";
  }

  override render(): TemplateResult {
    const { _state: state, _picture: picture } = this;
    const shows = picture !== "" && (state === "drawn" || state === "waiting");
    return html`<figure class=${state} data-state=${state} aria-busy=${state === "waiting"}>
      ${shows ? html`<img src=${picture} alt=${this.alt} />` : nothing}
      ${state === "waiting" ? html`<span class="working" role="status"><i></i>${words.drawing}</span>` : nothing}
      ${state === "nothing" ? html`<p class="told hint">${this.missing}</p>` : nothing}
      ${
        state === "failed"
          ? html`<div class="told">
            <p class="error" role="alert">${this._problem || words.see_field}</p>
            ${this._problem ? html`<button @click=${() => this.askSoon()}>${texts.try_again}</button>` : nothing}
          </div>`
          : nothing
      }
    </figure>`;
  }

  private stop(): void {
    clearTimeout(this._timer);
    this._asked?.abort();
    this._asked = null;
  }

  private askSoon(): void {
    this.stop();
    const { request } = this;
    this._state = request ? "waiting" : "nothing";
    if (!request) return;
    const asked = (this._asked = new AbortController());
    this._timer = window.setTimeout(
      () => void this.ask(request, asked),
      this._picture === "" ? 0 : kWaitMs,
    );
  }

  private async ask(request: FigureRequest, asked: AbortController): Promise<void> {
    const { api, modelId } = this.session;
    try {
      const picture = await api.blob("POST /models/{model}/figures", {
        path: { model: modelId },
        query: { lang: pageLocale() },
        body: previewRequest(request),
        signal: asked.signal,
      });
      if (asked !== this._asked) return;
      URL.revokeObjectURL(this._picture);
      this._picture = URL.createObjectURL(picture);
      this._state = "drawn";
      this.tell(null);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return; // a newer request has been sent
      this._state = "failed";
      this._problem = this.tell(error.problem) ? error.message : "";
    }
  }

  /**
   * Reports the problem of the request, or null. A listener that shows the problem at its field
   * prevents the event's default.
   */
  private tell(problem: ProblemBody | null): boolean {
    return this.dispatchEvent(
      new CustomEvent<ProblemBody | null>("told", { detail: problem, cancelable: true }),
    );
  }
}
