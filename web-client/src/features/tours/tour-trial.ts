// <strata-tour-trial>: previews a stop of the edited tour on the model. It shows the visitors'
// texts, and buttons to the previous and next stop and to the editor.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import type { StopDraft } from "../../domain/tours";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.tours;

@customElement("strata-tour-trial")
export class StrataTourTrial extends LitElement {
  @property({ attribute: false }) stops: readonly StopDraft[] = [];
  @property({ type: Number }) index = 0;
  @property() language = "";
  @query("button.primary") private _back!: HTMLButtonElement;

  static override styles = [
    sharedStyles,
    css`
      section {
        position: fixed;
        z-index: 30;
        left: 50%;
        /* below the header, because notices and, on phones, the panel are at the bottom */
        top: 66px;
        transform: translateX(-50%);
        display: grid;
        gap: var(--space-2);
        width: min(520px, calc(100vw - 24px));
        padding: var(--space-3) var(--space-4);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-large);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      h2 {
        font-size: var(--text-large);
        overflow-wrap: anywhere;
      }
      p {
        max-height: 22dvh;
        overflow: auto;
        font-size: var(--text-small);
        white-space: pre-line;
        overflow-wrap: anywhere;
      }
      .next svg {
        transform: scaleX(-1);
      }
    `,
  ];

  override firstUpdated(): void {
    this._back.focus();
  }

  override render(): TemplateResult {
    const { stops, index, language } = this;
    const stop = stops[index];
    const text = stop?.text[language]?.trim();
    return html`<section aria-label=${words.trial} @keydown=${this.onKey}>
      <h2 role="status">${index + 1}. ${stop?.title[language]?.trim() || texts.unnamed}</h2>
      ${text ? html`<p lang=${language} tabindex="0">${text}</p>` : nothing}
      <div class="row">
        ${this.step(words.stop_before, "before", index - 1)} ${this.step(words.stop_next, "next", index + 1)}
        <span class="grow"></span>
        <button class="primary" @click=${this.end}>${icon("edit")}${words.trial_end}</button>
      </div>
    </section>`;
  }

  private step(label: string, way: string, index: number): TemplateResult {
    return html`<button class="icon ${way}" aria-label=${label} title=${label} ?disabled=${!this.stops[index]} @click=${() => this.go(index)}>${icon("back")}</button>`;
  }

  private go(index: number): void {
    this.dispatchEvent(new CustomEvent<number>("go", { detail: index }));
  }

  private end(): void {
    this.dispatchEvent(new CustomEvent("end"));
  }

  private onKey(event: KeyboardEvent): void {
    if (event.key !== "Escape") return;
    event.preventDefault();
    this.end();
  }
}
