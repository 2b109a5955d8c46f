// <strata-map-dialog>: paints a layer from a file: readings (CSV), a flat map (GeoJSON) or an orthophoto.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../core/api";
import { format_area } from "../core/measure";
import type { Layer } from "../core/types";
import "./dialog";
import { follow_session } from "./follow-session";
import { kAlong, map_kind, number_attributes, world_numbers, type Along, type MapKind } from "./map-file";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { number_field_styles, shared_styles } from "./styles";
import { texts } from "./texts";
import "./value-picker";

@customElement("strata-map-dialog")
export class StrataMapDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private file_: File | null = null;
  @state() private kind_: MapKind | null = null;
  @state() private attributes_: string[] = [];
  @state() private attribute_ = "";
  @state() private problem_ = "";
  @state() private working_ = false;
  private radius_mm_ = 5;
  private tolerance_mm_ = 5;
  private along_: Along = "-z";
  private world_ = "";

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    number_field_styles,
    css`
      form {
        display: grid;
        gap: 14px;
      }
      .pair {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(140px, 1fr));
        gap: 12px;
      }
      textarea {
        font: 0.95rem var(--mono);
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.maps;
    return html`<strata-dialog heading=${words.title(this.layer.name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="map" @submit=${(event: Event) => this.on_submit(event)}>
        <p class="hint">${words.lead}</p>
        <label class="field">
          <span>${words.file}</span>
          <input type="file" accept=".csv,.tsv,.txt,.geojson,.json,.png,.jpg,.jpeg" @change=${(event: Event) => void this.on_file(event)} />
        </label>
        ${this.kind_ === "readings" ? this.readings() : nothing} ${this.kind_ === "polygons" ? this.polygons() : nothing}
        ${this.kind_ === "picture" ? this.picture() : nothing}
        ${this.problem_ ? html`<p class="error" role="alert">${this.problem_}</p>` : nothing}
        ${this.working_ ? html`<p class="hint" role="status">${words.working}</p>` : nothing}
      </form>
      <button slot="actions" class="primary" form="map" ?disabled=${!this.kind_ || this.working_} @click=${() => void this.apply()}>
        ${words.paint}
      </button>
    </strata-dialog>`;
  }

  private readings(): TemplateResult {
    const words = texts.maps;
    const length = (label: string, value: number, set: (mm: number) => void): TemplateResult =>
      html`<label class="field">
        <span>${label}</span>
        <span class="number">
          <input
            type="number"
            min="0"
            step="any"
            .value=${String(value)}
            @input=${(event: Event) => set(Number((event.target as HTMLInputElement).value))}
          />
          <span>mm</span>
        </span>
      </label>`;
    return html`<p class="hint">${words.readings_hint}</p>
      <div class="pair">
        ${length(words.radius, this.radius_mm_, (mm) => (this.radius_mm_ = mm))}
        ${length(words.tolerance, this.tolerance_mm_, (mm) => (this.tolerance_mm_ = mm))}
      </div>`;
  }

  private polygons(): TemplateResult {
    const words = texts.maps;
    const { session, layer } = this;
    return html`${this.direction()}
      <label class="field">
        <span>${words.attribute}</span>
        <select @change=${(event: Event) => (this.attribute_ = (event.target as HTMLSelectElement).value)}>
          <option value="">${words.one_value}</option>
          ${this.attributes_.map((name) => html`<option value=${name} ?selected=${name === this.attribute_}>${name}</option>`)}
        </select>
      </label>
      ${this.attribute_ === ""
        ? html`<strata-value-picker
            .session=${session}
            .layer=${layer}
            .value=${session.painting.brush.value_of(layer)}
          ></strata-value-picker>`
        : nothing}`;
  }

  private picture(): TemplateResult {
    const words = texts.maps;
    return html`<p class="hint">${words.picture_hint}</p>
      ${this.direction()}
      <label class="field">
        <span>${words.world}</span>
        <textarea
          rows="2"
          placeholder="0.5, 0, 0, -0.5, 100, 200"
          @input=${(event: Event) => (this.world_ = (event.target as HTMLTextAreaElement).value)}
        ></textarea>
      </label>`;
  }

  private direction(): TemplateResult {
    const words = texts.maps;
    return html`<label class="field">
      <span>${words.along}</span>
      <select @change=${(event: Event) => (this.along_ = (event.target as HTMLSelectElement).value as Along)}>
        ${kAlong.map((along) => html`<option value=${along} ?selected=${along === this.along_}>${words.direction[along]}</option>`)}
      </select>
    </label>`;
  }

  private async on_file(event: Event): Promise<void> {
    const [file] = (event.target as HTMLInputElement).files ?? [];
    this.file_ = file ?? null;
    this.kind_ = file ? map_kind(file.name) : null;
    this.problem_ = file && !this.kind_ ? texts.maps.unknown(file.name) : "";
    this.attribute_ = "";
    this.attributes_ = file && this.kind_ === "polygons" ? number_attributes(await file.text()) : [];
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    void this.apply();
  }

  /** The query of the request; a text that says what is missing. */
  private query(kind: MapKind): Record<string, string> | string {
    if (kind === "readings") return { radius_mm: String(this.radius_mm_), tolerance_mm: String(this.tolerance_mm_) };
    if (kind === "polygons") {
      const value = this.session.painting.brush.value_of(this.layer);
      return { along: this.along_, ...(this.attribute_ ? { attribute: this.attribute_ } : { value: String(value) }) };
    }
    const world = world_numbers(this.world_);
    return world === null ? texts.maps.world_wrong : { along: this.along_, world };
  }

  private async apply(): Promise<void> {
    const { session, layer, file_: file, kind_: kind } = this;
    if (!file || !kind || this.working_) return;
    const query = this.query(kind);
    if (typeof query === "string") {
      this.problem_ = query;
      return;
    }
    this.working_ = true;
    this.problem_ = "";
    try {
      const { texels_changed, area_m2 } = await session.api.paint_map(session.model_id, layer.id, kind, query, file);
      if (texels_changed === 0) notices.show("info", texts.areas.nothing_changed);
      else notices.show("success", texts.areas.changed(format_area(area_m2)));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      this.problem_ = error instanceof ApiError ? error.message : texts.problems.unexpected;
    } finally {
      this.working_ = false;
    }
  }
}
