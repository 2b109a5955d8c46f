// <strata-shape-dialog>: makes a brush shape from a picture. It sets the part to use and a name,
// and shows a preview.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { nameOfFile } from "../../domain/file-names";
import { inSquare, kShapeSide, likelyPart, toShape, type ShapePart } from "../../domain/shape";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { radioGroup } from "../../ui/radio-group";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const kParts: readonly ShapePart[] = ["opaque", "light", "dark"];

@customElement("strata-shape-dialog")
export class StrataShapeDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) file!: File;
  @state() private _part: ShapePart | null = null; // null while the picture is loading
  @state() private _problem = "";
  @state() private _working = false;
  @query("canvas") private _canvas!: HTMLCanvasElement;
  @query("input") private _name!: HTMLInputElement;

  private _picture: ImageBitmap | null = null;

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      canvas {
        justify-self: center;
        width: 160px;
        height: 160px;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--mark-light); /* the shape is black */
      }
      .segments {
        display: flex;
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.shapes;
    return html`<strata-dialog heading=${words.new_title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="shape" @submit=${(event: Event) => this.onSubmit(event)}>
        <p class="hint">${words.lead}</p>
        <canvas width=${kShapeSide} height=${kShapeSide} role="img" aria-label=${words.preview}></canvas>
        ${radioGroup<ShapePart>({
          label: words.part,
          class: "segments",
          choices: kParts.map((value) => ({ value, content: words.parts[value] })),
          chosen: this._part,
          choose: (part) => this.show(part),
        })}
        <label class="field">
          <span>${words.name}</span>
          <input type="text" required maxlength="100" .value=${nameOfFile(this.file.name)} />
        </label>
        ${this._problem ? html`<p class="error" role="alert">${this._problem}</p>` : nothing}
      </form>
      <button slot="actions" class="primary" form="shape" ?disabled=${this._part === null || this._working || this._problem !== ""}>
        ${this._working ? words.adding : words.add}
      </button>
    </strata-dialog>`;
  }

  override firstUpdated(): void {
    void this.read();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._picture?.close();
  }

  private async read(): Promise<void> {
    try {
      this._picture = await createImageBitmap(this.file);
    } catch {
      this._problem = texts.shapes.unreadable(this.file.name);
      return;
    }
    // The analysis omits the square around the picture, because it would treat the square as
    // transparent.
    const { width, height } = this._picture;
    const { width: smallWidth, height: smallHeight } = inSquare(width, height, kShapeSide);
    const canvas = new OffscreenCanvas(
      Math.max(1, Math.round(smallWidth)),
      Math.max(1, Math.round(smallHeight)),
    );
    const context = canvas.getContext("2d")!;
    context.drawImage(this._picture, 0, 0, canvas.width, canvas.height);
    this.show(likelyPart(context.getImageData(0, 0, canvas.width, canvas.height)));
  }

  private show(part: ShapePart): void {
    if (!this._picture) return;
    this._part = part;
    const { x, y, width, height } = inSquare(this._picture.width, this._picture.height, kShapeSide);
    const context = this._canvas.getContext("2d", { willReadFrequently: true })!;
    context.clearRect(0, 0, kShapeSide, kShapeSide);
    context.imageSmoothingQuality = "high";
    context.drawImage(this._picture, x, y, width, height);
    const pixels = context.getImageData(0, 0, kShapeSide, kShapeSide);
    const any = toShape(pixels, part);
    context.putImageData(pixels, 0, 0);
    this._problem = any ? "" : texts.shapes.empty;
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
    const name = this._name.value.trim();
    if (this._part && name && !this._working) void this.add(name, this._part);
  }

  private async add(name: string, part: ShapePart): Promise<void> {
    this._working = true;
    try {
      await this.session.shapes.add(this.file, name, part);
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      this._problem = error instanceof ApiError ? error.message : texts.problems.unexpected;
    } finally {
      this._working = false;
    }
  }
}
