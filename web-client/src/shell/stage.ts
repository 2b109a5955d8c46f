// <strata-stage>: the streamed frames, the gestures of the pointer, and an overlay. The overlay
// shows the brush footprint, the pointers of other participants and the scale bar.

import { css, html, LitElement, nothing, svg, type TemplateResult } from "lit";
import { customElement, property, query } from "lit/decorators.js";
import { FrameCanvas } from "../net/frame-canvas";
import type { FrameMessage } from "../net/frame-header";
import { StageInput } from "../ui/input";
import { metresPer, scaleBar } from "../domain/measure";
import { colorOf, cssColor } from "../domain/palette";
import { followSession } from "../session/follow-session";
import type { OpenModelSession } from "./open-model-session";
import { measureOverlay } from "../features/measuring/measure-overlay";
import { notices } from "../ui/notices";
import { hasPart, partOf } from "./page-parts";
import { onTheme, stageBackground } from "../ui/preferences";
import { outlineOverlay } from "../features/painting/outline-overlay";
import "../features/presence/people-overlay";
import { kSelectingTools } from "../tools/tool";
import { styled } from "../ui/styled";
import { sharedStyles } from "../ui/styles";
import { texts } from "../texts";
import { shapePicture } from "../features/painting/tool-shapes";

const kMostWindowPixels = 1920 * 1200;
const kMostScale = 2; // window pixels per CSS pixel
const kScaleBarPx = 150;

@customElement("strata-stage")
export class StrataStage extends LitElement {
  @property({ attribute: false }) session!: OpenModelSession;
  @query("canvas") private _canvas!: HTMLCanvasElement;
  @query(".surface") private _surface!: HTMLElement;

  private _input: StageInput | null = null;
  private _frames: FrameCanvas | null = null;
  private _observer: ResizeObserver | null = null;
  private _endTheme: (() => void) | null = null;

  constructor() {
    super();
    followSession(this);
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        position: relative;
        overflow: hidden;
        background: var(--stage);
        user-select: none;
        -webkit-user-select: none;
      }
      .surface {
        position: absolute;
        inset: 0;
        touch-action: none;
        outline-offset: -3px;
      }
      .surface.paint {
        cursor: none;
      }
      .surface.locked {
        cursor: not-allowed;
      }
      .surface.orbit {
        cursor: grab;
      }
      .surface.orbit:active {
        cursor: grabbing;
      }
      .surface.pan {
        cursor: move;
      }
      .surface.aim {
        cursor: crosshair;
      }
      canvas,
      svg.over {
        position: absolute;
        inset: 0;
        width: 100%;
        height: 100%;
        pointer-events: none;
      }
      canvas {
        object-fit: contain; /* after a resize, until a frame with the new size arrives */
      }
      svg.over {
        overflow: visible;
      }
      .lit {
        position: absolute;
        inset: 0;
        pointer-events: none;
        mask: center / 100% 100% no-repeat;
        background: repeating-linear-gradient(
          45deg,
          color-mix(in srgb, var(--lit) 72%, transparent) 0 4px,
          color-mix(in srgb, var(--lit) 38%, transparent) 4px 9px
        );
      }
      .dim {
        position: absolute;
        inset: 0;
        pointer-events: none;
        mask:
          linear-gradient(black 0 0),
          var(--lit-picture) center / 100% 100% no-repeat;
        mask-composite: exclude;
        background: color-mix(in srgb, var(--mark-dark) 55%, transparent);
      }
      .shape-cursor {
        position: absolute;
        pointer-events: none;
        opacity: 0.62;
        filter: drop-shadow(0 0 1px var(--mark-light)) drop-shadow(0 0 1px var(--mark-dark));
      }
      .shape-cursor i {
        display: block;
        width: 100%;
        height: 100%;
        mask: center / 100% 100% no-repeat;
      }
      .length {
        position: absolute;
        display: flex;
        pointer-events: none;
      }
      .length b {
        padding: var(--space-1) var(--space-2);
        border-radius: var(--radius-round);
        background: var(--mark-ground);
        color: var(--mark-light);
        font-size: var(--text-small);
        font-weight: 600;
        white-space: nowrap;
      }
      .waiting {
        position: absolute;
        inset: 0;
        display: grid;
        place-items: center;
        color: var(--on-stage);
        pointer-events: none;
      }
      .scale {
        position: absolute;
        left: 18px;
        bottom: 16px;
        color: var(--on-stage);
        font-size: var(--text-tiny);
        font-weight: 600;
        pointer-events: none;
        padding: var(--space-1) var(--space-2) var(--space-1);
        border-radius: var(--radius-tiny);
        background: var(--on-stage-ground);
      }
      .scale small {
        display: block;
        font-weight: 400;
      }
      .scale i {
        display: block;
        height: 6px;
        border: 2px solid var(--on-stage);
        border-top: 0;
      }
      @media (max-width: 820px) {
        .scale {
          top: 12px;
          bottom: auto;
          left: 12px;
        }
        .scale.lowered {
          top: 44px; /* below the label of <strata-together-bar> */
        }
      }
    `,
  ];

  override firstUpdated(): void {
    this._frames = new FrameCanvas(this._canvas, {
      drawn: (part) => this.onDrawn(part),
      failed: (reason) => notices.show("problem", texts.problems.picture, reason),
    });
    this.session.onFrame = (part) => this._frames?.push(part);
    this.session.onResetFrames = () => this._frames?.reset();
    this.session.shownFrame = () => {
      const header = this._frames?.shown;
      return header ? { canvas: this._canvas, header } : null;
    };
    this._input = new StageInput(
      this._surface,
      this.session.gestures,
      () => this.session.view.scale,
    );
    this._observer = new ResizeObserver(() => this.measure());
    this._observer.observe(this);
    this.measure();
    const showBackground = (): void => this.session.setBackground(stageBackground());
    this._endTheme = onTheme(showBackground);
    showBackground();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._observer?.disconnect();
    this._input?.detach();
    this._endTheme?.();
  }

  set orbitHeld(held: boolean) {
    if (this._input) this._input.orbitHeld = held;
  }

  /** Describes the canvas in data attributes, for tests and tools. */
  private onDrawn(part: FrameMessage): void {
    this.session.frameDrawn(part);
    const { dataset } = this._canvas;
    dataset["frames"] = String(this.session.view.framesDrawn);
    dataset["cameraSeq"] = String(part.header.camera_seq);
    dataset["sceneSequence"] = String(part.header.scene_sequence);
    dataset["still"] = String(part.header.still);
  }

  private measure(): void {
    const { clientWidth: width, clientHeight: height } = this;
    if (width < 2 || height < 2) return;
    const most = Math.sqrt(kMostWindowPixels / (width * height));
    this.session.view.setViewport(
      width,
      height,
      Math.min(window.devicePixelRatio || 1, kMostScale, most),
    );
  }

  override render(): TemplateResult {
    const { session } = this;
    const { active: tool, outline } = session.tools;
    const locked = session.lockedTarget !== null;
    const paints = !locked && (tool === "brush" || tool === "eraser");
    const brushes = paints || (!locked && tool === "wand" && !!session.selection?.wand.brushes);
    const selects = kSelectingTools.includes(tool) && hasPart("model_dialogs", this);
    const aims =
      tool === "polygon" ||
      tool === "lasso" ||
      tool === "strokes" ||
      tool === "bucket" ||
      tool === "wand" ||
      tool === "pick" ||
      tool === "line" ||
      tool === "point" ||
      tool === "comment" ||
      tool === "measure" ||
      tool === "face" ||
      tool === "part";
    return html`<div
        class="surface ${locked ? "locked" : brushes ? "paint" : aims ? "aim" : tool}"
        tabindex="0"
        role="application"
        aria-label=${texts.model.stage}
      >
        <canvas width="2" height="2"></canvas>
        ${this.litArea()}
        ${brushes ? this.brushCursor() : nothing}
        ${this.selectionOutlines()}
        ${tool === "strokes" ? this.strokes() : nothing}
        ${outline ? outlineOverlay(session, outline) : nothing}
        ${tool === "measure" ? measureOverlay(session) : nothing}
        ${session.photographs?.isOpen ? this.photographedPlace() : nothing}
      </div>
      ${selects ? html`<strata-selection-bar .session=${session}></strata-selection-bar>` : nothing}
      <strata-people-overlay .session=${session}></strata-people-overlay>
      ${this.scaleBar()}
      ${
        session.view.framesDrawn === 0
          ? html`<div class="waiting" role="status">${texts.model.waiting_for_picture}</div>`
          : nothing
      }`;
  }

  private selectionOutlines(): TemplateResult | typeof nothing {
    const { selection } = this.session;
    if (!selection || selection.isEmpty) return nothing;
    const { selectionOverlay } = partOf("model_dialogs") as typeof import("./model-dialogs");
    return selectionOverlay(selection, this.session.view.scale);
  }

  private photographedPlace(): TemplateResult | typeof nothing {
    const { placeOverlay } = partOf("model_dialogs") as typeof import("./model-dialogs");
    return placeOverlay(this.session);
  }

  private strokes(): TemplateResult | typeof nothing {
    const { strokes, view } = this.session;
    if (!strokes) return nothing;
    const { strokesOverlay } = partOf("model_dialogs") as typeof import("./model-dialogs");
    return strokesOverlay(strokes, view.scale);
  }

  /** Draws hatching over the highlighted part of the surface. */
  private litArea(): TemplateResult | typeof nothing {
    const { picture, dims } = this.session.lit;
    return picture
      ? html`${dims ? html`<div class="dim" aria-hidden="true" ${styled({ "--lit-picture": `url(${picture})` })}></div>` : nothing}
          <div class="lit" aria-hidden="true" ${styled({ "mask-image": `url(${picture})` })}></div>`
      : nothing;
  }

  /** Draws the brush footprint on the frame: exactly the pixels that the stroke covers. */
  private brushCursor(): TemplateResult {
    const { session } = this;
    const { at } = session.pointer;
    const { scale } = session.view;
    if (!at) return html``;
    const [x, y] = [at.x / scale, at.y / scale];
    const radius = session.painting.radiusWindowPx() / scale;
    const layer = session.layers.selected;
    const paints = session.tools.active === "brush";
    const erases = session.tools.active === "eraser";
    const color =
      layer && paints ? colorOf(layer.palette, session.painting.brush.valueFor(layer)) : null;
    const fill = color ? cssColor(color) : "none";
    const shape = paints || erases ? session.painting.brush.shape : "disc";
    const square = shape === "square";
    if (typeof shape === "number" && radius >= 4)
      return this.shapeCursor(shape, x, y, radius, erases ? null : color);
    const outline = (
      width: number,
      stroke: string,
      dashes: string,
      filled: boolean,
    ): TemplateResult =>
      square
        ? svg`<rect x=${x - radius} y=${y - radius} width=${2 * radius} height=${2 * radius} fill=${filled ? fill : "none"}
            fill-opacity="0.32" stroke=${stroke} stroke-width=${width} stroke-dasharray=${dashes} />`
        : svg`<circle cx=${x} cy=${y} r=${radius} fill=${filled ? fill : "none"}
            fill-opacity="0.32" stroke=${stroke} stroke-width=${width} stroke-dasharray=${dashes} />`;
    const dashes = erases ? "5 4" : "none";
    return html`<svg class="over" aria-hidden="true">
      ${outline(3, "var(--mark-rim)", "none", true)} ${outline(1.5, "var(--mark-light)", dashes, false)}
      ${
        radius < 4
          ? svg`<path d="M${x - 10} ${y}h6M${x + 4} ${y}h6M${x} ${y - 10}v6M${x} ${y + 4}v6" stroke="var(--mark-dark)" stroke-width="1.5" />`
          : svg`<circle cx=${x} cy=${y} r="1.2" fill="var(--mark-light)" />`
      }
    </svg>`;
  }

  /**
   * Draws the footprint of a brush shape from an image: a tint with a dark rim, in the layer's
   * color or transparent.
   */
  private shapeCursor(
    tool: number,
    x: number,
    y: number,
    radius: number,
    color: string | null,
  ): TemplateResult {
    const square = {
      left: `${x - radius}px`,
      top: `${y - radius}px`,
      width: `${2 * radius}px`,
      height: `${2 * radius}px`,
    };
    const tint = {
      "mask-image": `url(${shapePicture(tool)})`,
      background: color ? cssColor(color) : "var(--mark-light)",
    };
    return html`<div class="shape-cursor" aria-hidden="true" ${styled(square)}><i ${styled(tint)}></i></div>`;
  }

  private scaleBar(): TemplateResult {
    const { session } = this;
    if (!session.model || session.view.framesDrawn === 0) return html``;
    const depth = session.pointer.picked?.hit
      ? session.pointer.surfaceDepth()
      : session.view.camera.distance;
    const metresPerPx =
      session.view.camera.unitPerPixel(depth) * session.view.scale * metresPer(session.shownUnit);
    const bar = scaleBar(metresPerPx, kScaleBarPx);
    const lowered = session.together.followed || session.together.leading;
    return html`<div class="scale ${lowered ? "lowered" : ""}"><i ${styled({ width: `${bar.px.toFixed(1)}px` })}></i>${bar.label}${session.model.scale_verified ? nothing : html`<small>${texts.home.scale_open}</small>`}</div>`;
  }
}
