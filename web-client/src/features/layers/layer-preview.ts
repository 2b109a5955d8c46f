// <strata-layer-preview>: what a computed layer would contain, as a picture of the current view with
// the legend and the range of the values, before the layer is created.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { formatPercent } from "../../core/locale";
import type { LayerPreview } from "../../core/protocol.gen";
import { completePalette, type LayerCreate } from "../../core/types";
import { formatNumber } from "../../domain/measure";
import { ApiError } from "../../net/api-error";
import type { ModelSession } from "../../session/model-session";
import { pictureOfView } from "../../session/view-picture";
import { texts } from "../../texts";
import { sharedStyles } from "../../ui/styles";
import { legendStyles, paletteLegend } from "./legend";

const words = texts.layer_preview;

@customElement("strata-layer-preview")
export class StrataLayerPreview extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _shown: LayerPreview | null = null;
  @state() private _running: AbortController | null = null;
  private _wanted = 0; // resolution of the layer

  static override styles = [
    sharedStyles,
    legendStyles,
    css`
      figure {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--ground);
      }
      img {
        width: 100%;
        max-height: 22rem;
        object-fit: contain;
      }
      .told {
        display: flex;
        align-items: center;
        justify-content: space-between;
        gap: var(--space-3);
      }
    `,
  ];

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.clear();
  }

  /** Computes and shows a layer, which replaces the previous one. Throws the server's problems. */
  async show(layer: LayerCreate): Promise<void> {
    this.clear();
    const running = (this._running = new AbortController());
    this._wanted = layer.resolution ?? this.session.model?.default_resolution ?? 0;
    void this.updateComplete.then(() => this.scrollIntoView({ block: "nearest" }));
    try {
      const made = await this.session.api.json("POST /models/{model}/layer-preview", {
        path: { model: this.session.modelId },
        body: { layer, picture: pictureOfView(this.session.view.camera) },
        signal: running.signal,
      });
      if (running.signal.aborted) return;
      this._shown = made;
      await this.updateComplete;
      this.scrollIntoView({ block: "nearest" });
    } catch (error) {
      // the user has cancelled it, or changed the layer
      if (!(error instanceof ApiError && running.signal.aborted)) throw error;
    } finally {
      if (this._running === running) this._running = null;
    }
  }

  /** Removes the preview, or cancels it. */
  clear(): void {
    this._running?.abort();
    this._running = this._shown = null;
  }

  override render(): TemplateResult {
    const { _shown: shown } = this;
    return html`<div class="told">
        <p class="hint" role="status">${this._running ? words.running : shown ? this.told(shown) : ""}</p>
        ${this._running ? html`<button @click=${() => this.cancel()}>${texts.cancel}</button>` : nothing}
      </div>
      ${shown ? this.figure(shown) : nothing}`;
  }

  /** Cancels the preview, and returns the focus to the button that began it. */
  private cancel(): void {
    this.clear();
    this.dispatchEvent(new CustomEvent("cancelled"));
  }

  private told({ statistics, palette, unit, share, resolution }: LayerPreview): string {
    const { min, max } = statistics;
    const values =
      min === undefined || max === undefined
        ? words.nothing
        : palette.mode === "categorical"
          ? words.covers(formatPercent(share))
          : words.range(formatNumber(min), formatNumber(max), unit, formatPercent(share));
    return resolution < this._wanted ? `${values} ${words.coarse}` : values;
  }

  private figure({ statistics, palette, unit, picture }: LayerPreview): TemplateResult {
    return html`<figure>
      <img src="data:image/png;base64,${picture}" alt=${words.picture} />
      ${statistics.min === undefined ? nothing : paletteLegend(completePalette(palette), unit, words.legend)}
    </figure>`;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-layer-preview": StrataLayerPreview;
  }
}
