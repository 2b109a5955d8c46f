// <strata-photograph-dialog>: a photograph without the distortion of its lens, with the model as its
// camera sees it: over the photograph or next to it. Annotators paint and draw on the photograph.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { formatPercent } from "../../core/locale";
import type { EditResult, Photograph } from "../../core/protocol.gen";
import { mayDownload } from "../../core/types";
import { ApiError } from "../../net/api-error";
import { followSession } from "../../session/follow-session";
import { sightThrough } from "../../session/mark-sight";
import type { ModelSession } from "../../session/model-session";
import "../../session/picture/picture-canvas";
import type { StrataPictureCanvas } from "../../session/picture/picture-canvas";
import { isPaint, type DrawnPart, type PicturePart } from "../../session/picture/picture-drawing";
import { PicturePainting, type PictureTarget } from "../../session/picture/picture-painting";
import { PictureTools, pictureToolStyles } from "../../session/picture/picture-tools";
import { texts } from "../../texts";
import "../../ui/dialog";
import { icon } from "../../ui/icons";
import { notices } from "../../ui/notices";
import { radioGroup } from "../../ui/radio-group";
import { formStyles, sharedStyles } from "../../ui/styles";
import { editThrough, frameThrough, toPixel, windowOf } from "./through";

const words = texts.photograph;
const kSamples = 4; // per pixel of the model's picture

type Arrangement = "over" | "beside";

@customElement("strata-photograph-dialog")
export class StrataPhotographDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) photograph!: Photograph;
  @state() private _arrangement: Arrangement = "over";
  @state() private _opacity = 0.5;
  @state() private _picture = ""; // the object URL of the photograph
  @state() private _model = ""; // the object URL of the model's picture
  @state() private _problem = "";
  @state() private _isDrawing = false;
  @query("strata-picture-canvas") private _canvas!: StrataPictureCanvas | null;
  private _width = 0; // of the photograph's picture
  private _asked: AbortController | null = null;
  private _painting!: PicturePainting;
  private readonly _tools = new PictureTools(this, {
    session: () => this.session,
    painting: () => this._painting,
    unit: "px",
    left: () => this._canvas?.discard(),
    zoomed: () => void this.readPicture(),
  });

  constructor() {
    super();
    followSession(this, "painting", "layers", "marks", "tables");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    pictureToolStyles,
    css`
      .pictures {
        display: grid;
        gap: var(--space-3);
      }
      .pictures.beside {
        grid-template-columns: repeat(2, minmax(0, 1fr));
      }
      .pictures > img {
        width: 100%;
      }
      .opacity {
        display: flex;
        align-items: center;
        gap: var(--space-3);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    const { session } = this;
    this._tools.start();
    this._painting = new PicturePainting({
      showsMarks: () => true,
      api: session.api,
      modelId: session.modelId,
      target: (erases) => session.painting.areaTarget(erases),
      showChange: (texels, areaM2) => session.painting.showChange(texels, areaM2),
      failed: (error) => notices.error(error),
      redraw: () => this.drawModel(),
      changed: () => this.requestUpdate(),
    });
    void this.readPicture();
    void this._painting.redraw();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._asked?.abort();
    for (const url of [this._picture, this._model]) URL.revokeObjectURL(url);
  }

  override render(): TemplateResult {
    const { _arrangement: arrangement, photograph, _tools: tools, session } = this;
    const over = arrangement === "over";
    return html`<strata-dialog broad heading=${photograph.name} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <div class="painting">
        ${radioGroup<Arrangement>({
          label: words.arrangement,
          class: "segments",
          choices: [
            { value: "over", content: words.over },
            { value: "beside", content: words.beside },
          ],
          chosen: arrangement,
          choose: (chosen) => (this._arrangement = chosen),
        })}
        ${over ? this.opacity() : nothing}
      </div>
      ${session.canPaint ? tools.render() : nothing}
      <div class="pictures ${arrangement}" aria-busy=${this._isDrawing}>
        ${
          this._picture
            ? html`<strata-picture-canvas
                .picture=${this._picture}
                .over=${over ? this._model : ""}
                .overOpacity=${this._opacity}
                .alt=${words.alt(photograph.name)}
                .label=${words.paint_on}
                .tool=${tools.tool}
                .radius=${tools.radius}
                .waiting=${this._painting.waiting}
                .color=${tools.color}
                ?zoomed=${tools.zoom > 1}
                @drawn=${(event: CustomEvent<PicturePart>) => this.paint({ part: event.detail, color: tools.color })}
              ></strata-picture-canvas>`
            : html`<p role="status">${this._problem ? "" : texts.loading}</p>`
        }
        ${over || !this._model ? nothing : html`<img src=${this._model} alt=${words.model_alt} />`}
      </div>
      ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
      <p class="hint">${words.undistorted}</p>
      ${this.original()}
    </strata-dialog>`;
  }

  /** Links to the unchanged file if the user may download the files of the model. */
  private original(): TemplateResult | typeof nothing {
    const { api, modelId, model, role } = this.session;
    if (!model || !mayDownload(role, model)) return nothing;
    const path = { model: modelId, photograph: this.photograph.id };
    return html`<a slot="actions" class="button" target="_blank" rel="noopener" href=${api.url("GET /models/{model}/photographs/{photograph}/picture", { path })}>${icon("picture")}${words.original}</a>`;
  }

  private opacity(): TemplateResult {
    return html`<label class="opacity">${words.opacity}
      <input
        type="range"
        min="0"
        max="1"
        step="0.05"
        .value=${String(this._opacity)}
        aria-valuetext=${formatPercent(this._opacity)}
        @input=${(event: Event) => (this._opacity = Number((event.target as HTMLInputElement).value))}
      />
    </label>`;
  }

  private paint(drawn: DrawnPart): void {
    const { camera } = this.photograph;
    if (!camera || this._width === 0) return;
    const { api, marks, modelId: model } = this.session;
    const { part } = drawn;
    const window = windowOf(camera, this._width);
    if (isPaint(part)) {
      this._painting.paint(drawn, ({ layer, paint }: PictureTarget): Promise<EditResult> =>
        api.json("POST /models/{model}/layers/{layer}/edits", {
          path: { model, layer: layer.id },
          body: editThrough(window, part, paint),
        }),
      );
      return;
    }
    const scale = this._canvas?.unitPerCssPixel() ?? 1;
    const sight = sightThrough({ api, model: this.session.model! }, window, scale);
    this._painting.mark(drawn, () =>
      "line" in part
        ? marks.finishLine(part.line.map(toPixel), sight)
        : marks.setPoint(toPixel(part.point), sight),
    );
  }

  /** Reads the photograph in the size for the zoom. */
  private async readPicture(): Promise<void> {
    const { api, modelId } = this.session;
    const { photograph } = this;
    if (!photograph.camera) return;
    const { width } = windowOf(photograph.camera, null, this._tools.zoom);
    try {
      const picture = await api.blob("GET /models/{model}/photographs/{photograph}/undistorted", {
        path: { model: modelId, photograph: photograph.id },
        query: { width },
      });
      if (!this.isConnected) return;
      this._canvas?.discard();
      this._painting.leavePicture(); // its parts have the size of the last picture
      URL.revokeObjectURL(this._picture);
      this._width = width;
      this._picture = URL.createObjectURL(picture);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  /** Draws the model as the camera of the photograph sees it. Returns whether it is shown. */
  private async drawModel(): Promise<boolean> {
    const { api, modelId, layers } = this.session;
    const { camera } = this.photograph;
    if (!camera || !this.isConnected) return false;
    this._asked?.abort();
    const asked = (this._asked = new AbortController());
    this._isDrawing = true;
    try {
      const picture = await api.blob("POST /models/{model}/frame", {
        path: { model: modelId },
        body: {
          camera: frameThrough(camera),
          layers: layers.all.filter((layer) => layers.visible(layer)).map(({ id }) => id),
          samples: kSamples,
        },
        signal: asked.signal,
      });
      if (asked !== this._asked) return false;
      URL.revokeObjectURL(this._model);
      this._model = URL.createObjectURL(picture);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return false; // a newer request has been sent
      this._problem = error.message;
      this._isDrawing = false;
      return false;
    }
    this._isDrawing = false;
    return true;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-photograph-dialog": StrataPhotographDialog;
  }
}
