// The tools of a dialog in which the user paints on a picture: move, brush and area, the zoom, the
// width of the brush, and what it paints.

import { css, html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";
import { readNumber, typedNumber } from "../../core/locale";
import { labelOf } from "../../domain/cells";
import { colorOf, cssColor } from "../../domain/palette";
import { texts } from "../../texts";
import { icon } from "../../ui/icons";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { describeValue } from "../layer-values";
import type { ModelSession } from "../model-session";
import type { PictureTool } from "./picture-drawing";
import type { PicturePainting } from "./picture-painting";

const words = texts.picture_tools;
const kTools: readonly PictureTool[] = ["move", "brush", "area"];
const kZooms = [1, 2, 4] as const;
const kLeastWidth = { mm: 0.1, px: 1 } as const;

export interface PictureToolsHost {
  session(): ModelSession;
  painting(): PicturePainting;
  /** The unit of the brush's width. */
  readonly unit: "mm" | "px";
  /** Another tool was chosen, so an unfinished part is discarded. */
  left(): void;
  /** The picture must be drawn in another size. */
  zoomed(): void;
}

export const pictureToolStyles = css`
  .painting {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: var(--space-2) var(--space-4);
  }
  .painting .width {
    display: inline-block;
    width: 5.5rem;
  }
`;

export class PictureTools {
  zoom: (typeof kZooms)[number] = 1;
  private _tool: PictureTool = "move";
  private _width = ""; // of the brush, as typed

  constructor(
    private readonly _element: ReactiveControllerHost,
    private readonly _host: PictureToolsHost,
  ) {}

  /** Begins with the width of the brush in the 3D view. */
  start(): void {
    this._width = typedNumber(this._host.session().painting.brush.width[this._host.unit]);
  }

  /** The chosen tool, if it can be used. */
  get tool(): PictureTool {
    return this._tool === "brush" && !this.hasWidth ? "move" : this._tool;
  }
  /** The radius of the brush in its unit. */
  get radius(): number {
    return readNumber(this._width) / 2;
  }
  /** The color of a stroke. Null if it erases. */
  get color(): string | null {
    const { layers, painting } = this._host.session();
    const layer = layers.selected;
    if (!layer || this._host.painting().erases) return null;
    const color = colorOf(layers.palette(layer), painting.brush.valueFor(layer));
    return color ? cssColor(color) : null;
  }

  render(): TemplateResult {
    const { _tool: tool } = this;
    const painting = this._host.painting();
    const layer = this._host.session().layers.selected;
    const { unit } = this._host;
    const names = { move: words.move, brush: texts.tools.brush, area: words.area };
    const isWrong = tool === "brush" && !this.hasWidth;
    return html`<div class="painting">
        ${radioGroup({
          label: texts.model.tools,
          class: "segments",
          choices: kTools.map((value) => ({ value, content: names[value] })),
          chosen: tool,
          choose: (value) => this.choose(value),
        })}
        ${radioGroup({
          label: words.zoom,
          class: "segments",
          choices: kZooms.map((value) => ({ value, content: `${value} ×` })),
          chosen: this.zoom,
          choose: (value) => this.chooseZoom(value),
        })}
        ${
          tool === "brush"
            ? html`<label>${texts.brush.width} (${unit}) <span class="width">${numberInput({
                value: this._width,
                name: "width",
                min: kLeastWidth[unit],
                wrong: isWrong,
                toldAt: "wrong-width",
                typed: (text) => {
                  this._width = text;
                  this._element.requestUpdate();
                },
              })}</span></label>`
            : nothing
        }
        ${
          tool === "move"
            ? nothing
            : html`<label class="check"><input
                  type="checkbox"
                  name="erases"
                  .checked=${painting.erases}
                  @change=${(event: Event) => {
                    painting.erases = (event.target as HTMLInputElement).checked;
                    this._element.requestUpdate();
                  }}
                /> ${texts.areas.erases}</label>
                <button class="icon quiet" ?disabled=${!layer} title=${texts.model.undo} aria-label=${texts.model.undo} @click=${() => layer && painting.undo(layer)}>${icon("undo")}</button>
                <button class="icon quiet" ?disabled=${!layer} title=${texts.model.redo} aria-label=${texts.model.redo} @click=${() => layer && painting.redo(layer)}>${icon("redo")}</button>`
        }
      </div>
      ${isWrong ? html`<p class="error" id="wrong-width" role="alert">${words.wrong_width}</p>` : nothing}
      ${tool === "move" ? nothing : html`<p class="hint">${this.paints} ${tool === "area" ? words.area_hint : words.brush_hint}</p>`}`;
  }

  /** What the tools paint on which layer. */
  private get paints(): string {
    const { layers, painting, tables } = this._host.session();
    const layer = layers.selected;
    if (!layer) return texts.brush.no_layer;
    if (this._host.painting().erases) return `${texts.brush.erases(labelOf(layer))}.`;
    const value = describeValue(layer, painting.brush.valueFor(layer), tables);
    return words.paints(value, labelOf(layer));
  }

  private get hasWidth(): boolean {
    const width = readNumber(this._width);
    return width > 0 && width <= 1e9;
  }

  private choose(tool: PictureTool): void {
    this._host.left();
    this._tool = tool;
    this._element.requestUpdate();
  }

  private chooseZoom(zoom: (typeof kZooms)[number]): void {
    if (zoom === this.zoom) return;
    this.zoom = zoom;
    this._element.requestUpdate();
    this._host.zoomed();
  }
}
