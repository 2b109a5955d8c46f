// <strata-selection-border>: a button that opens the controls for the border of the selection. They
// grow, shrink or smooth the selection by a length on the object.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { readNumber } from "../../core/locale";
import { icon } from "../../ui/icons";
import { numberInput } from "../../ui/number-input";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { Selection } from "./selection";
import { kMostMm } from "./selection-steps";

const words = texts.selection.border;

@customElement("strata-selection-border")
export class StrataSelectionBorder extends LitElement {
  @property({ attribute: false }) selection!: Selection;
  @state() private _typed: string | number = 5;
  @state() private _wrong = false;
  @query("button") private _button!: HTMLButtonElement;
  @query(".controls") private _controls!: HTMLElement;

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      .controls {
        position: fixed;
        inset: auto;
        width: 17rem;
        max-width: calc(100vw - 1rem);
        box-sizing: border-box;
        margin: 0;
        padding: var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      .controls:popover-open {
        display: grid;
        gap: var(--space-3);
      }
      label {
        display: grid;
        grid-template-columns: 1fr 6.5rem;
        align-items: center;
        gap: var(--space-3);
      }
      .ways {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2);
      }
      .ways button {
        flex: 1;
      }
    `,
  ];

  override render(): TemplateResult {
    return html`<button aria-haspopup="dialog" @click=${this.open}>${words.open}${icon("down")}</button>
      <div class="controls" popover="auto" role="dialog" tabindex="-1" aria-label=${words.title} @toggle=${this.onToggle}>
        <label>
          <span>${words.length}</span>
          <span class="number">
            ${numberInput({
              value: this._typed,
              label: words.length,
              min: 1,
              max: kMostMm,
              wrong: this._wrong,
              toldAt: "wrong",
              typed: (text) => {
                this._typed = text;
                this._wrong = false;
              },
            })}
            <span>mm</span>
          </span>
        </label>
        ${this._wrong ? html`<p class="error" id="wrong" role="alert">${words.wrong}</p>` : nothing}
        <div class="ways">
          ${this.way(words.grow, words.grow_hint, (mm) => this.selection.grow(mm))}
          ${this.way(words.shrink, words.shrink_hint, (mm) => this.selection.grow(-mm))}
          ${this.way(words.smooth, words.smooth_hint, (mm) => this.selection.smooth(mm))}
        </div>
      </div>`;
  }

  private way(name: string, hint: string, change: (mm: number) => void): TemplateResult {
    const act = (): void => {
      const mm = typeof this._typed === "number" ? this._typed : readNumber(this._typed);
      this._wrong = !(mm > 0 && mm <= kMostMm);
      if (this._wrong) this._controls.querySelector("input")?.focus();
      else change(mm);
      // The page takes the focus from a clicked button. Escape would then discard the selection.
      if (!this.shadowRoot?.activeElement) this._controls.focus();
    };
    return html`<button title=${hint} @click=${act}>${name}</button>`;
  }

  private open(): void {
    this._controls.showPopover();
    this.place();
  }

  private readonly place = (): void => {
    const anchor = this._button.getBoundingClientRect();
    const box = this._controls.getBoundingClientRect();
    const margin = 8;
    const below = anchor.bottom + 4;
    const top = below + box.height + margin <= innerHeight ? below : anchor.top - 4 - box.height;
    const left = Math.min(anchor.left, innerWidth - box.width - margin);
    this._controls.style.left = `${Math.max(margin, left)}px`;
    this._controls.style.top = `${Math.max(margin, top)}px`;
  };

  private onToggle(event: ToggleEvent): void {
    const isOpen = event.newState === "open";
    if (isOpen) this._controls.querySelector("input")?.select();
    (isOpen ? addEventListener : removeEventListener)("resize", this.place);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("resize", this.place);
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-selection-border": StrataSelectionBorder;
  }
}
