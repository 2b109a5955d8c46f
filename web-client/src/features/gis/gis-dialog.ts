// <strata-gis-dialog>: how GIS programs read the layers of the model, and a layer as GeoTIFF.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { Layer, Model } from "../../core/types";
import { kAlong, type Along } from "../../domain/along";
import { labelOf } from "../../domain/cells";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../ui/copy-field";
import "../../ui/dialog";
import { icon } from "../../ui/icons";
import { saveFrom } from "../../ui/save-from";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.gis_dialog;

/** Returns the address of the GeoTIFF of a layer. Null: the direction that the server chooses. */
export function coverageAddress(model: Model, layer: Layer, along: Along | null): string {
  const query = new URLSearchParams({ f: "tiff", ...(along ? { along } : {}) });
  return `/ogc/collections/${model.slug}.${layer.slug}/coverage?${query}`;
}

@customElement("strata-gis-dialog")
export class StrataGisDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _layer: number | null = null;
  @state() private _along: Along | null = null;

  constructor() {
    super();
    followSession(this, "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      .content,
      .group {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-4);
      }
      .group {
        gap: var(--space-2);
      }
      .group button,
      a {
        justify-self: start;
      }
    `,
  ];

  override render(): TemplateResult {
    const { model } = this.session;
    return html`<strata-dialog
      heading=${words.title}
      way_out=${texts.close}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      <div class="content">
        <p>${words.lead}</p>
        <div class="group">
          <span class="caption">${words.address}</span>
          <strata-copy-field label=${words.address} .text=${`${location.origin}/ogc`}></strata-copy-field>
          <p class="hint">${words.address_hint}</p>
        </div>
        <div class="group">
          <span class="caption">${words.token}</span>
          <p class="hint">${words.token_hint}</p>
        </div>
        ${model ? this.raster(model) : nothing}
        ${model ? html`<a target="_blank" rel="noopener" href=${`/ogc/collections/${model.slug}?f=html`}>${words.collections}</a>` : nothing}
      </div>
    </strata-dialog>`;
  }

  private raster(model: Model): TemplateResult | typeof nothing {
    const all = [...this.session.layers.all].reverse();
    const layer = all.find(({ id }) => id === this._layer) ?? all[0];
    if (!layer) return nothing;
    const chooseLayer = (event: Event): void => {
      this._layer = Number((event.target as HTMLSelectElement).value);
    };
    const chooseAlong = (event: Event): void => {
      const { value } = event.target as HTMLSelectElement;
      this._along = kAlong.find((along) => along === value) ?? null;
    };
    const save = (): void =>
      saveFrom(coverageAddress(model, layer, this._along), `${model.slug}-${layer.slug}.tif`);
    return html`<div class="group">
      <span class="caption">${words.raster}</span>
      <label class="field">
        <span>${words.layer}</span>
        <select name="layer" @change=${chooseLayer}>
          ${all.map((each) => html`<option value=${each.id} ?selected=${each === layer}>${labelOf(each)}</option>`)}
        </select>
      </label>
      <label class="field">
        <span>${words.along}</span>
        <select name="along" aria-describedby="along_hint" @change=${chooseAlong}>
          <option value="" ?selected=${this._along === null}>${words.usual}</option>
          ${kAlong.map((along) => html`<option value=${along} ?selected=${along === this._along}>${texts.maps.direction[along]}</option>`)}
        </select>
      </label>
      <p class="hint" id="along_hint">${words.along_hint}</p>
      <button type="button" @click=${save}>${icon("picture")}${words.save}</button>
    </div>`;
  }
}
