// <strata-rollout-dialog>: unrolls the wall of a vessel, column or vault with this user's layers and
// surface images. It shows the fitted cylinder or cone with a small picture, on which the user can
// paint, and saves a PNG file. Its event `figure` requests the dialog of a figure with the same
// rollout.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { formatCount, formatFixed } from "../../core/locale";
import type { RolloutRequest, RolloutSheet } from "../../core/protocol.gen";
import { ApiError } from "../../net/api-error";
import { followSession } from "../../session/follow-session";
import { sightOnSheet } from "../../session/mark-sight";
import type { ModelSession } from "../../session/model-session";
import "../../session/picture/picture-canvas";
import type { StrataPictureCanvas } from "../../session/picture/picture-canvas";
import { isPaint, type DrawnPart, type PicturePart } from "../../session/picture/picture-drawing";
import { PicturePainting } from "../../session/picture/picture-painting";
import { PictureTools, pictureToolStyles } from "../../session/picture/picture-tools";
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
import { isSameSheet, sheetOrigin, fixedSheet, withinSheet } from "./rollout-sheet";

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
  @query("strata-picture-canvas") private _canvas!: StrataPictureCanvas | null;
  // The sheet of the picture, and the width of its pixels.
  private _shown: { sheet: RolloutSheet; origin: [number, number]; pixelMm: number } | null = null;
  private _timer = 0;
  private _asked: AbortController | null = null;
  private _painting!: PicturePainting;
  private readonly _tools = new PictureTools(this, {
    session: () => this.session,
    painting: () => this._painting,
    unit: "mm",
    left: () => this._canvas?.discard(),
    zoomed: () => void this._painting.redraw(),
  });

  constructor() {
    super();
    followSession(this, "painting", "layers", "marks", "tables", "views");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    rolloutStyles,
    pictureToolStyles,
    css`
      form {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(min(15rem, 100%), 1fr));
        align-items: start;
        gap: var(--space-3) var(--space-4);
      }
      figure {
        min-height: 200px;
        margin: 0;
      }
      figure[aria-busy="true"] .idle {
        opacity: 0.5;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    const { session } = this;
    this._input = session.figures.draft.rollout ?? kNewRollout;
    this._tools.start();
    this._painting = new PicturePainting({
      showsMarks: () => false,
      api: session.api,
      modelId: session.modelId,
      target: (erases) => session.painting.areaTarget(erases),
      showChange: (texels, areaM2) => session.painting.showChange(texels, areaM2),
      failed: (error) => notices.error(error),
      redraw: () => this.draw(),
      changed: () => this.requestUpdate(),
    });
    if (wrongField(this._input) === null) void this._painting.redraw();
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
    return html`<strata-dialog broad heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
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
    const { _sheet: sheet, _picture: picture, _tools: tools } = this;
    const shown = picture ? this._shown : null;
    return html`${shown && this.session.canPaint ? this._tools.render() : nothing}
    <figure aria-busy=${this._isDrawing}>
      ${
        shown
          ? html`<strata-picture-canvas
              class=${tools.tool === "move" ? "idle" : ""}
              .picture=${picture}
              .alt=${words.alt}
              .label=${words.paint_on}
              .origin=${shown.origin}
              .unitPerPixel=${shown.pixelMm}
              .tool=${tools.tool}
              .radius=${tools.radius}
              .waiting=${this._painting.waiting}
              .color=${tools.color}
              ?zoomed=${tools.zoom > 1}
              @drawn=${(event: CustomEvent<PicturePart>) => this.paint(shown.sheet, { part: event.detail, color: tools.color })}
            ></strata-picture-canvas>`
          : nothing
      }
      ${this._isDrawing ? html`<p role="status">${words.drawing}</p>` : nothing}
      ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
      ${sheet ? html`<figcaption class="hint">${this.fitted(sheet)}. ${words.size(formatCount(sheet.width), formatCount(sheet.height))}</figcaption>` : nothing}
    </figure>`;
  }

  private paint(sheet: RolloutSheet, drawn: DrawnPart): void {
    const { api, modelId: model } = this.session;
    const { part } = drawn;
    if (isPaint(part)) {
      this._painting.paint(drawn, async ({ layer, paint }) => {
        const body = { within: withinSheet(sheet, part), into: { layer: layer.id, ...paint } };
        return (await api.json("POST /models/{model}/select", { path: { model }, body })).edit;
      });
      return;
    }
    const { marks } = this.session;
    const host = { api, model: this.session.model! };
    const mmPerPixel = this._canvas?.unitPerCssPixel() ?? sheet.mm_per_pixel;
    const sight = sightOnSheet(host, fixedSheet(sheet), mmPerPixel);
    this._painting.mark(drawn, () =>
      "line" in part ? marks.finishLine(part.line, sight) : marks.setPoint(part.point, sight),
    );
  }

  private fitted(sheet: RolloutSheet): string {
    const mmPerUnit = sheet.mm_per_pixel / sheet.units_per_pixel;
    const mm = `${formatFixed(sheet.radius * mmPerUnit, 1)} mm`;
    switch (sheet.shape) {
      case "cone":
        return words.cone(mm, formatFixed(Math.abs(sheet.half_angle), 1));
      case "cylinder":
        return words.cylinder(mm);
      case "general_cylinder":
        return words.general_cylinder(mm);
    }
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
    this._canvas?.discard();
    this._painting.leavePicture();
    if (wrongField(this._input) === null)
      this._timer = window.setTimeout(() => void this._painting.redraw(), kWaitMs);
  }

  private stop(): void {
    clearTimeout(this._timer);
    this._asked?.abort();
    this._asked = null;
    this._isDrawing = false;
  }

  /**
   * Gets the sheet, which is quick, and then a small picture of it. Returns whether the picture is
   * shown.
   */
  private async draw(): Promise<boolean> {
    const { request } = this;
    if (!request || !this.isConnected) return false;
    this.stop();
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
      if (asked !== this._asked) return false;
      this._sheet = sheet;
      const preview = previewOf(request, sheet, this._tools.zoom);
      const picture = await api.blob("POST /models/{model}/rollout", {
        path,
        body: preview,
        signal: asked.signal,
      });
      if (asked !== this._asked) return false;
      const last = this._shown?.sheet;
      const isSame = last !== undefined && isSameSheet(last, sheet);
      if (!isSame) {
        this._canvas?.discard();
        this._painting.leavePicture();
      }
      this._shown =
        isSame && this._shown
          ? { ...this._shown, pixelMm: preview.mm_per_pixel }
          : { sheet, origin: sheetOrigin(sheet), pixelMm: preview.mm_per_pixel };
      this.show(URL.createObjectURL(picture));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return false; // a newer request has been sent
      this._sheet = null;
      this.show("");
      this._problem = error.message;
    }
    this._isDrawing = false;
    return this._picture !== "";
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
