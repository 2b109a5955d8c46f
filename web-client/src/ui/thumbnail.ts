// <strata-thumbnail>: a small rendered image of a model or a saved view. It is requested when the
// element becomes visible.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { Api } from "../net/api";
import { OrbitCamera } from "../math/camera";
import type { View } from "../core/protocol.gen";
import type { Model } from "../core/types";
import { sharedStyles } from "./styles";
import { texts } from "../texts";
import { whenSeen } from "./when-seen";

const kWidth = 640;
const kHeight = 480;
const kSmallWidth = 240; // sufficient for two device pixels per CSS pixel
const kSmallHeight = 180;
const kViewSide = 256;
const kSamples = 4; // samples per pixel, for smooth edges at this size
// Images are requested one at a time, so a gallery does not slow down other users.
let busy: Promise<void> = Promise.resolve();

@customElement("strata-thumbnail")
export class StrataThumbnail extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) model!: Model;
  @property({
    attribute: false,
    hasChanged: (now: View | null, before: View | null) =>
      now?.id !== before?.id || now?.version !== before?.version,
  })
  view: View | null = null;
  /** The up direction of a smaller image, instead of the model's own. */
  @property() up: Model["up"] | null = null;
  @state() private _state: "waiting" | "drawn" | "failed" = "waiting";
  @query("canvas") private _canvas!: HTMLCanvasElement;
  private _wanted: AbortController | null = null; // cancels the wait or the request
  private _settled = false; // whether the request has succeeded or failed

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        position: relative;
        aspect-ratio: 4 / 3;
        background: var(--stage);
        overflow: hidden;
      }
      canvas {
        width: 100%;
        height: 100%;
        object-fit: cover;
        opacity: 0;
        transition: opacity var(--slow);
      }
      canvas.drawn {
        opacity: 1;
      }
      p {
        position: absolute;
        inset: 0;
        display: grid;
        place-items: center;
        color: var(--on-stage);
        font-size: var(--text-small);
      }
    `,
  ];

  /**
   * Requests the image again if necessary, because a list that moves an element removes it
   * temporarily.
   */
  override connectedCallback(): void {
    super.connectedCallback();
    if (this._wanted && !this._settled) this.want();
  }

  protected override updated(changed: PropertyValues): void {
    if (!this._wanted || changed.has("view")) this.want();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._wanted?.abort();
  }

  private want(): void {
    this._wanted?.abort();
    this._settled = false;
    const { signal } = (this._wanted = new AbortController());
    signal.addEventListener(
      "abort",
      whenSeen(this, () => (busy = busy.then(() => this.load(signal)))),
    );
  }

  private async load(signal: AbortSignal): Promise<void> {
    if (signal.aborted) return;
    try {
      const bitmap = await createImageBitmap(await this.picture(signal));
      this._canvas.width = bitmap.width;
      this._canvas.height = bitmap.height;
      this._canvas.getContext("2d")?.drawImage(bitmap, 0, 0);
      bitmap.close();
      this._state = "drawn";
    } catch {
      if (signal.aborted) return; // the image is no longer needed
      this._state = "failed"; // the card shows the failure; the model itself may still open
    }
    if (!signal.aborted) this._settled = true;
  }

  private picture(signal: AbortSignal): Promise<Blob> {
    if (this.view)
      return this.api.blob("GET /models/{model}/views/{view}/picture", {
        path: { model: this.model.id, view: this.view.id },
        query: { thumbnail: kViewSide },
        signal,
      });
    const camera = new OrbitCamera();
    camera.setModel(this.model.bounds, this.up ?? this.model.up);
    if (this.up) camera.resize(kSmallWidth, kSmallHeight);
    else camera.resize(kWidth, kHeight);
    camera.firstView();
    return this.api.blob("POST /models/{model}/frame", {
      path: { model: this.model.id },
      body: { camera: camera.message(), samples: kSamples, format: "jpeg" },
      signal,
    });
  }

  override render(): TemplateResult {
    return html`<canvas class=${this._state} width="4" height="3" aria-hidden="true"></canvas>
      ${this._state === "failed" && !this.view ? html`<p>${texts.home.no_picture}</p>` : nothing}`;
  }
}
