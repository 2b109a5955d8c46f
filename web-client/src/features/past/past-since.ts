// <strata-past-since>: the changes by others since this user's last visit, and a button to compare.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatList } from "../../core/locale";
import { called } from "../../domain/people";
import { toldTime } from "../../domain/times";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { layersText } from "./past-slider";

const words = texts.past;
const kNamed = 3;

@customElement("strata-past-since")
export class StrataPastSince extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "past", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        z-index: 4;
        top: 0.625rem;
        left: 50%;
        max-width: min(40rem, calc(100% - 1.25rem));
        transform: translateX(-50%);
      }
      div {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        padding: var(--space-2) var(--space-2) var(--space-2) var(--space-3);
        border-radius: var(--radius);
        background: var(--surface);
        color: var(--ink);
        font-size: var(--text-small);
        box-shadow: var(--shadow);
      }
      span {
        min-width: 0;
      }
      button {
        flex: none;
      }
    `,
  ];

  override render(): TemplateResult {
    const { news } = this.session.visits;
    if (!news) return html``;
    const names = news.people.slice(0, kNamed).map((person) => called(person));
    const others = news.people.length - names.length;
    const people =
      formatList(others > 0 ? [...names, words.others(others)] : names) || words.several;
    return html`<div role="status">
      <span
        >${words.since(toldTime(news.since.time), `${words.edits(news.edits)}${news.more ? "+" : ""}`, people, layersText(this.session, news.layers.slice(0, kNamed)))}</span
      >
      <button @click=${() => this.light(news.since.sequence)}>${words.since_show}</button>
      <button @click=${() => this.compare(news.since.sequence)}>${words.since_compare}</button>
      <button class="icon quiet" aria-label=${texts.close} title=${texts.close} @click=${() => this.session.visits.dismiss()}>
        ${icon("close")}
      </button>
    </div>`;
  }

  private light(sequence: number): void {
    this.session.visits.dismiss();
    void this.session.past.showChangesSince(sequence);
  }

  private compare(sequence: number): void {
    this.session.visits.dismiss();
    void this.session.past.compareWith(sequence);
  }
}
