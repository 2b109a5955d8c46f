// <strata-step-list>: a list of the user's own steps, next to Undo and Redo. A click moves back or
// forward to a step.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { formatArea } from "../../domain/measure";
import { labelOf } from "../../domain/cells";
import { colorOf, cssColor } from "../../domain/palette";
import { toldTime } from "../../domain/times";
import type { ListedStep } from "../../domain/undo-steps";
import { describeValue } from "../../session/layer-values";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";
import { Steps } from "./steps";

const words = texts.steps;

@customElement("strata-step-list")
export class StrataStepList extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The button that opened the list. */
  @property({ attribute: false }) anchor!: HTMLElement;
  @query(".list") private _list!: HTMLElement;
  private _steps!: Steps;
  private _read = ""; // the state of the layers for which the list was loaded
  private readonly _grown = new ResizeObserver(() => this.place());

  constructor() {
    super();
    followSession(this, "layers", "past", "saving", "tables");
  }

  static override styles = [
    sharedStyles,
    css`
      .list {
        position: fixed;
        inset: auto;
        box-sizing: border-box;
        width: min(22rem, calc(100vw - 1rem));
        max-height: min(32rem, calc(100dvh - 1rem));
        margin: 0;
        padding: var(--space-2);
        overflow-y: auto;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      header {
        display: flex;
        align-items: center;
        justify-content: space-between;
        gap: var(--space-2);
        padding-inline-start: var(--space-2);
      }
      h2 {
        margin: 0;
        font-size: var(--text-body);
      }
      p {
        margin: var(--space-1) var(--space-2);
      }
      ol {
        display: grid;
        gap: var(--space-half);
        margin: var(--space-1) 0 0;
        padding: 0;
        list-style: none;
      }
      li > button {
        display: grid;
        grid-template-columns: 1rem minmax(0, 1fr) auto;
        align-items: center;
        gap: 0 var(--space-2);
        width: 100%;
        padding: var(--space-1) var(--space-2);
        text-align: start;
        white-space: normal;
      }
      small {
        grid-column: 2 / -1;
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
      .size {
        font-size: var(--text-small);
        font-weight: 400;
        white-space: nowrap;
      }
      .undone {
        border-style: dashed;
      }
      .undone b {
        font-weight: 400;
        color: var(--ink-soft);
        text-decoration: line-through;
      }
      .undone .swatch {
        opacity: 0.45;
      }
      li > button[aria-current] {
        background: var(--accent-soft);
      }
      .walk {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        margin: var(--space-1) var(--space-2);
      }
      progress {
        flex: 1;
        min-width: 0;
      }
    `,
  ];

  override willUpdate(): void {
    const { session } = this;
    this._steps ??= new Steps(session.api, session.modelId, {
      mayChange: (id) => {
        const layer = session.layers.find(id);
        return layer !== null && !session.isLocked(layer);
      },
      changed: () => this.requestUpdate(),
    });
    const seen = JSON.stringify(session.layers.all.map(({ id, sequence }) => [id, sequence]));
    if (seen === this._read || this._steps.isGoing) return;
    const isFirst = this._read === "";
    this._read = seen;
    if (isFirst) void this._steps.load();
    else this._steps.loadSoon();
  }

  override firstUpdated(): void {
    this._list.showPopover();
    this._grown.observe(this._list);
    this._list.focus();
  }

  override updated(): void {
    const { activeElement } = this.shadowRoot!;
    if (activeElement && activeElement !== this._list) return;
    this.shadowRoot!.querySelector<HTMLElement>("button[aria-current]")?.focus();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._steps.stop();
    this._grown.disconnect();
  }

  override render(): TemplateResult {
    const { list, failed, progress, more, current } = this._steps;
    return html`<div
      class="list"
      popover="auto"
      tabindex="-1"
      role="dialog"
      aria-label=${words.title}
      @toggle=${this.onToggle}
      @keydown=${this.onKey}
    >
      <header>
        <h2>${words.title}</h2>
        <button class="icon quiet" aria-label=${texts.close} title=${texts.close} @click=${() => this._list.hidePopover()}>${icon("close")}</button>
      </header>
      ${
        progress
          ? html`<div class="walk" role="status">
            <span class="numeric">${words.walking(progress.done + 1, progress.of)}</span>
            <progress aria-hidden="true" max=${progress.of} value=${progress.done}></progress>
            <button @click=${() => this._steps.stop()}>${words.stop}</button>
          </div>`
          : nothing
      }
      ${
        failed
          ? html`<p class="error" role="alert">${words.failed}</p>
            <p><button @click=${() => void this._steps.load()}>${texts.try_again}</button></p>`
          : list === null
            ? html`<p class="hint" role="status">${texts.loading}</p>`
            : list.length === 0
              ? html`<p class="hint">${words.none}</p>`
              : html`<p class="hint">${words.lead}</p>
                <ol>
                  ${repeat(
                    list,
                    ({ last }) => last,
                    (step) => this.row(step, step === current),
                  )}
                  ${more ? nothing : this.begin(current === null)}
                </ol>`
      }
    </div>`;
  }

  private row(step: ListedStep, isCurrent: boolean): TemplateResult {
    const { session } = this;
    const layer = session.layers.find(step.layer);
    const color =
      layer && step.value !== undefined ? colorOf(session.layers.palette(layer), step.value) : null;
    const value =
      layer && step.value !== undefined ? describeValue(layer, step.value, session.tables) : "";
    const what = step.erase ? words.erased : words.ops[step.op];
    return html`<li>
      <button
        class="quiet ${step.isUndone ? "undone" : ""}"
        data-step=${step.last}
        aria-current=${isCurrent ? "step" : nothing}
        ?disabled=${this._steps.isGoing}
        @click=${() => void this.goTo(step)}
      >
        ${color === null ? html`<span></span>` : html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>`}
        <b class="ellipsis">${value ? `${what}: ${value}` : what}</b>
        <span class="size numeric">${step.area_m2 > 0 ? formatArea(step.area_m2) : ""}</span>
        <small class="ellipsis">${[layer ? labelOf(layer) : "", toldTime(step.time), step.isUndone ? words.undone : ""].filter(Boolean).join(" · ")}</small>
      </button>
    </li>`;
  }

  /** Renders the state before the first step. */
  private begin(isCurrent: boolean): TemplateResult {
    return html`<li>
      <button
        class="quiet"
        data-step="0"
        aria-current=${isCurrent ? "step" : nothing}
        ?disabled=${this._steps.isGoing}
        @click=${() => void this.goTo(null)}
      >
        <span></span><b>${words.before_first}</b>
      </button>
    </li>`;
  }

  private async goTo(step: ListedStep | null): Promise<void> {
    const { session } = this;
    if (session.past.isActive || session.saving.waiting > 0) {
      notices.show("info", texts.past[session.past.isActive ? "paint_refused" : "saving_first"]);
      return;
    }
    const outcome = await this._steps.goTo(step);
    switch (outcome?.ended) {
      case undefined:
      case "there":
      case "stopped":
        break;
      case "elsewhere":
        notices.show("info", words.elsewhere);
        break;
      case "refused":
        notices.show("problem", words.refused(outcome.done, outcome.of), outcome.why.message);
    }
  }

  private place(): void {
    const margin = 8;
    const anchor = this.anchor.getBoundingClientRect();
    const box = this._list.getBoundingClientRect();
    const below = innerWidth <= 820; // the tools form a row at the lower edge
    const left = below ? anchor.right - box.width : anchor.right + margin;
    const top = below ? anchor.top - box.height - margin : anchor.bottom - box.height;
    this._list.style.left = `${Math.max(margin, Math.min(left, innerWidth - box.width - margin))}px`;
    this._list.style.top = `${Math.max(margin, Math.min(top, innerHeight - box.height - margin))}px`;
  }

  private readonly onToggle = (event: ToggleEvent): void => {
    if (event.newState === "closed") this.dispatchEvent(new CustomEvent("closed"));
  };

  private readonly onKey = (event: KeyboardEvent): void => {
    const rows = [...this.shadowRoot!.querySelectorAll<HTMLElement>("[data-step]")];
    const at = rows.findIndex((row) => row === this.shadowRoot!.activeElement);
    const to =
      event.key === "ArrowDown"
        ? at + 1
        : event.key === "ArrowUp"
          ? Math.max(0, at - 1)
          : event.key === "Home"
            ? 0
            : event.key === "End"
              ? rows.length - 1
              : null;
    if (to === null) return;
    event.preventDefault();
    event.stopPropagation();
    rows[Math.min(to, rows.length - 1)]?.focus();
  };
}
