// <strata-thumbnail>: one small rendered picture of a model, asked for when it comes into sight.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { Api } from "../core/api";
import { OrbitCamera } from "../core/camera";
import type { Model } from "../core/types";
import { shared_styles } from "./styles";
import { texts } from "./texts";

const kWidth = 640;
const kHeight = 480;
let busy: Promise<void> = Promise.resolve(); // one picture at a time, so that a gallery never crowds out people at work

@customElement("strata-thumbnail")
export class StrataThumbnail extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) model!: Model;
  @state() private state_: "waiting" | "drawn" | "failed" = "waiting";
  @query("canvas") private canvas_!: HTMLCanvasElement;
  private observer_: IntersectionObserver | null = null;

  static override styles = [
    shared_styles,
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
        transition: opacity 240ms;
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
        font-size: 0.85rem;
      }
    `,
  ];

  override firstUpdated(): void {
    this.observer_ = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      this.observer_?.disconnect();
      busy = busy.then(() => this.load());
    });
    this.observer_.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.observer_?.disconnect();
  }

  private async load(): Promise<void> {
    if (!this.isConnected) return;
    const camera = new OrbitCamera();
    camera.set_model(this.model.bounds, this.model.up);
    camera.resize(kWidth, kHeight);
    camera.first_view();
    try {
      const bitmap = await createImageBitmap(await this.api.frame(this.model.id, camera.message()));
      this.canvas_.width = bitmap.width;
      this.canvas_.height = bitmap.height;
      this.canvas_.getContext("2d")?.drawImage(bitmap, 0, 0);
      bitmap.close();
      this.state_ = "drawn";
    } catch {
      this.state_ = "failed"; // the card says so; the model itself may still open
    }
  }

  override render(): TemplateResult {
    return html`<canvas class=${this.state_} width="4" height="3" aria-hidden="true"></canvas>
      ${this.state_ === "failed" ? html`<p>${texts.home.no_picture}</p>` : ""}`;
  }
}
