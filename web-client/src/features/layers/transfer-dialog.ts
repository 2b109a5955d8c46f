// <strata-transfer-dialog>: brings layers over from another version of the scan.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { label_of } from "../../domain/cells";
import { ApiError } from "../../net/api";
import { read_number } from "../../core/locale";
import { format_number, metres_per } from "../../domain/measure";
import type { Layer, Model } from "../../core/types";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { layer_chip } from "./legend";
import type { ModelSession } from "../../session/model-session";
import { number_input } from "../../ui/number-input";
import { other_models } from "./shape-kinds";
import { form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.transfer;

const kUsualAngle = 60; // degrees

/** What a re-scan differs by, as a first guess: a 500th of the object's size, in millimetres. */
export function likely_tolerance_mm(model: Pick<Model, "bounds" | "unit">): number {
  const { min, max } = model.bounds;
  const diagonal = Math.hypot(...[0, 1, 2].map((axis) => max[axis]! - min[axis]!));
  return Number(((diagonal * metres_per(model.unit) * 1000) / 500).toPrecision(2));
}

@customElement("strata-transfer-dialog")
export class StrataTransferDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private models_: Model[] | null = null;
  @state() private from_ = "";
  @state() private layers_: Layer[] | null = null;
  @state() private chosen_ = new Set<number>();
  @state() private problem_ = "";
  @state() private problem_field_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("form") private form_!: HTMLFormElement | null;

  static override styles = [
    shared_styles,
    form_styles,
    css`
      .layers {
        display: grid;
        gap: 4px;
        max-height: 260px;
        overflow: auto;
      }
      .layers label {
        display: flex;
        align-items: center;
        gap: 10px;
        min-height: 30px;
        min-width: 0;
      }
      form > .hint {
        margin-top: -10px;
      }
      .length {
        display: flex;
        align-items: center;
        gap: 8px;
      }
      .length input {
        width: 130px;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private async load(): Promise<void> {
    const { api, model } = this.session;
    if (!model) return;
    try {
      this.models_ = other_models(await api.models(), model);
      if (this.models_[0]) await this.choose(String(this.models_[0].id));
    } catch (error) {
      this.refuse(error);
    }
  }

  private async choose(from: string): Promise<void> {
    this.from_ = from;
    this.layers_ = null;
    this.problem_ = "";
    try {
      const layers = await this.session.api.layers(from);
      if (this.from_ !== from) return;
      this.layers_ = [...layers].reverse();
      this.chosen_ = new Set(layers.map((layer) => layer.id));
    } catch (error) {
      this.refuse(error);
    }
  }

  override render(): TemplateResult {
    return html`<strata-dialog heading=${words.title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${words.lead}</p>
      ${
        this.models_ === null
          ? html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${texts.loading}</p>`
          : this.models_.length === 0
            ? html`<p>${words.no_models}</p>`
            : this.form(this.models_)
      }
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      <button
        slot="actions"
        class="primary"
        ?disabled=${this.busy_ || this.chosen_.size === 0 || !this.layers_}
        @click=${() => this.form_?.requestSubmit()}
      >
        ${words.start}
      </button>
    </strata-dialog>`;
  }

  private form(models: readonly Model[]): TemplateResult {
    const { model } = this.session;
    return html`<form novalidate @submit=${this.on_submit}>
      <label class="field">
        <span>${words.from}</span>
        <select name="from" @change=${(event: Event) => void this.choose((event.target as HTMLSelectElement).value)}>
          ${models.map(({ id, name }) => html`<option value=${id} ?selected=${String(id) === this.from_}>${name}</option>`)}
        </select>
      </label>
      <div role="group" aria-labelledby="layers">
        <p class="caption" id="layers">${words.layers}</p>
        ${this.layers_?.length === 0 ? html`<p class="hint">${words.no_layers}</p>` : nothing}
        <div class="layers">
          ${(this.layers_ ?? []).map(
            (layer) =>
              html`<label>
                <input
                  type="checkbox"
                  .checked=${this.chosen_.has(layer.id)}
                  @change=${(event: Event) => this.check(layer, (event.target as HTMLInputElement).checked)}
                />
                ${layer_chip(layer.palette)}<span class="ellipsis">${label_of(layer)}</span>
              </label>`,
          )}
        </div>
      </div>
      <label class="field">
        <span>${words.tolerance}</span>
        <div class="length">
          ${number_input({ name: "tolerance", value: model ? likely_tolerance_mm(model) : 1, min: 0, wrong: this.problem_field_ === "tolerance_mm" })}
          mm
        </div>
      </label>
      <p class="hint">${words.tolerance_hint}</p>
      <label class="field">
        <span>${words.angle}</span>
        <div class="length">
          ${number_input({ name: "angle", value: kUsualAngle, min: 1, max: 180, wrong: this.problem_field_ === "max_angle" })}
          °
        </div>
      </label>
      <p class="hint">${words.angle_hint}</p>
    </form>`;
  }

  private check(layer: Layer, checked: boolean): void {
    const chosen = new Set(this.chosen_);
    if (checked) chosen.add(layer.id);
    else chosen.delete(layer.id);
    this.chosen_ = chosen;
  }

  private async on_submit(event: Event): Promise<void> {
    event.preventDefault();
    const { session } = this;
    const form = new FormData(this.form_!);
    const tolerance_mm = read_number(String(form.get("tolerance")));
    const max_angle = read_number(String(form.get("angle")));
    if (!(tolerance_mm > 0)) {
      this.problem_field_ = "tolerance_mm";
      this.problem_ = texts.shape.bad_length;
      return;
    }
    if (!(max_angle >= 1 && max_angle <= 180)) {
      this.problem_field_ = "max_angle";
      this.problem_ = words.bad_angle;
      return;
    }
    const from = this.models_?.find(({ id }) => String(id) === this.from_);
    if (!from || !this.layers_) return;
    this.busy_ = true;
    try {
      const all = this.chosen_.size === this.layers_.length;
      const { done } = await session.jobs.transfer(words.job(from.name), {
        from: this.from_,
        tolerance_mm,
        max_angle,
        ...(all ? {} : { layers: [...this.chosen_].map(String) }),
      });
      void done.then((made) => session.show_made(made));
      this.dialog_.close();
    } catch (error) {
      this.refuse(error);
    } finally {
      this.busy_ = false;
    }
  }

  private refuse(error: unknown): void {
    if (!(error instanceof ApiError)) throw error;
    this.problem_ = error.message;
    this.problem_field_ = error.problem.field ?? "";
  }
}

/** "98.2 %" of an area, for reports. */
export const share_text = (part: number, whole: number): string =>
  whole > 0 ? `${format_number((100 * part) / whole, 3)} %` : "–";
