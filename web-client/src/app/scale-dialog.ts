// <strata-scale-dialog>: "This object is 105 × 99 × 91 mm: right?" Corrects the unit and the up direction; nothing
// that was painted changes.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../core/api";
import { format_size, likely_unit, metres_per } from "../core/measure";
import type { Model, Unit } from "../core/types";
import "./dialog";
import type { StrataDialog } from "./dialog";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { radio_group } from "./radio-group";
import { shared_styles } from "./styles";
import { texts } from "./texts";

@customElement("strata-scale-dialog")
export class StrataScaleDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private unit_: Unit = "m";
  @state() private up_: Model["up"] = "z";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  private saved_ = false;

  static override styles = [
    shared_styles,
    css`
      .question {
        display: grid;
        gap: 5px;
      }
      .segments {
        display: flex;
      }
      .segments button {
        min-height: 38px;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    if (!this.session.model) return;
    this.unit_ = likely_unit(this.session.model);
    this.up_ = this.session.model.up;
  }

  override render(): TemplateResult {
    const { model } = this.session;
    const words = texts.scale;
    if (!model) return html``;
    const metres = metres_per(this.unit_);
    const sides = [0, 1, 2].map((axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres);
    return html`<strata-dialog aside heading=${words.title(format_size(sides))} way_out=${model.scale_verified ? texts.cancel : words.later} @closed=${this.on_closed}>
      <p class="hint">${model.unit_assumed ? words.lead_assumed : words.lead}</p>
      <div class="question">
        <span class="caption" id="unit">${words.unit}</span>
        ${radio_group<Unit>({
          label: { id: "unit" },
          class: "segments",
          choices: [
            { value: "mm", content: words.mm },
            { value: "cm", content: words.cm },
            { value: "m", content: words.m },
          ],
          chosen: this.unit_,
          choose: (unit) => (this.unit_ = unit),
        })}
      </div>
      <div class="question">
        <span class="caption" id="up">${words.up}</span>
        ${radio_group<Model["up"]>({
          label: { id: "up" },
          class: "segments",
          choices: (["x", "y", "z"] as const).map((up) => ({ value: up, content: up.toUpperCase() })),
          chosen: this.up_,
          choose: (up) => this.choose_up(up),
        })}
      </div>
      <button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => void this.confirm()}>${words.yes}</button>
    </strata-dialog>`;
  }

  private choose_up(up: Model["up"]): void {
    this.up_ = up;
    this.session.preview_up(up);
  }

  private async confirm(): Promise<void> {
    const { session } = this;
    this.busy_ = true;
    try {
      await session.change_model({ unit: this.unit_, up: this.up_, scale_verified: true });
      this.saved_ = true;
      notices.show("success", texts.scale.saved);
      this.dialog_.close();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) {
        await session.reload_model().catch((again: unknown) => notices.error(again));
        notices.show("problem", texts.scale.changed);
        if (session.model) [this.unit_, this.up_] = [session.model.unit, session.model.up];
      } else {
        notices.error(error);
      }
    } finally {
      this.busy_ = false;
    }
  }

  private on_closed(): void {
    if (!this.saved_ && this.session.model) this.session.preview_up(this.session.model.up);
    this.dispatchEvent(new CustomEvent("closed"));
  }
}
