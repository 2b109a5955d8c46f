// <strata-picture-canvas>: a picture on which the user draws with a PictureTool, such as an unrolled
// sheet or a photograph. Its event `drawn` contains a finished part. Drawn parts stay visible
// over the picture while they are in `waiting`.

import { css, html, LitElement, nothing, svg, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import {
  PictureDrawing,
  type DrawnPart,
  type PictureBox,
  type PicturePart,
  type PicturePoint,
  type PictureTool,
} from "./picture-drawing";

const kSnapPx = 10; // CSS pixels

@customElement("strata-picture-canvas")
export class StrataPictureCanvas extends LitElement {
  /** The address of the picture. */
  @property() picture = "";
  /** The address of a picture of the same place that lies over it. */
  @property() over = "";
  @property({ attribute: false }) overOpacity = 1;
  /** What the picture shows. */
  @property() alt = "";
  /** The name of the place where the user draws. */
  @property() label = "";
  /** The place of the upper left corner, in the unit of the drawing. */
  @property({ attribute: false }) origin: PicturePoint = [0, 0];
  /** The width of a pixel of this picture, in the same unit. */
  @property({ attribute: false }) unitPerPixel = 1;
  @property() tool: PictureTool = "move";
  /** The radius of the brush, in the same unit. */
  @property({ attribute: false }) radius = 1;
  @property({ attribute: false }) waiting: readonly DrawnPart[] = [];
  /** The color of the open stroke. Null if it erases. */
  @property({ attribute: false }) color: string | null = null;
  /** Whether the picture has its own size, and is scrolled. */
  @property({ type: Boolean, reflect: true }) zoomed = false;
  @state() private _size: readonly [number, number] = [0, 0]; // of the picture
  @state() private _hover: PicturePoint | null = null;
  @query("img:not(.over)") private _img!: HTMLImageElement | null;

  private readonly _drawing = new PictureDrawing({
    tool: () => this.tool,
    radius: () => this.radius,
    snap: () => kSnapPx * this.unitPerCssPixel(),
    finished: (part) =>
      void this.dispatchEvent(new CustomEvent<PicturePart>("drawn", { detail: part })),
    changed: () => this.requestUpdate(),
  });

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        overflow: auto;
        max-height: min(60dvh, 600px);
        text-align: center;
      }
      .sheet {
        position: relative;
        display: inline-block;
        max-width: 100%;
        vertical-align: top;
      }
      img {
        display: block;
        max-width: 100%;
        max-height: min(50dvh, 480px);
        background: var(--mark-light); /* paper is white in every theme */
        outline: var(--edge) solid var(--line);
        outline-offset: calc(-1 * var(--edge));
      }
      img.over {
        position: absolute;
        inset: 0;
        width: 100%;
        height: 100%;
        max-height: none;
        background: none;
        pointer-events: none;
      }
      :host([zoomed]) .sheet,
      :host([zoomed]) img:not(.over) {
        max-width: none;
        max-height: none;
      }
      svg {
        position: absolute;
        inset: 0;
        width: 100%;
        height: 100%;
        overflow: hidden;
        pointer-events: none;
      }
      .draws {
        cursor: crosshair;
        touch-action: none;
      }
    `,
  ];

  /** Discards the unfinished stroke or area. */
  discard(): void {
    this._drawing.discard();
  }

  override willUpdate(changed: PropertyValues): void {
    // A picture of the same place has the same size, so the user can continue to draw.
    if (!changed.has("origin") && !changed.has("unitPerPixel")) return;
    this._size = [0, 0]; // unknown until the new picture is loaded
    this._drawing.cancelPress();
  }

  override render(): TemplateResult {
    const draws = this.tool !== "move";
    return html`<div
        class="sheet ${draws ? "draws" : ""}"
        tabindex=${draws ? 0 : nothing}
        role=${draws ? "application" : nothing}
        aria-label=${draws ? this.label : nothing}
        @pointerdown=${this.onDown}
        @pointermove=${this.onMove}
        @pointerup=${this.onUp}
        @pointercancel=${this.onCancel}
        @pointerleave=${() => (this._hover = null)}
        @keydown=${this.onKey}
        @dragstart=${(event: Event) => event.preventDefault()}
      >
        <img src=${this.picture} alt=${draws ? "" : this.alt} @load=${this.onLoad} />
        ${this.over ? html`<img class="over" src=${this.over} alt="" ${styled({ opacity: String(this.overOpacity) })} />` : nothing}
        ${this._size[0] > 0 ? this.overlay() : nothing}
      </div>`;
  }

  private overlay(): TemplateResult {
    const { left, top, width, height } = this.box;
    const { path } = this._drawing;
    const snap = kSnapPx * this.unitPerCssPixel();
    const open: readonly DrawnPart[] =
      path.length > 0 && this.tool === "brush"
        ? [{ part: { stroke: { path, radius: this.radius } }, color: this.color }]
        : [];
    const points = pointsOf(path);
    // y points up in the drawing, and down in SVG.
    return html`<svg aria-hidden="true" preserveAspectRatio="none" viewBox="${left} ${-top} ${width} ${height}">
      ${[...this.waiting, ...open].map((drawn) => shapeOf(drawn, snap))}
      ${
        this._drawing.hasCorners || (this.tool === "point" && path.length > 0)
          ? svg`<polyline points=${points} fill="none" stroke="var(--mark-dark)" stroke-width=${snap * 0.3} />
            <polyline points=${points} fill="none" stroke="var(--mark-light)" stroke-width=${snap * 0.15} />
            ${(this.tool === "line" ? path.slice(-1) : path.slice(0, 1)).map(([x, y]) => svg`<circle cx=${x} cy=${-y} r=${snap * 0.5} fill="var(--mark-light)" stroke="var(--mark-dark)" stroke-width=${snap * 0.1} />`)}`
          : nothing
      }
      ${
        this._hover && this.tool === "brush"
          ? svg`<circle cx=${this._hover[0]} cy=${-this._hover[1]} r=${this.radius} fill="none" stroke="var(--mark-dark)" stroke-width=${snap * 0.1} />`
          : nothing
      }
    </svg>`;
  }

  private get box(): PictureBox {
    const [left, top] = this.origin;
    const [columns, rows] = this._size;
    return { left, top, width: columns * this.unitPerPixel, height: rows * this.unitPerPixel };
  }

  /** The width of a CSS pixel, in the unit of the drawing. */
  unitPerCssPixel(): number {
    const shown = this._img?.getBoundingClientRect().width ?? 0;
    return shown > 0 ? this.box.width / shown : this.unitPerPixel;
  }

  private onLoad(event: Event): void {
    const { naturalWidth, naturalHeight } = event.target as HTMLImageElement;
    this._size = [naturalWidth, naturalHeight];
  }

  private pointOf({ clientX, clientY }: MouseEvent): PicturePoint {
    const { left, top, width, height } = this.box;
    const shown = this._img!.getBoundingClientRect();
    return [
      left + ((clientX - shown.left) / shown.width) * width,
      top - ((clientY - shown.top) / shown.height) * height,
    ];
  }

  private onDown(event: PointerEvent): void {
    if (this.tool === "move" || event.button !== 0 || !event.isPrimary || this._size[0] === 0)
      return;
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    this._drawing.down(this.pointOf(event));
  }

  private onMove(event: PointerEvent): void {
    if (this.tool === "move" || !event.isPrimary || this._size[0] === 0) return;
    this._hover = this.pointOf(event);
    const events = event.getCoalescedEvents?.() ?? [];
    this._drawing.move((events.length > 0 ? events : [event]).map((each) => this.pointOf(each)));
  }

  private onUp(event: PointerEvent): void {
    if (event.isPrimary) this._drawing.up();
  }

  private onCancel(event: PointerEvent): void {
    if (event.isPrimary) this._drawing.cancelPress();
  }

  private onKey(event: KeyboardEvent): void {
    const { _drawing: drawing } = this;
    if (event.key === "Escape") {
      if (!drawing.discard()) return; // closes the dialog
    } else if (!drawing.hasCorners) return;
    else if (event.key === "Enter") drawing.finish();
    else if (event.key === "Backspace") drawing.removeCorner();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

function shapeOf({ part, color: own }: DrawnPart, snap: number): TemplateResult {
  const color = own ?? "var(--mark-light)";
  if ("line" in part)
    return svg`<polyline points=${pointsOf(part.line)} fill="none" stroke=${color} stroke-width=${snap * 0.3} />`;
  if ("point" in part)
    return svg`<circle cx=${part.point[0]} cy=${-part.point[1]} r=${snap * 0.5} fill=${color} />`;
  if ("polygon" in part)
    return svg`<polygon points=${pointsOf(part.polygon)} fill=${color} fill-rule="evenodd" opacity="0.7" />`;
  const { path, radius } = part.stroke;
  return svg`<polyline points=${pointsOf([path[0]!, ...path])} fill="none" stroke=${color} stroke-width=${2 * radius} stroke-linecap="round" stroke-linejoin="round" opacity="0.7" />`;
}

const pointsOf = (path: readonly (readonly number[])[]): string =>
  path.map(([x, y]) => `${x},${-y!}`).join(" ");

declare global {
  interface HTMLElementTagNameMap {
    "strata-picture-canvas": StrataPictureCanvas;
  }
}
