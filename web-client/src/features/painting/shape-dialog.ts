// <strata-shape-dialog>: a picture becomes a shape of the brush: what of it, and under what name,
// with a look at the result.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError, name_of_file } from "../../net/api";
import { in_square, kShapeSide, likely_part, to_shape, type ShapePart } from "../../domain/shape";
import "../../ui/dialog";
import type { ModelSession } from "../../session/model-session";
import { radio_group } from "../../ui/radio-group";
import { form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const kParts: readonly ShapePart[] = ["opaque", "light", "dark"];

@customElement("strata-shape-dialog")
export class StrataShapeDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) file!: File;
  @state() private part_: ShapePart | null = null; // null: the picture is being read
  @state() private problem_ = "";
  @state() private working_ = false;
  @query("canvas") private canvas_!: HTMLCanvasElement;
  @query("input") private name_!: HTMLInputElement;

  private picture_: ImageBitmap | null = null;

  static override styles = [
    shared_styles,
    form_styles,
    css`
      canvas {
        justify-self: center;
        width: 160px;
        height: 160px;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--mark-light); /* the shape is drawn in black, as the brush will see it */
      }
      .segments {
        display: flex;
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.shapes;
    return html`<strata-dialog heading=${words.new_title} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="shape" @submit=${(event: Event) => this.on_submit(event)}>
        <p class="hint">${words.lead}</p>
        <canvas width=${kShapeSide} height=${kShapeSide} role="img" aria-label=${words.preview}></canvas>
        ${radio_group<ShapePart>({
          label: words.part,
          class: "segments",
          choices: kParts.map((value) => ({ value, content: words.parts[value] })),
          chosen: this.part_,
          choose: (part) => this.show(part),
        })}
        <label class="field">
          <span>${words.name}</span>
          <input type="text" required maxlength="100" .value=${name_of_file(this.file.name)} />
        </label>
        ${this.problem_ ? html`<p class="error" role="alert">${this.problem_}</p>` : nothing}
      </form>
      <button slot="actions" class="primary" form="shape" ?disabled=${this.part_ === null || this.working_ || this.problem_ !== ""}>
        ${this.working_ ? words.adding : words.add}
      </button>
    </strata-dialog>`;
  }

  override firstUpdated(): void {
    void this.read();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.picture_?.close();
  }

  private async read(): Promise<void> {
    try {
      this.picture_ = await createImageBitmap(this.file);
    } catch {
      this.problem_ = texts.shapes.unreadable(this.file.name);
      return;
    }
    // Looked at without the square around it, which would seem transparent.
    const { width, height } = this.picture_;
    const { width: small_width, height: small_height } = in_square(width, height, kShapeSide);
    const canvas = new OffscreenCanvas(
      Math.max(1, Math.round(small_width)),
      Math.max(1, Math.round(small_height)),
    );
    const context = canvas.getContext("2d")!;
    context.drawImage(this.picture_, 0, 0, canvas.width, canvas.height);
    this.show(likely_part(context.getImageData(0, 0, canvas.width, canvas.height)));
  }

  private show(part: ShapePart): void {
    if (!this.picture_) return;
    this.part_ = part;
    const { x, y, width, height } = in_square(
      this.picture_.width,
      this.picture_.height,
      kShapeSide,
    );
    const context = this.canvas_.getContext("2d", { willReadFrequently: true })!;
    context.clearRect(0, 0, kShapeSide, kShapeSide);
    context.imageSmoothingQuality = "high";
    context.drawImage(this.picture_, x, y, width, height);
    const pixels = context.getImageData(0, 0, kShapeSide, kShapeSide);
    const any = to_shape(pixels, part);
    context.putImageData(pixels, 0, 0);
    this.problem_ = any ? "" : texts.shapes.empty;
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    const name = this.name_.value.trim();
    if (this.part_ && name && !this.working_) void this.add(name, this.part_);
  }

  private async add(name: string, part: ShapePart): Promise<void> {
    this.working_ = true;
    try {
      await this.session.shapes.add(this.file, name, part);
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      this.problem_ = error instanceof ApiError ? error.message : texts.problems.unexpected;
    } finally {
      this.working_ = false;
    }
  }
}
