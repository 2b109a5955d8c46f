// <strata-scale-dialog>: "This object is 105 × 99 × 91 mm: right?" Corrects the unit and the up
// direction; nothing that was painted changes. It stands beside the model, which shows what is
// chosen while the question stands.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { kUpAxes, up_name } from "../../math/camera";
import { format_size, likely_scale, metres_per } from "../../domain/measure";
import type { ScaleProposal } from "../../core/protocol.gen";
import type { Model, Unit } from "../../core/types";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { radio_group } from "../../ui/radio-group";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";

@customElement("strata-scale-dialog")
export class StrataScaleDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private unit_: Unit = "m";
  @state() private up_: Model["up"] = "z";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;

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
      .ups {
        display: grid;
        grid-template-columns: repeat(3, 1fr);
        gap: 0.5rem;
      }
      .ups button {
        display: grid;
        gap: 0;
        padding: 0;
        height: auto;
        overflow: hidden;
        border: var(--edge) solid var(--line);
        border-radius: 8px;
      }
      .ups button[aria-checked="true"] {
        border-color: var(--accent);
        outline: var(--focus);
        outline-offset: 0;
      }
      .ups button[aria-checked="true"] b {
        background: var(--accent);
        color: var(--accent-ink);
      }
      .ups b {
        padding: 3px 0;
        font-weight: 600;
      }
      @media (max-width: 560px) {
        .ups {
          grid-template-columns: repeat(6, 1fr);
          gap: 0.25rem;
        }
        .ups strata-thumbnail {
          aspect-ratio: 1;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.session.model) this.take(likely_scale(this.session.model));
  }

  private take({ unit, up }: Pick<Model, "unit" | "up">): void {
    [this.unit_, this.up_] = [unit, up];
    this.session.preview_scale({ unit, up });
  }

  override render(): TemplateResult {
    const { model } = this.session;
    const words = texts.scale;
    if (!model) return html``;
    const metres = metres_per(this.unit_);
    const sides = [0, 1, 2].map(
      (axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres,
    );
    const asked = model.proposal && !model.scale_verified ? model.proposal : null;
    return html`<strata-dialog docked heading=${words.title(format_size(sides))} way_out=${model.scale_verified ? texts.cancel : words.later} @closed=${this.on_closed}>
      <p class="hint">${words.lead}</p>
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
          choose: (unit) => this.take({ unit, up: this.up_ }),
        })}
        ${asked ? html`<p class="hint" data-reason="unit">${unit_reason(asked)}</p>` : model.unit_assumed ? html`<p class="hint">${words.unit_unknown}</p>` : nothing}
      </div>
      <div class="question">
        <span class="caption" id="up">${words.up}</span>
        ${radio_group<Model["up"]>({
          label: { id: "up" },
          class: "ups",
          choices: kUpAxes.map((up) => ({
            value: up,
            content: html`<strata-thumbnail .api=${this.session.api} .model=${model} .up=${up}></strata-thumbnail><b>${up_name(up)}</b>`,
          })),
          chosen: this.up_,
          choose: (up) => this.take({ unit: this.unit_, up }),
        })}
        ${asked ? html`<p class="hint" data-reason="up">${up_reason(asked)}</p>` : nothing}
      </div>
      ${model.scale_verified ? nothing : html`<p class="hint">${words.until_then(words[model.unit], up_name(model.up))}</p>`}
      <button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => void this.confirm()}>${words.yes}</button>
    </strata-dialog>`;
  }

  private async confirm(): Promise<void> {
    const { session } = this;
    this.busy_ = true;
    try {
      await session.change_model({ unit: this.unit_, up: this.up_, scale_verified: true });
      notices.show("success", texts.scale.saved);
      this.dialog_.close();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) {
        await session.reload_model().catch((again: unknown) => notices.error(again));
        notices.show("problem", texts.scale.changed);
        if (session.model) this.take(session.model);
      } else {
        notices.error(error);
      }
    } finally {
      this.busy_ = false;
    }
  }

  private on_closed(): void {
    this.session.preview_scale(null);
    this.dispatchEvent(new CustomEvent("closed"));
  }
}

const kSure = 0.6; // below it the words say that it is a guess among several

function unit_reason({
  unit,
  unit_reason: reason,
  unit_confidence,
  unit_comment,
}: ScaleProposal): string {
  const words = texts.scale;
  switch (reason) {
    case "given":
      return words.given;
    case "format":
      return words.format;
    case "comment":
      return words.comment(unit_comment ?? "");
    case "coordinates":
      return words.coordinates;
    default:
      return unit_confidence >= kSure ? words.size(words[unit]) : words.size_unsure;
  }
}

function up_reason({ up, up_reason: reason, up_confidence, up_comment }: ScaleProposal): string {
  const words = texts.scale;
  switch (reason) {
    case "given":
      return words.given;
    case "format":
      return words.format_up;
    case "comment":
      return words.comment_up(up_comment ?? "");
    case "coordinates":
      return words.coordinates;
    default:
      return up_confidence >= kSure ? words.shape(up_name(up)) : words.shape_unsure(up_name(up));
  }
}
