// The tools of a dialog in which the user paints and draws on a picture: move, brush, area, line and
// point, the zoom, the width of the brush, and what the tools paint or draw.

import { css, html, nothing, type ReactiveControllerHost, type TemplateResult } from "lit";
import { readNumber, typedNumber } from "../../core/locale";
import { labelOf } from "../../domain/cells";
import type { MarkKind } from "../../domain/marks";
import { colorOf, cssColor } from "../../domain/palette";
import { texts } from "../../texts";
import { icon } from "../../ui/icons";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import "../fields/value-picker";
import { describeValue } from "../layer-values";
import type { ModelSession } from "../model-session";
import type { DrawingTool, PictureTool } from "./picture-drawing";
import type { PicturePainting } from "./picture-painting";

const words = texts.picture_tools;
const kPaintTools: readonly PictureTool[] = ["move", "brush", "area"];
const kMarkKinds: readonly MarkKind[] = ["line", "point"];
const kZooms = [1, 2, 4] as const;
const kLeastWidth = { mm: 0.1, px: 1 } as const;

const hintOf = (tool: DrawingTool): string =>
  isMark(tool) ? words.how[tool] : tool === "area" ? words.area_hint : words.brush_hint;

const isMark = (tool: PictureTool): tool is MarkKind => tool === "line" || tool === "point";

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
  .painting select {
    display: inline-block;
    width: auto;
  }
  .painting details[open] {
    flex-basis: 100%;
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
    const { chosen } = this;
    return chosen === "brush" && !this.hasWidth ? "move" : chosen;
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
    const tool = this.chosen;
    const painting = this._host.painting();
    const layer = this._host.session().layers.selected;
    const { unit } = this._host;
    const { brush, line, point } = texts.tools;
    const names = { move: words.move, brush, area: words.area, line, point };
    const isWrong = tool === "brush" && !this.hasWidth;
    return html`<div class="painting">
        ${radioGroup({
          label: texts.model.tools,
          class: "segments",
          choices: this.tools.map((value) => ({ value, content: names[value] })),
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
          tool === "brush" || tool === "area"
            ? html`<label class="check"><input
                  type="checkbox"
                  name="erases"
                  .checked=${painting.erases}
                  @change=${(event: Event) => {
                    painting.erases = (event.target as HTMLInputElement).checked;
                    this._element.requestUpdate();
                  }}
                /> ${texts.areas.erases}</label>`
            : nothing
        }
        ${
          tool === "move"
            ? nothing
            : html`<button class="icon quiet" ?disabled=${!layer} title=${texts.model.undo} aria-label=${texts.model.undo} @click=${() => this.travel("undo")}>${icon("undo")}</button>
                <button class="icon quiet" ?disabled=${!layer} title=${texts.model.redo} aria-label=${texts.model.redo} @click=${() => this.travel("redo")}>${icon("redo")}</button>`
        }
      </div>
      ${isWrong ? html`<p class="error" id="wrong-width" role="alert">${words.wrong_width}</p>` : nothing}
      ${tool === "move" ? nothing : html`${this.target(tool)}<p class="hint">${hintOf(tool)}</p>`}`;
  }

  /** Renders the layer, and what a tool paints or draws on it. */
  private target(tool: DrawingTool): TemplateResult {
    const session = this._host.session();
    const { layers, painting } = session;
    const layer = layers.selected;
    const erases = !isMark(tool) && this._host.painting().erases;
    return html`<div class="painting">
        <label>${words.layer}
          <select name="layer" @change=${(event: Event) => this.chooseLayer(event)}>
            ${[...layers.all].reverse().map((each) => html`<option value=${each.id} ?selected=${each === layer}>${labelOf(each)}</option>`)}
          </select>
        </label>
        ${
          layer && !erases
            ? html`<details>
                <summary>${isMark(tool) ? this.draws(tool) : this.paints}</summary>
                <strata-value-picker .session=${session} .layer=${layer} .value=${painting.brush.valueFor(layer)}></strata-value-picker>
              </details>`
            : html`<span>${this.paints}</span>`
        }
      </div>`;
  }

  private get tools(): readonly PictureTool[] {
    const { marks } = this._host.session();
    return [...kPaintTools, ...kMarkKinds.filter((kind) => marks.column(kind) !== null)];
  }

  /** The chosen tool. Another layer may not have a column for lines or points. */
  private get chosen(): PictureTool {
    return this.tools.includes(this._tool) ? this._tool : "move";
  }

  /** Lines and points are undone in the table, and paint in the layer. */
  private travel(way: "undo" | "redo"): void {
    const { layers, marks } = this._host.session();
    const painting = this._host.painting();
    if (isMark(this.chosen)) painting.travelMarks(way, () => marks[way]());
    else if (layers.selected) painting[way](layers.selected);
  }

  /** Which record gets the lines or points. */
  private draws(kind: MarkKind): string {
    const { layers, marks, painting, tables } = this._host.session();
    const layer = layers.selected;
    const column = marks.column(kind);
    if (!layer || !column) return texts.marks.no_column[kind];
    const record = describeValue(layer, painting.brush.valueFor(layer), tables);
    return words.draws(record, labelOf(column));
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

  private chooseLayer({ target }: Event): void {
    const { layers } = this._host.session();
    const layer = layers.find(Number((target as HTMLSelectElement).value));
    if (!layer) return;
    this._host.left();
    layers.select(layer);
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
