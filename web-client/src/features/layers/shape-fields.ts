// <strata-shape-fields>: which values are computed from the shape, and with what parameters; part
// of the dialog of a new layer.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import type { Model, VertexPropertyName } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { number_input } from "../../ui/number-input";
import {
  kRays,
  kShapeGroups,
  other_models,
  recipe_of,
  shape_kind,
  type ShapeInput,
  type ShapeKind,
} from "./shape-kinds";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.shape;

@customElement("strata-shape-fields")
export class StrataShapeFields extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The field that the server or the dialog found wrong. */
  @property() wrong = "";
  @state() private input_: ShapeInput = {
    kind: "mean_curvature",
    radius: "",
    distance: "",
    rays: "",
    absolute: false,
    model: "",
    property: "",
  };
  @state() private models_: Model[] = [];
  @state() private properties_: VertexPropertyName[] = [];

  static override styles = [
    shared_styles,
    css`
      :host {
        display: grid;
        gap: 12px;
      }
      .lead {
        margin: -6px 0 0;
      }
      .parameters {
        display: flex;
        flex-wrap: wrap;
        gap: 12px;
        align-items: end;
      }
      .parameters .field {
        flex: 1 1 180px;
      }
      .length {
        display: flex;
        align-items: center;
        gap: 8px;
      }
      .length input {
        flex: 1;
        min-width: 0;
      }
      .check {
        display: flex;
        align-items: center;
        gap: 9px;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private async load(): Promise<void> {
    const { api, model_id, model } = this.session;
    try {
      const [models, properties] = await Promise.all([
        api.models(),
        api.vertex_properties(model_id),
      ]);
      this.models_ = model ? other_models(models, model) : [];
      this.properties_ = properties;
      const [first_model, first_property] = [this.models_[0], properties[0]];
      this.change({
        model: first_model ? String(first_model.id) : "",
        property: first_property ? key_of(first_property) : "",
      });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // what needs no list still works
    }
  }

  get kind_title(): string {
    const { kind, property: chosen } = this.input_;
    return kind === "vertex_property" && chosen
      ? chosen.slice(chosen.indexOf("/") + 1)
      : shape_kind(kind).title;
  }

  recipe(): ReturnType<typeof recipe_of> {
    return recipe_of(this.input_);
  }

  override render(): TemplateResult {
    const info = shape_kind(this.input_.kind);
    return html`<label class="field">
        <span>${words.kind}</span>
        <select name="kind" @change=${(event: Event) => this.choose((event.target as HTMLSelectElement).value as ShapeKind)}>
          ${kShapeGroups.map(
            (group) =>
              html`<optgroup label=${group.title}>
                ${group.kinds
                  .filter(({ kind }) => this.is_possible(kind))
                  .map(
                    ({ kind, title }) =>
                      html`<option value=${kind} ?selected=${kind === info.kind}>${title}</option>`,
                  )}
              </optgroup>`,
          )}
        </select>
      </label>
      <p class="hint lead">${info.lead}</p>
      ${
        info.takes.length === 0
          ? nothing
          : html`<div class="parameters">
            ${info.takes.includes("model") ? this.model_field() : nothing}
            ${info.takes.includes("property") ? this.property_field() : nothing}
            ${info.takes.includes("radius") ? this.length_field("radius", words.radius, words.radius_hint) : nothing}
            ${info.takes.includes("distance") ? this.length_field("distance", words.distance, words.distance_hint) : nothing}
            ${info.takes.includes("rays") ? this.rays_field() : nothing}
            ${info.takes.includes("absolute") ? this.absolute_field() : nothing}
          </div>`
      }`;
  }

  private is_possible(kind: ShapeKind): boolean {
    if (kind === "vertex_property") return this.properties_.length > 0;
    return kind !== "model_distance" || this.models_.length > 0;
  }

  private length_field(name: "radius" | "distance", label: string, hint: string): TemplateResult {
    return html`<label class="field">
      <span>${label}</span>
      <div class="length">
        ${number_input({ name, value: this.input_[name], placeholder: hint, min: 0, wrong: this.wrong === name, typed: (text) => this.change({ [name]: text }) })}
        mm
      </div>
    </label>`;
  }

  private rays_field(): TemplateResult {
    return html`<label class="field">
      <span>${words.rays}</span>
      ${number_input({
        name: "rays",
        title: words.rays_hint,
        value: this.input_.rays,
        placeholder: kRays.usual,
        min: kRays.least,
        max: kRays.most,
        wrong: this.wrong === "rays",
        typed: (rays) => this.change({ rays }),
      })}
    </label>`;
  }

  private absolute_field(): TemplateResult {
    return html`<label class="check">
      <input
        type="checkbox"
        name="absolute"
        .checked=${this.input_.absolute}
        @change=${(event: Event) => this.change({ absolute: (event.target as HTMLInputElement).checked })}
      />
      ${words.absolute}
    </label>`;
  }

  private model_field(): TemplateResult {
    return html`<label class="field">
      <span>${words.model}</span>
      <select name="model" @change=${(event: Event) => this.change({ model: (event.target as HTMLSelectElement).value })}>
        ${this.models_.map(({ id, name }) => html`<option value=${id} ?selected=${String(id) === this.input_.model}>${name}</option>`)}
      </select>
    </label>`;
  }

  private property_field(): TemplateResult {
    const files = new Set(this.properties_.map(({ source }) => source)).size;
    return html`<label class="field">
      <span>${words.property}</span>
      <select name="property" @change=${(event: Event) => this.change({ property: (event.target as HTMLSelectElement).value })}>
        ${this.properties_.map((each) => {
          const key = key_of(each);
          return html`<option value=${key} ?selected=${key === this.input_.property}>
            ${files > 1 ? `${each.property} (${each.source})` : each.property}
          </option>`;
        })}
      </select>
    </label>`;
  }

  private choose(kind: ShapeKind): void {
    this.change({ kind });
    this.dispatchEvent(new CustomEvent("kind-changed"));
  }

  private change(change: Partial<ShapeInput>): void {
    this.input_ = { ...this.input_, ...change };
  }
}

const key_of = ({ source, property: name }: VertexPropertyName): string => `${source}/${name}`;
