// <strata-marks-field>: the lines or points of a record in its form. It lists the lines or points
// on this model, and shows the number of lines or points on other models. The event `draw` starts
// the drawing tool for new lines or points on this model.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import { describeMark, type MarkKind } from "../../domain/marks";
import type { Column, Mark } from "../../core/protocol.gen";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../model-session";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.marks;

@customElement("strata-marks-field")
export class StrataMarksField extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The column of lines or points. */
  @property({ attribute: false }) column!: Column;
  @property({ attribute: false }) marks: readonly Mark[] = [];

  static override shadowRootOptions = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
      }
      .field {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-2);
        padding: var(--space-2);
        border: var(--edge) solid var(--line-strong);
        border-radius: var(--radius-small);
      }
      .mark {
        display: inline-flex;
        align-items: center;
        gap: var(--space-2);
        padding-left: var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--raised);
        font-size: var(--text-small);
      }
      .mark svg.glyph {
        width: 1rem;
        height: 1rem;
      }
      .mark button.icon {
        width: 1.875rem;
        min-height: var(--control-small);
      }
    `,
  ];

  override render(): TemplateResult {
    const { column, marks, session } = this;
    const here = marks.filter((mark) => mark.model === session.model?.id);
    const elsewhere = marks.length - here.length;
    return html`<div class="field" role="group" aria-label=${labelOf(column)}>
      ${here.map((mark) => this.mark(mark))}
      ${elsewhere > 0 ? html`<span class="hint">${words.and_elsewhere(elsewhere)}</span>` : nothing}
      <button type="button" title=${words.draw_hint} @click=${this.onDraw}>${icon(this.kind)}${words.draw}</button>
    </div>`;
  }

  private get kind(): MarkKind {
    return this.column.kind === "line" ? "line" : "point";
  }

  private mark(mark: Mark): TemplateResult {
    const name = this.session.model ? describeMark(mark, this.kind, this.session.model) : "";
    return html`<span class="mark"
      >${icon(this.kind)}${name}<button
        type="button"
        class="icon quiet"
        aria-label=${words.remove(name)}
        title=${words.remove(name)}
        @click=${() => (this.marks = this.marks.filter((each) => each !== mark))}
      >
        ${icon("close")}
      </button></span
    >`;
  }

  private readonly onDraw = (): void => {
    this.dispatchEvent(
      new CustomEvent<Column>("draw", { detail: this.column, bubbles: true, composed: true }),
    );
  };
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-marks-field": StrataMarksField;
  }
}
