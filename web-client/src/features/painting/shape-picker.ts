// <strata-shape-picker>: the shape of the brush: round, square, or made from a picture. A picture
// that is dropped here becomes a shape.

import { css, html, LitElement, nothing, svg, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { Tool, ToolShape } from "../../core/protocol.gen";
import { ask, askText } from "../../ui/dialog";
import { FileDrop } from "../../ui/drop";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { radioGroup, type RadioChoice } from "../../ui/radio-group";
import "./shape-dialog";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { shapePicture } from "./tool-shapes";

const isPicture = ({ type }: { type: string }): boolean =>
  type === "image/png" || type === "image/jpeg";

@customElement("strata-shape-picker")
export class StrataShapePicker extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _file: File | null = null; // the picture for a new shape
  @query("input[type=file]") private _input!: HTMLInputElement;
  private readonly _drop = new FileDrop(
    this,
    ([file]) => file && this.take(file),
    () => this.session.canPaint,
  );

  constructor() {
    super();
    followSession(this, "painting", "shapes");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: auto 1fr auto;
        gap: var(--space-2);
      }
      .caption {
        line-height: 2.875rem;
      }
      strata-menu {
        align-self: start;
        margin-top: var(--space-1);
      }
      .shapes {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2);
      }
      .area {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-2);
        max-height: 9.75rem;
        overflow-y: auto;
        padding: var(--space-half);
        border-radius: var(--radius-small);
      }
      .area.over {
        outline: 2px dashed var(--accent);
        outline-offset: 2px;
      }
      .shapes button,
      .area > button {
        width: 2.75rem;
        min-height: var(--control-touch);
        padding: var(--space-2);
      }
      .shapes button[aria-checked="true"] {
        border-color: var(--accent);
        box-shadow: inset 0 0 0 1px var(--accent);
      }
      .area > button {
        border-style: dashed;
        border-color: var(--line-strong);
      }
      .shape {
        width: 100%;
        height: 1.875rem;
        background: currentColor;
        mask: center / contain no-repeat;
      }
      .shapes svg {
        width: 1.875rem;
        height: 1.875rem;
        fill: currentColor;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.session.shapes.want();
  }

  override render(): TemplateResult {
    const { session } = this;
    const { shape } = session.painting.brush;
    const words = texts.shapes;
    const tool = session.shapes.find(shape);
    const builtin = (
      value: "disc" | "square",
      content: TemplateResult,
    ): RadioChoice<ToolShape> => ({
      value,
      title: texts.brush[value],
      content: html`<svg viewBox="0 0 24 24" aria-hidden="true">${content}</svg><span class="visually-hidden">${texts.brush[value]}</span>`,
    });
    return html`<span class="caption">${texts.brush.shape}</span>
      <div class="area ${this._drop.over ? "over" : ""}">
        ${radioGroup<ToolShape>({
          label: texts.brush.shape,
          class: "shapes",
          choices: [
            builtin("disc", svg`<circle cx="12" cy="12" r="9" />`),
            builtin("square", svg`<rect x="4" y="4" width="16" height="16" />`),
            ...session.shapes.list.map(({ id, name }) => ({
              value: id,
              title: name,
              content: html`<span class="shape" ${styled({ "mask-image": `url(${shapePicture(id)})` })}></span
                ><span class="visually-hidden">${name}</span>`,
            })),
          ],
          chosen: shape,
          choose: (chosen) => session.painting.setBrush((brush) => (brush.shape = chosen)),
        })}
        ${
          session.canPaint
            ? html`<button aria-label=${words.new_shape} title=${words.new_hint} @click=${() => this._input.click()}>${icon("plus")}</button>
              <input type="file" accept="image/png,image/jpeg" hidden aria-label=${words.new_shape} @change=${this.onFile} />`
            : nothing
        }
      </div>
      ${
        tool && session.canCurate
          ? html`<strata-menu label=${texts.layers.options(tool.name)}>
            <button class="quiet" role="menuitem" @click=${() => void this.rename(tool)}>${icon("edit")}${words.rename}</button>
            <button class="quiet" role="menuitem" @click=${() => void this.removeTool(tool)}>${icon("trash")}${texts.layers.delete}</button>
          </strata-menu>`
          : nothing
      }
      ${
        this._file
          ? html`<strata-shape-dialog .session=${session} .file=${this._file} @closed=${() => (this._file = null)}></strata-shape-dialog>`
          : nothing
      }`;
  }

  private onFile(): void {
    this._file = this._input.files?.[0] ?? null;
    this._input.value = "";
  }

  private take(file: File): void {
    if (isPicture(file)) this._file = file;
    else notices.show("problem", texts.shapes.unreadable(file.name));
  }

  private async rename(tool: Tool): Promise<void> {
    const words = texts.shapes;
    const name = await askText({
      heading: words.rename_title(tool.name),
      label: words.name,
      text: tool.name,
      yes: words.rename,
    });
    if (name && name !== tool.name)
      await this.session.shapes.rename(tool, name).catch((error: unknown) => notices.error(error));
  }

  private async removeTool(tool: Tool): Promise<void> {
    const words = texts.shapes;
    const question = {
      heading: words.delete_title(tool.name),
      lead: words.delete_lead,
      yes: texts.delete,
      danger: true,
    };
    if (await ask(question))
      await this.session.shapes.remove(tool).catch((error: unknown) => notices.error(error));
  }
}
