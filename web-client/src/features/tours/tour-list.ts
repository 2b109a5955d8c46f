// <strata-tour-list>: the tours of the model, for curators. It is in the view panel, below the
// saved views that tours use.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { TourEntry } from "../../core/protocol.gen";
import { ask } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/panel/empty-state";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { listHeadStyles, listRowStyles } from "../../ui/panel/panel-styles";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { TourRequest } from "../../session/requests";

const words = texts.tours;

@customElement("strata-tour-list")
export class StrataTourList extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "tours");
  }

  static override styles = [
    sharedStyles,
    listHeadStyles,
    listRowStyles,
    css`
      button.open {
        gap: var(--space-half);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.session.tours.load();
  }

  override render(): TemplateResult {
    return html`<div class="row">
        <h3>${words.title}</h3>
        <button class="quiet" @click=${() => this.request({ dialog: "tour", tour: null })}>${icon("plus")}${words.new}</button>
      </div>
      ${this.list()}`;
  }

  private list(): TemplateResult {
    const { tours } = this.session;
    if (tours.failed) {
      return html`<p class="error" role="alert">${words.failed}</p>
        <div><button @click=${() => void tours.load()}>${texts.try_again}</button></div>`;
    }
    if (!tours.loaded) return html`<p class="hint">${texts.loading}</p>`;
    if (tours.all.length === 0)
      return html`<strata-empty line=${words.none} more=${words.none_more}></strata-empty>`;
    return html`<ul>
      ${repeat(
        tours.all,
        ({ id }) => id,
        (tour) => this.row(tour),
      )}
    </ul>`;
  }

  private row(tour: TourEntry): TemplateResult {
    return html`<li>
      <button class="quiet open" title=${tour.text || nothing} @click=${() => this.request({ dialog: "tour", tour })}>
        <b>${tour.name}</b>
        <span class="hint">${words.about(tour.stop_count, tour.languages.join(", "))}</span>
      </button>
      <strata-menu label=${texts.layers.options(tour.name)}>
        <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "tour", tour })}>${icon("edit")}${words.edit}</button>
        <button class="quiet" role="menuitem" @click=${() => this.request({ dialog: "kiosks", tour })}>${icon("link")}${texts.kiosks.of_tour}</button>
        <hr />
        <button class="quiet" role="menuitem" @click=${() => void this.deleteTour(tour)}>${icon("trash")}${texts.layers.delete}</button>
      </strata-menu>
    </li>`;
  }

  private request(detail: TourRequest): void {
    this.dispatchEvent(new CustomEvent<TourRequest>("request", { detail }));
  }

  private async deleteTour(tour: TourEntry): Promise<void> {
    if (
      !(await ask({
        heading: words.delete_title(tour.name),
        lead: words.delete_lead,
        yes: texts.delete,
        danger: true,
      }))
    )
      return;
    await this.session.tours.remove(tour).catch((error: unknown) => notices.error(error));
  }
}
