// <strata-rollout-canvas>: the picture of an unrolled sheet, on which the user draws with the brush
// or areas. Its event `drawn` contains a finished part. Drawn parts stay visible over the picture
// while they are in `waiting`.

import { css, html, LitElement, nothing, svg, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { RolloutSheet, SheetPoint } from "../../core/protocol.gen";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import {
  sheetBox,
  SheetDrawing,
  type DrawnPart,
  type SheetBox,
  type SheetPart,
  type SheetTool,
} from "./sheet-drawing";

const kSnapPx = 10; // CSS pixels

@customElement("strata-rollout-canvas")
export class StrataRolloutCanvas extends LitElement {
  /** The address of the picture. */
  @property() picture = "";
  @property({ attribute: false }) sheet!: RolloutSheet;
  /** The width of a pixel of this picture on the object. */
  @property({ attribute: false }) mmPerPixel = 1;
  @property() tool: SheetTool = "move";
  @property({ attribute: false }) radiusMm = 1;
  @property({ attribute: false }) waiting: readonly DrawnPart[] = [];
  /** The color of the open stroke. Null if it erases. */
  @property({ attribute: false }) color: string | null = null;
  /** Whether the picture has its own size, and is scrolled. */
  @property({ type: Boolean, reflect: true }) zoomed = false;
  @state() private _size: readonly [number, number] = [0, 0]; // of the picture
  @state() private _hover: SheetPoint | null = null;
  @query("img") private _img!: HTMLImageElement | null;

  private readonly _drawing = new SheetDrawing({
    tool: () => this.tool,
    radiusMm: () => this.radiusMm,
    snapMm: () => kSnapPx * this.mmPerCssPixel(),
    finished: (part) =>
      void this.dispatchEvent(new CustomEvent<SheetPart>("drawn", { detail: part })),
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
      :host([zoomed]) .sheet,
      :host([zoomed]) img {
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
    if (!changed.has("sheet") && !changed.has("mmPerPixel")) return;
    this._size = [0, 0]; // unknown until the new picture is loaded
    this._drawing.cancelPress();
  }

  override render(): TemplateResult {
    const draws = this.tool !== "move";
    return html`<div
        class="sheet ${draws ? "draws" : ""}"
        tabindex=${draws ? 0 : nothing}
        role=${draws ? "application" : nothing}
        aria-label=${draws ? texts.rollouts.paint_on : nothing}
        @pointerdown=${this.onDown}
        @pointermove=${this.onMove}
        @pointerup=${this.onUp}
        @pointercancel=${this.onCancel}
        @pointerleave=${() => (this._hover = null)}
        @keydown=${this.onKey}
        @dragstart=${(event: Event) => event.preventDefault()}
      >
        <img src=${this.picture} alt=${draws ? "" : texts.rollouts.alt} @load=${this.onLoad} />
        ${this._size[0] > 0 ? this.overlay() : nothing}
      </div>`;
  }

  private overlay(): TemplateResult {
    const { left, top, width, height } = this.box;
    const { path } = this._drawing;
    const snap = kSnapPx * this.mmPerCssPixel();
    const open: readonly DrawnPart[] =
      path.length > 0 && this.tool === "brush"
        ? [{ part: { strokes: [{ path, radius_mm: this.radiusMm }] }, color: this.color }]
        : [];
    const points = pointsOf(path);
    // y points up on the sheet, and down in SVG.
    return html`<svg aria-hidden="true" preserveAspectRatio="none" viewBox="${left} ${-top} ${width} ${height}">
      ${[...this.waiting, ...open].map(shapeOf)}
      ${
        this._drawing.hasCorners
          ? svg`<polyline points=${points} fill="none" stroke="var(--mark-dark)" stroke-width=${snap * 0.3} />
            <polyline points=${points} fill="none" stroke="var(--mark-light)" stroke-width=${snap * 0.15} />
            ${path.slice(0, 1).map(([x, y]) => svg`<circle cx=${x} cy=${-y} r=${snap * 0.5} fill="var(--mark-light)" stroke="var(--mark-dark)" stroke-width=${snap * 0.1} />`)}`
          : nothing
      }
      ${
        this._hover && this.tool === "brush"
          ? svg`<circle cx=${this._hover[0]} cy=${-this._hover[1]} r=${this.radiusMm} fill="none" stroke="var(--mark-dark)" stroke-width=${snap * 0.1} />`
          : nothing
      }
    </svg>`;
  }

  private get box(): SheetBox {
    return sheetBox(this.sheet, this.mmPerPixel, this._size);
  }

  private mmPerCssPixel(): number {
    const shown = this._img?.getBoundingClientRect().width ?? 0;
    return shown > 0 ? this.box.width / shown : this.mmPerPixel;
  }

  private onLoad(event: Event): void {
    const { naturalWidth, naturalHeight } = event.target as HTMLImageElement;
    this._size = [naturalWidth, naturalHeight];
  }

  private pointOf({ clientX, clientY }: MouseEvent): SheetPoint {
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

function shapeOf({ part, color: own }: DrawnPart): TemplateResult {
  const color = own ?? "var(--mark-light)";
  return svg`${"polygons" in part ? part.polygons!.map((path) => svg`<polygon points=${pointsOf(path)} fill=${color} fill-rule="evenodd" opacity="0.7" />`) : nothing}
    ${"strokes" in part ? part.strokes!.map(({ path, radius_mm: radius }) => svg`<polyline points=${pointsOf([path[0]!, ...path])} fill="none" stroke=${color} stroke-width=${2 * radius} stroke-linecap="round" stroke-linejoin="round" opacity="0.7" />`) : nothing}`;
}

const pointsOf = (path: readonly (readonly number[])[]): string =>
  path.map(([x, y]) => `${x},${-y!}`).join(" ");

declare global {
  interface HTMLElementTagNameMap {
    "strata-rollout-canvas": StrataRolloutCanvas;
  }
}
