// <strata-kiosk-stage>: the streamed frames and the gestures on them. Without frames, it shows the
// stored image of the stop.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { styled } from "../ui/styled";
import { FrameCanvas } from "../net/frame-canvas";
import type { FrameMessage } from "../net/frame-header";
import { StageInput } from "../ui/input";
import type { View } from "../core/protocol.gen";
import { pictureOfView } from "./as-kiosk";
import type { KioskSession } from "./kiosk-session";
import type { KioskShow } from "./show";

const kMostWindowPixels = 1920 * 1200;
const kMostScale = 2; // window pixels per CSS pixel
const kKeyStep = 24; // window pixels
const kKeyZoom = 0.85;

@customElement("strata-kiosk-stage")
export class StrataKioskStage extends LitElement {
  @property({ attribute: false }) session!: KioskSession;
  @property({ attribute: false }) show!: KioskShow;
  // The owner increments this property to trigger a render.
  @property({ type: Number }) changes = 0;
  @query("canvas") private _canvas!: HTMLCanvasElement;
  @query(".surface") private _surface!: HTMLElement;

  private _input: StageInput | null = null;
  private _frames: FrameCanvas | null = null;
  private _observer: ResizeObserver | null = null;

  static override styles = css`
    :host {
      display: block;
      position: relative;
      overflow: hidden;
      container-type: size;
    }
    .surface {
      position: absolute;
      inset: 0;
      touch-action: none;
      outline-offset: -6px;
    }
    .surface:focus-visible {
      outline: 4px solid var(--accent);
    }
    canvas,
    img {
      position: absolute;
      inset: 0;
      pointer-events: none;
    }
    img {
      margin: auto;
      /* The edges fade out, because the aspect ratio of the image may differ from that of the
         stage. */
      mask:
        linear-gradient(transparent, #000 9%, #000 91%, transparent),
        linear-gradient(to right, transparent, #000 9%, #000 91%, transparent);
      mask-composite: intersect;
    }
    canvas {
      width: 100%;
      height: 100%;
      object-fit: contain;
      opacity: 0;
      transition: opacity 500ms;
    }
    canvas.live {
      opacity: 1;
    }
    /* An animation while no visitor is present. The server draws no frames for it, because all
       screens at this stop show the same full-quality image. */
    :host(.resting) :is(canvas, img) {
      animation: come-near 20s ease-in-out infinite alternate;
    }
    @keyframes come-near {
      to {
        transform: scale(1.08);
      }
    }
    @media (prefers-reduced-motion: reduce) {
      canvas {
        transition: none;
      }
      :host(.resting) :is(canvas, img) {
        animation: none;
      }
    }
  `;

  override firstUpdated(): void {
    const { show } = this;
    this._frames = new FrameCanvas(this._canvas, {
      drawn: (part) => this.onDrawn(part),
      failed: (reason) => console.info("a picture could not be drawn:", reason),
    });
    show.onFrame = (part) => this._frames?.push(part);
    show.onResetFrames = () => this._frames?.reset();
    this._input = new StageInput(this._surface, show.gestures, () => show.view.scale);
    this._observer = new ResizeObserver(() => this.measure());
    this._observer.observe(this);
    this.measure();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._observer?.disconnect();
    this._input?.detach();
    this.show.onFrame = this.show.onResetFrames = () => {};
  }

  /** Describes the canvas in data attributes, for tests and tools. */
  private onDrawn(part: FrameMessage): void {
    this.show.frameDrawn(part);
    const { dataset } = this._canvas;
    dataset["frames"] = String(this.show.view.framesDrawn);
    dataset["still"] = String(part.header.still);
  }

  private measure(): void {
    const { clientWidth: width, clientHeight: height } = this;
    if (width < 2 || height < 2) return;
    const most = Math.sqrt(kMostWindowPixels / (width * height));
    this.show.setViewport(width, height, Math.min(window.devicePixelRatio || 1, kMostScale, most));
  }

  private readonly onKey = (event: KeyboardEvent): void => {
    const { orbit, zoom } = this.show.gestures;
    const { width, height } = this.show.view.camera;
    const moves: Record<string, () => void> = {
      ArrowLeft: () => orbit(-kKeyStep, 0),
      ArrowRight: () => orbit(kKeyStep, 0),
      ArrowUp: () => orbit(0, -kKeyStep),
      ArrowDown: () => orbit(0, kKeyStep),
      "+": () => zoom(kKeyZoom, width / 2, height / 2),
      "-": () => zoom(1 / kKeyZoom, width / 2, height / 2),
    };
    const move = event.ctrlKey || event.metaKey || event.altKey ? undefined : moves[event.key];
    if (!move) return;
    event.preventDefault();
    move();
  };

  override render(): TemplateResult {
    const { session, show } = this;
    const view = session.stop?.view;
    const live = show.drawn && !show.away;
    // Behind the frames, the stored image would only use memory. The browser's cache provides it
    // when it is needed.
    return html`${view && !live ? this.storedPicture(view) : nothing}
      <div class="surface" tabindex="0" role="application" aria-label=${session.words.stage} @keydown=${this.onKey}>
        <canvas class=${live ? "live" : ""} width="2" height="2"></canvas>
      </div>`;
  }

  private storedPicture({ slug, camera }: View): TemplateResult {
    const shape = camera.width / camera.height;
    const size = { "aspect-ratio": shape, width: `min(100cqw, calc(100cqh * ${shape}))` };
    return html`<img src=${pictureOfView(this.show.modelRef, slug)} alt="" ${styled(size)} />`;
  }
}
