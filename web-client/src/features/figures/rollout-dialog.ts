// <strata-rollout-dialog>: unrolls the wall of a vessel, column or vault with this user's layers and
// surface images. It shows the fitted cylinder or cone with a small picture, and saves a PNG file.
// Its event `figure` requests the dialog of a figure with the same rollout.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatCount, formatFixed } from "../../core/locale";
import type { RolloutRequest, RolloutSheet } from "../../core/protocol.gen";
import { ApiError } from "../../net/api-error";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import "../../ui/dialog";
import { notices } from "../../ui/notices";
import { saveBlob } from "../../ui/save-from";
import { formStyles, sharedStyles } from "../../ui/styles";
import { rolloutFields, rolloutNumber, rolloutStyles } from "./rollout-fields";
import {
  kNewRollout,
  previewOf,
  rolloutRequest,
  wrongField,
  type RolloutInput,
} from "./rollout-request";

const words = texts.rollouts;
const kWaitMs = 350; // delay after the last key press

@customElement("strata-rollout-dialog")
export class StrataRolloutDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _input: RolloutInput = kNewRollout;
  @state() private _sheet: RolloutSheet | null = null;
  @state() private _picture = ""; // the object URL of the preview
  @state() private _problem = "";
  @state() private _isDrawing = false;
  @state() private _isSaving = false;
  private _timer = 0;
  private _asked: AbortController | null = null;

  static override styles = [
    sharedStyles,
    formStyles,
    rolloutStyles,
    css`
      img {
        display: block;
        max-width: 100%;
        max-height: min(50dvh, 480px);
        margin: 0 auto;
        background: var(--mark-light); /* paper is white in every theme */
        outline: var(--edge) solid var(--line);
      }
      figure {
        min-height: 200px;
        margin: 0;
      }
      figure[aria-busy="true"] img {
        opacity: 0.5;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._input = this.session.figures.draft.rollout ?? kNewRollout;
    if (wrongField(this._input) === null) void this.draw();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stop();
    URL.revokeObjectURL(this._picture);
  }

  override render(): TemplateResult {
    const { _input: input } = this;
    const { model } = this.session;
    const isWrong = wrongField(input) !== null;
    const change = (next: RolloutInput): void => this.change(next);
    return html`<strata-dialog heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p>${words.lead}</p>
      <form id="rollout" novalidate @submit=${this.onSubmit}>
        ${model ? rolloutFields(input, model, change) : nothing}
        ${rolloutNumber("pixel", `${words.pixel} (mm)`, words.pixel_hint, words.wrong_pixel, input, (part) => change({ ...input, ...part }))}
      </form>
      ${this.sheet()}
      <button slot="actions" ?disabled=${isWrong} @click=${() => this.dispatchEvent(new CustomEvent("figure"))}>${words.as_figure}</button>
      <button slot="actions" class="primary" form="rollout" ?disabled=${isWrong || this._sheet === null || this._isSaving}>${words.save}</button>
    </strata-dialog>`;
  }

  private sheet(): TemplateResult {
    const { _sheet: sheet, _picture: picture } = this;
    return html`<figure aria-busy=${this._isDrawing}>
      ${picture ? html`<img src=${picture} alt=${words.alt} />` : nothing}
      ${this._isDrawing ? html`<p role="status">${words.drawing}</p>` : nothing}
      ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
      ${sheet ? html`<figcaption class="hint">${this.fitted(sheet)}. ${words.size(formatCount(sheet.width), formatCount(sheet.height))}</figcaption>` : nothing}
    </figure>`;
  }

  private fitted(sheet: RolloutSheet): string {
    const mmPerUnit = sheet.mm_per_pixel / sheet.units_per_pixel;
    const mm = `${formatFixed(sheet.radius * mmPerUnit, 1)} mm`;
    return sheet.shape === "cone"
      ? words.cone(mm, formatFixed(Math.abs(sheet.half_angle), 1))
      : words.cylinder(mm);
  }

  private get request(): RolloutRequest | null {
    const { model, views } = this.session;
    return model && wrongField(this._input) === null
      ? rolloutRequest(this._input, model, views.content())
      : null;
  }

  private change(input: RolloutInput): void {
    this._input = input;
    this.session.figures.draft.rollout = input;
    this.stop();
    if (wrongField(this._input) === null)
      this._timer = window.setTimeout(() => void this.draw(), kWaitMs);
  }

  private stop(): void {
    clearTimeout(this._timer);
    this._asked?.abort();
    this._asked = null;
    this._isDrawing = false;
  }

  /** Gets the sheet, which is quick, and then a small picture of it. */
  private async draw(): Promise<void> {
    const { request } = this;
    if (!request) return;
    const asked = (this._asked = new AbortController());
    const { api, modelId } = this.session;
    const path = { model: modelId };
    this._isDrawing = true;
    this._problem = "";
    try {
      const sheet = await api.json("POST /models/{model}/rollout", {
        path,
        body: request,
        signal: asked.signal,
      });
      if (asked !== this._asked) return;
      this._sheet = sheet;
      const picture = await api.blob("POST /models/{model}/rollout", {
        path,
        body: previewOf(request, sheet),
        signal: asked.signal,
      });
      if (asked !== this._asked) return;
      this.show(URL.createObjectURL(picture));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return; // a newer request has been sent
      this._sheet = null;
      this.show("");
      this._problem = error.message;
    }
    this._isDrawing = false;
  }

  private show(picture: string): void {
    URL.revokeObjectURL(this._picture);
    this._picture = picture;
  }

  private async onSubmit(event: Event): Promise<void> {
    event.preventDefault();
    const { api, model, modelId } = this.session;
    const { request } = this;
    if (!request || this._isSaving) return;
    this._isSaving = true;
    try {
      const picture = await api.blob("POST /models/{model}/rollout", {
        path: { model: modelId },
        body: request,
      });
      saveBlob(picture, `${model?.slug ?? "model"}-rollout.png`);
    } catch (error) {
      notices.error(error);
    }
    this._isSaving = false;
  }
}
