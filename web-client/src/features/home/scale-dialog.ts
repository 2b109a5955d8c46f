// <strata-scale-dialog>: asks whether the object's size is right, and corrects the unit, the up
// direction and the direction of north. Painted values do not change. The dialog is next to the
// model, which previews the choice.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { readNumber } from "../../core/locale";
import { ApiError } from "../../net/api-error";
import { kUpAxes, upName } from "../../math/camera";
import { formatSize, likelyScale, metresPer, typedNorth } from "../../domain/measure";
import type { ScaleProposal } from "../../core/protocol.gen";
import type { Model, Unit } from "../../core/types";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";
import "./points-surface";

@customElement("strata-scale-dialog")
export class StrataScaleDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _unit: Unit = "m";
  @state() private _up: Model["up"] = "z";
  @state() private _north: string | null = null; // degrees as typed, if the user changed them
  @state() private _northWrong = false;
  @state() private _busy = false;
  @query("strata-dialog") private _dialog!: StrataDialog;

  static override styles = [
    sharedStyles,
    css`
      .question {
        display: grid;
        gap: var(--space-1);
      }
      .degrees {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      .degrees input {
        width: 10em;
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
        gap: var(--space-2);
      }
      .ups button {
        display: grid;
        gap: 0;
        padding: 0;
        height: auto;
        overflow: hidden;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
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
        padding: var(--space-1) 0;
        font-weight: 600;
      }
      @media (max-width: 560px) {
        .ups {
          grid-template-columns: repeat(6, 1fr);
          gap: var(--space-1);
        }
        .ups strata-thumbnail {
          aspect-ratio: 1;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    const { model } = this.session;
    if (!model) return;
    this.take(likelyScale(model));
  }

  private take({ unit, up }: Pick<Model, "unit" | "up">): void {
    [this._unit, this._up] = [unit, up];
    this.session.previewScale({ unit, up });
  }

  override render(): TemplateResult {
    const { model } = this.session;
    const words = texts.scale;
    if (!model) return html``;
    const metres = metresPer(this._unit);
    const sides = [0, 1, 2].map(
      (axis) => (model.bounds.max[axis]! - model.bounds.min[axis]!) * metres,
    );
    const asked = model.proposal && !model.scale_verified ? model.proposal : null;
    return html`<strata-dialog docked heading=${words.title(formatSize(sides))} way_out=${model.scale_verified ? texts.cancel : words.later} @closed=${this.onClosed}>
      <p class="hint">${words.lead}</p>
      <div class="question">
        <span class="caption" id="unit">${words.unit}</span>
        ${radioGroup<Unit>({
          label: { id: "unit" },
          class: "segments",
          choices: [
            { value: "mm", content: words.mm },
            { value: "cm", content: words.cm },
            { value: "m", content: words.m },
          ],
          chosen: this._unit,
          choose: (unit) => this.take({ unit, up: this._up }),
        })}
        ${asked ? html`<p class="hint" data-reason="unit">${unitReason(asked)}</p>` : model.unit_assumed ? html`<p class="hint">${words.unit_unknown}</p>` : nothing}
      </div>
      <div class="question">
        <span class="caption" id="up">${words.up}</span>
        ${radioGroup<Model["up"]>({
          label: { id: "up" },
          class: "ups",
          choices: kUpAxes.map((up) => ({
            value: up,
            content: html`<strata-thumbnail .api=${this.session.api} .model=${model} .up=${up}></strata-thumbnail><b>${upName(up)}</b>`,
          })),
          chosen: this._up,
          choose: (up) => this.take({ unit: this._unit, up }),
        })}
        ${asked ? html`<p class="hint" data-reason="up">${upReason(asked)}</p>` : nothing}
      </div>
      <label class="question">
        <span class="caption">${words.north}</span>
        <span class="degrees">
          ${numberInput({
            name: "north",
            value: this._north ?? typedNorth(model),
            placeholder: model.crs ? words.north_of_map : words.north_unknown,
            min: -kFullTurn,
            max: kFullTurn,
            wrong: this._northWrong,
            toldAt: "north-wrong",
            typed: (text) => (this._north = text),
          })}
          °
        </span>
        <small>${words.north_lead}</small>
        ${this._northWrong ? html`<span class="error" role="alert" id="north-wrong">${texts.shape.sun.north.wrong}</span>` : nothing}
      </label>
      ${
        model.from_points
          ? html`<div class="question" role="group" aria-labelledby="points">
              <span class="caption" id="points">${texts.points.heading}</span>
              <strata-points-surface .session=${this.session} changeable></strata-points-surface>
            </div>`
          : nothing
      }
      ${model.scale_verified ? nothing : html`<p class="hint">${words.until_then(words[model.unit], upName(model.up))}</p>`}
      <button slot="actions" class="primary" ?disabled=${this._busy} @click=${() => void this.confirm()}>${words.yes}</button>
    </strata-dialog>`;
  }

  private async confirm(): Promise<void> {
    const { session } = this;
    const north = this._north?.trim() ? readNumber(this._north) : null;
    this._northWrong = north !== null && !(Math.abs(north) <= kFullTurn);
    if (this._northWrong) return;
    this._busy = true;
    try {
      await session.changeModel({
        unit: this._unit,
        up: this._up,
        ...(this._north === null ? {} : { north: north === null ? "" : String(north) }),
        scale_verified: true,
      });
      notices.show("success", texts.scale.saved);
      this._dialog.close();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) {
        await session.reloadModel().catch((again: unknown) => notices.error(again));
        notices.show("problem", texts.scale.changed);
        if (session.model) this.take(session.model);
        this._north = null;
      } else {
        notices.error(error);
      }
    } finally {
      this._busy = false;
    }
  }

  private onClosed(): void {
    this.session.previewScale(null);
    this.dispatchEvent(new CustomEvent("closed"));
  }
}

const kFullTurn = 360; // degrees
const kSure = 0.6; // below this confidence the texts present the unit as one guess among several

function unitReason({
  unit,
  unit_reason: reason,
  unit_confidence: unitConfidence,
  unit_comment: unitComment,
}: ScaleProposal): string {
  const words = texts.scale;
  switch (reason) {
    case "given":
      return words.given;
    case "format":
      return words.format;
    case "comment":
      return words.comment(unitComment ?? "");
    case "coordinates":
      return words.coordinates;
    default:
      return unitConfidence >= kSure ? words.size(words[unit]) : words.size_unsure;
  }
}

function upReason({
  up,
  up_reason: reason,
  up_confidence: upConfidence,
  up_comment: upComment,
}: ScaleProposal): string {
  const words = texts.scale;
  switch (reason) {
    case "given":
      return words.given;
    case "format":
      return words.format_up;
    case "comment":
      return words.comment_up(upComment ?? "");
    case "coordinates":
      return words.coordinates;
    case "parts":
      return words.parts;
    default:
      return upConfidence >= kSure ? words.shape(upName(up)) : words.shape_unsure(upName(up));
  }
}
