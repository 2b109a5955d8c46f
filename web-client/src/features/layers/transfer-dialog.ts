// <strata-transfer-dialog>: transfers layers from another version of the scan.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import { ApiError } from "../../net/api-error";
import { readNumber } from "../../core/locale";
import { likelyToleranceMm } from "../../domain/survey-changes";
import { completeLayer, type Layer, type Model } from "../../core/types";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { layerChip } from "./legend";
import type { ModelSession } from "../../session/model-session";
import { numberInput } from "../../ui/number-input";
import { otherModels } from "./shape-kinds";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.transfer;

const kUsualAngle = 60; // in degrees

@customElement("strata-transfer-dialog")
export class StrataTransferDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _models: Model[] | null = null;
  @state() private _from = "";
  @state() private _layers: Layer[] | null = null;
  @state() private _chosen = new Set<number>();
  @state() private _problem = "";
  @state() private _problemField = "";
  @state() private _busy = false;
  @query("strata-dialog") private _dialog!: StrataDialog;
  @query("form") private _form!: HTMLFormElement | null;

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      .layers {
        display: grid;
        gap: var(--space-1);
        max-height: 260px;
        overflow: auto;
      }
      .layers label {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-height: 30px;
        min-width: 0;
      }
      form > .hint {
        margin-top: calc(-1 * var(--space-2));
      }
      .length {
        display: flex;
        align-items: center;
        gap: var(--space-2);
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
      this._models = otherModels(await api.all("GET /models", "models"), model);
      if (this._models[0]) await this.choose(String(this._models[0].id));
    } catch (error) {
      this.refuse(error);
    }
  }

  private async choose(from: string): Promise<void> {
    this._from = from;
    this._layers = null;
    this._problem = "";
    try {
      const layers = await this.session.api.all("GET /models/{model}/layers", "layers", {
        path: { model: from },
      });
      if (this._from !== from) return;
      this._layers = layers.map(completeLayer).reverse();
      this._chosen = new Set(layers.map((layer) => layer.id));
    } catch (error) {
      this.refuse(error);
    }
  }

  override render(): TemplateResult {
    return html`<strata-dialog heading=${words.title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${words.lead}</p>
      ${
        this._models === null
          ? html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`
          : this._models.length === 0
            ? html`<p>${words.no_models}</p>`
            : this.form(this._models)
      }
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <button
        slot="actions"
        class="primary"
        ?disabled=${this._busy || this._chosen.size === 0 || !this._layers}
        @click=${() => this._form?.requestSubmit()}
      >
        ${words.start}
      </button>
    </strata-dialog>`;
  }

  private form(models: readonly Model[]): TemplateResult {
    const { model } = this.session;
    return html`<form novalidate @submit=${this.onSubmit}>
      <label class="field">
        <span>${words.from}</span>
        <select name="from" @change=${(event: Event) => void this.choose((event.target as HTMLSelectElement).value)}>
          ${models.map(({ id, name }) => html`<option value=${id} ?selected=${String(id) === this._from}>${name}</option>`)}
        </select>
      </label>
      <div role="group" aria-labelledby="layers">
        <p class="caption" id="layers">${words.layers}</p>
        ${this._layers?.length === 0 ? html`<p class="hint">${words.no_layers}</p>` : nothing}
        <div class="layers">
          ${(this._layers ?? []).map(
            (layer) =>
              html`<label>
                <input
                  type="checkbox"
                  .checked=${this._chosen.has(layer.id)}
                  @change=${(event: Event) => this.check(layer, (event.target as HTMLInputElement).checked)}
                />
                ${layerChip(layer.palette)}<span class="ellipsis">${labelOf(layer)}</span>
              </label>`,
          )}
        </div>
      </div>
      <label class="field">
        <span>${words.tolerance}</span>
        <div class="length">
          ${numberInput({ name: "tolerance", value: model ? likelyToleranceMm(model) : 1, min: 0, wrong: this._problemField === "tolerance_mm" })}
          mm
        </div>
      </label>
      <p class="hint">${words.tolerance_hint}</p>
      <label class="field">
        <span>${words.angle}</span>
        <div class="length">
          ${numberInput({ name: "angle", value: kUsualAngle, min: 1, max: 180, wrong: this._problemField === "max_angle" })}
          °
        </div>
      </label>
      <p class="hint">${words.angle_hint}</p>
    </form>`;
  }

  private check(layer: Layer, checked: boolean): void {
    const chosen = new Set(this._chosen);
    if (checked) chosen.add(layer.id);
    else chosen.delete(layer.id);
    this._chosen = chosen;
  }

  private async onSubmit(event: Event): Promise<void> {
    event.preventDefault();
    const { session } = this;
    const form = new FormData(this._form!);
    const toleranceMm = readNumber(String(form.get("tolerance")));
    const maxAngle = readNumber(String(form.get("angle")));
    if (!(toleranceMm > 0)) {
      this._problemField = "tolerance_mm";
      this._problem = texts.shape.bad_length;
      return;
    }
    if (!(maxAngle >= 1 && maxAngle <= 180)) {
      this._problemField = "max_angle";
      this._problem = words.bad_angle;
      return;
    }
    const from = this._models?.find(({ id }) => String(id) === this._from);
    if (!from || !this._layers) return;
    this._busy = true;
    try {
      const all = this._chosen.size === this._layers.length;
      const { done } = await session.jobs.transfer(words.job(from.name), {
        from: this._from,
        tolerance_mm: toleranceMm,
        max_angle: maxAngle,
        ...(all ? {} : { layers: [...this._chosen].map(String) }),
      });
      void done.then((made) => session.showMade(made));
      this._dialog.close();
    } catch (error) {
      this.refuse(error);
    } finally {
      this._busy = false;
    }
  }

  private refuse(error: unknown): void {
    if (!(error instanceof ApiError)) throw error;
    this._problem = error.message;
    this._problemField = error.problem.field ?? "";
  }
}
