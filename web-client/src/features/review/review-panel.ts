// <strata-review-panel>: the edits that wait for review. Curators have buttons to accept or reject
// them.

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { labelOf } from "../../domain/cells";
import { formatCount } from "../../core/locale";
import { formatArea } from "../../domain/measure";
import { called } from "../../domain/people";
import type { Review, WaitingStroke } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { SidePanel, sidePanelStyles } from "../../session/side-panel";
import { icon } from "../../ui/icons";
import { panelLineStyles } from "../../ui/panel/panel-styles";
import { personMark, personMarkStyles } from "../../ui/person-mark";
import type { Waiting } from "./reviews";
import { texts } from "../../texts";
import { toldTime } from "../../domain/times";

const words = texts.review;
const kMostReason = 1000;

/** The strokes to reject, until the user has entered the reason. */
interface Rejecting {
  layer: number;
  what: Omit<Review, "decision" | "reason">;
}

const same = (a: Rejecting | null, layer: Layer, what: Rejecting["what"]): boolean =>
  a !== null && a.layer === layer.id && JSON.stringify(a.what) === JSON.stringify(what);

@customElement("strata-review-panel")
export class StrataReviewPanel extends SidePanel {
  protected readonly heading = words.title;
  @state() private _rejecting: Rejecting | null = null;
  @state() private _busy = false;
  @state() private _reason = "";

  constructor() {
    super("reviews", "layers", "together");
  }

  static override styles = [
    sidePanelStyles,
    panelLineStyles,
    personMarkStyles,
    css`
      h3 {
        flex: 1 1 7rem;
        min-width: 0;
        margin: 0;
        overflow-wrap: anywhere;
        font-size: var(--text-small);
      }
      .layer {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-2);
        margin-top: var(--space-2);
      }
      li {
        display: grid;
        grid-template-columns: minmax(0, 1fr) auto;
        align-items: center;
      }
      .decide {
        display: flex;
      }
      .people {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-half) var(--space-3);
      }
      form {
        grid-column: 1 / -1;
        display: grid;
        gap: var(--space-2);
        padding: var(--space-1) var(--space-2) var(--space-2);
      }
      form .row {
        justify-content: end;
      }
      .what {
        overflow-wrap: anywhere;
      }
      .more-of-it {
        grid-column: 2 / 4;
      }
    `,
  ];

  protected override besideHeading(): unknown {
    const { count } = this.session.reviews;
    return count > 0
      ? html`<span class="number" role="img" aria-label=${words.waiting(count)}>${formatCount(count)}</span>`
      : nothing;
  }

  protected content(): TemplateResult {
    const { reviews, canCurate } = this.session;
    return html`${
      reviews.failed
        ? html`<p class="error" role="alert">${words.failed}</p>
          <button @click=${() => void reviews.loadAll()}>${texts.try_again}</button>`
        : nothing
    }
    ${reviews.count === 0 && !reviews.failed ? html`<p class="hint">${canCurate ? words.none : words.none_of_you}</p>` : nothing}
    ${reviews.waiting.map((waiting) => this.layer(waiting))}`;
  }

  private layer({ layer, queue }: Waiting): TemplateResult {
    const { canCurate } = this.session;
    const hidden = queue.total - queue.strokes.length;
    const all: Rejecting["what"] = { all: true };
    return html`<div class="layer">
        <h3>${labelOf(layer)}</h3>
        ${
          canCurate
            ? html`<button class="quiet" ?disabled=${this._busy} @click=${() => void this.decide(layer, { decision: "accept", ...all })}>${words.accept_all}</button>
              <button class="quiet" ?disabled=${this._busy} @click=${() => this.ask(layer, all)}>${words.reject_all}</button>`
            : nothing
        }
      </div>
      ${same(this._rejecting, layer, all) ? this.reasonForm(layer, all) : nothing}
      ${
        canCurate && queue.people.length > 1
          ? html`<div class="people">
            ${queue.people.map(
              (person) =>
                html`<button class="link" ?disabled=${this._busy} @click=${() => void this.decide(layer, { decision: "accept", user: person.user })}>
                  ${words.accept_person(called(person), person.strokes)}
                </button>`,
            )}
          </div>`
          : nothing
      }
      <ul aria-label=${labelOf(layer)}>
        ${repeat(
          queue.strokes,
          ({ sequence }) => sequence,
          (stroke) => this.stroke(layer, stroke),
        )}
      </ul>
      ${hidden > 0 ? html`<p class="hint">${words.more(hidden)}</p>` : nothing}`;
  }

  private stroke(layer: Layer, stroke: WaitingStroke): TemplateResult {
    const { reviews, canCurate } = this.session;
    const what: Rejecting["what"] = { edits: [stroke.sequence] };
    const named = words.stroke(words.ops[stroke.op], called(stroke));
    return html`<li>
      <button class="quiet line" title=${words.look} data-waiting=${stroke.sequence} @click=${() => reviews.goTo(layer, stroke)}>
        ${personMark(stroke)}
        <span class="what"><b>${called(stroke)}</b> ${words.ops[stroke.op]}</span>
        <span></span>
        <span class="more-of-it hint">${[toldTime(stroke.time), formatArea(stroke.area_m2)].join(" · ")}</span>
      </button>
      ${
        canCurate
          ? html`<span class="decide">
            <button
              class="icon quiet"
              ?disabled=${this._busy}
              aria-label="${words.accept}: ${named}"
              title=${words.accept}
              @click=${() => void this.decide(layer, { decision: "accept", ...what })}
            >
              ${icon("check")}
            </button>
            <button class="icon quiet" ?disabled=${this._busy} aria-label="${words.reject}: ${named}" title=${words.reject} @click=${() => this.ask(layer, what)}>
              ${icon("close")}
            </button>
          </span>`
          : nothing
      }
      ${same(this._rejecting, layer, what) ? this.reasonForm(layer, what) : nothing}
    </li>`;
  }

  private reasonForm(layer: Layer, what: Rejecting["what"]): TemplateResult {
    const send = (event: Event): void => {
      event.preventDefault();
      const reason = this._reason.trim();
      void this.decide(layer, { decision: "reject", ...what, ...(reason ? { reason } : {}) });
    };
    return html`<form @submit=${send} @keydown=${this.onKey}>
      <label
        >${words.reason}
        <textarea
          rows="2"
          maxlength=${kMostReason}
          .value=${this._reason}
          @input=${(event: Event) => (this._reason = (event.target as HTMLTextAreaElement).value)}
        ></textarea>
      </label>
      <div class="row">
        <button type="button" class="quiet" @click=${this.giveUp}>${texts.cancel}</button>
        <button type="submit" ?disabled=${this._busy}>${words.reject}</button>
      </div>
    </form>`;
  }

  private async ask(layer: Layer, what: Rejecting["what"]): Promise<void> {
    this._rejecting = { layer: layer.id, what };
    this._reason = "";
    await this.updateComplete;
    this.renderRoot.querySelector("textarea")?.focus();
  }

  private readonly giveUp = (): void => {
    this._rejecting = null;
  };

  private readonly onKey = (event: KeyboardEvent): void => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    this.giveUp();
  };

  private async decide(layer: Layer, decision: Review): Promise<void> {
    this._busy = true;
    const done = await this.session.reviews.decide(layer, decision);
    const { decision: _, reason: __, ...what } = decision;
    if (done && decision.decision === "reject" && same(this._rejecting, layer, what)) this.giveUp();
    this._busy = false;
  }
}
