// <strata-thumbnail>: one small rendered picture of a model, or of what a named view shows, asked
// for when it comes into sight.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { Api } from "../net/api";
import { OrbitCamera } from "../math/camera";
import type { View } from "../core/protocol.gen";
import type { Model } from "../core/types";
import { shared_styles } from "./styles";
import { texts } from "../texts";
import { when_seen } from "./when-seen";

const kWidth = 640;
const kHeight = 480;
const kSmallWidth = 240; // on screens with two pixels for one, too
const kSmallHeight = 180;
const kViewSide = 256;
// one picture at a time, so that a gallery never crowds out people at work
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
  /** Small, and with this direction up in place of the model's own. */
  @property() up: Model["up"] | null = null;
  @state() private state_: "waiting" | "drawn" | "failed" = "waiting";
  @query("canvas") private canvas_!: HTMLCanvasElement;
  private wanted_: AbortController | null = null; // ends the wait for its picture, or the request
  private settled_ = false; // drawn, or failed

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

  /** Elements that a list moves to another place leave the page for a moment. */
  override connectedCallback(): void {
    super.connectedCallback();
    if (this.wanted_ && !this.settled_) this.want();
  }

  protected override updated(changed: PropertyValues): void {
    if (!this.wanted_ || changed.has("view")) this.want();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.wanted_?.abort();
  }

  private want(): void {
    this.wanted_?.abort();
    this.settled_ = false;
    const { signal } = (this.wanted_ = new AbortController());
    signal.addEventListener(
      "abort",
      when_seen(this, () => (busy = busy.then(() => this.load(signal)))),
    );
  }

  private async load(signal: AbortSignal): Promise<void> {
    if (signal.aborted) return;
    try {
      const bitmap = await createImageBitmap(await this.picture(signal));
      this.canvas_.width = bitmap.width;
      this.canvas_.height = bitmap.height;
      this.canvas_.getContext("2d")?.drawImage(bitmap, 0, 0);
      bitmap.close();
      this.state_ = "drawn";
    } catch {
      if (signal.aborted) return; // nobody waits for it any more
      this.state_ = "failed"; // the card says so; the model itself may still open
    }
    if (!signal.aborted) this.settled_ = true;
  }

  private picture(signal: AbortSignal): Promise<Blob> {
    if (this.view) return this.api.view_picture(this.model.id, this.view.id, kViewSide, signal);
    const camera = new OrbitCamera();
    camera.set_model(this.model.bounds, this.up ?? this.model.up);
    if (this.up) camera.resize(kSmallWidth, kSmallHeight);
    else camera.resize(kWidth, kHeight);
    camera.first_view();
    return this.api.frame(this.model.id, camera.message(), signal);
  }

  override render(): TemplateResult {
    return html`<canvas class=${this.state_} width="4" height="3" aria-hidden="true"></canvas>
      ${this.state_ === "failed" && !this.view ? html`<p>${texts.home.no_picture}</p>` : nothing}`;
  }
}
