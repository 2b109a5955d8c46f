// <strata-shape-fields>: the kind of a shape layer and its parameters. Part of the dialog of a new
// layer.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { pageLocale } from "../../core/locale";
import type { Look } from "../../core/protocol.gen";
import { ApiError } from "../../net/api-error";
import type { Model, VertexPropertyName } from "../../core/types";
import type { ModelSession } from "../../session/model-session";
import { numberInput } from "../../ui/number-input";
import {
  kRain,
  kRainNumbers,
  kRays,
  kShapeGroups,
  kSunAngles,
  type Months,
  otherModels,
  type RainNumber,
  recipeOf,
  shapeKind,
  type ShapeInput,
  type ShapeKind,
  type ShapeLength,
  type SunAngle,
} from "./shape-kinds";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.shape;

@customElement("strata-shape-fields")
export class StrataShapeFields extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The field with a problem that the server or the dialog reports. */
  @property() wrong = "";
  @state() private _input: ShapeInput = {
    kind: "mean_curvature",
    radius: "",
    distance: "",
    normal: "",
    projection: "",
    registration: "",
    latitude: "",
    north: "",
    months: { from: 1, to: 12 },
    wind_shares: "",
    wind_speed_m_s: "",
    rain_mm: "",
    rain_mm_per_hour: "",
    rays: "",
    absolute: false,
    model: "",
    property: "",
    look: "",
  };
  @state() private _models: Model[] = [];
  @state() private _properties: VertexPropertyName[] = [];
  @state() private _looks: Look[] = [];

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-3);
      }
      .lead {
        margin: calc(-1 * var(--space-2)) 0 0;
      }
      .parameters {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-3);
        align-items: start;
      }
      .parameters .field {
        flex: 1 1 220px;
      }
      .length {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      .length input {
        flex: 1;
        min-width: 0;
      }
      .check {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private async load(): Promise<void> {
    const { api, modelId, model } = this.session;
    try {
      const [models, looks, { properties }] = await Promise.all([
        api.all("GET /models", "models"),
        api.all("GET /models/{model}/looks", "looks", { path: { model: modelId } }),
        api.json("GET /models/{model}/vertex-properties", { path: { model: modelId } }),
      ]);
      this._models = model ? otherModels(models, model) : [];
      this._properties = properties;
      this._looks = looks;
      const [firstModel, firstProperty] = [this._models[0], properties[0]];
      this.change({
        model: firstModel ? String(firstModel.id) : "",
        property: firstProperty ? keyOf(firstProperty) : "",
      });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // other kinds work without the list
    }
  }

  get kindTitle(): string {
    const { kind, property: chosen } = this._input;
    return kind === "vertex_property" && chosen
      ? chosen.slice(chosen.indexOf("/") + 1)
      : shapeKind(kind).title;
  }

  recipe(): ReturnType<typeof recipeOf> {
    return recipeOf(this._input);
  }

  override render(): TemplateResult {
    const info = shapeKind(this._input.kind);
    return html`<label class="field">
        <span>${words.kind}</span>
        <select name="kind" @change=${(event: Event) => this.choose((event.target as HTMLSelectElement).value as ShapeKind)}>
          ${kShapeGroups.map(
            (group) =>
              html`<optgroup label=${group.title}>
                ${group.kinds
                  .filter(({ kind }) => this.isPossible(kind))
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
            ${info.takes.includes("model") ? this.modelField() : nothing}
            ${info.takes.includes("property") ? this.propertyField() : nothing}
            ${info.takes.includes("look") ? this.lookField() : nothing}
            ${kLengths.map((name) => (info.takes.includes(name) ? this.lengthField(name) : nothing))}
            ${kAngles.map((name) => (info.takes.includes(name) ? this.angleField(name) : nothing))}
            ${info.takes.includes("months") ? kEnds.map((end) => this.monthField(end)) : nothing}
            ${info.takes.includes("wind_shares") ? this.windField() : nothing}
            ${kRain.map((name) => (info.takes.includes(name) ? this.rainField(name) : nothing))}
            ${info.takes.includes("rays") ? this.raysField() : nothing}
            ${info.takes.includes("absolute") ? this.absoluteField() : nothing}
          </div>`
      }`;
  }

  private isPossible(kind: ShapeKind): boolean {
    if (kind === "vertex_property") return this._properties.length > 0;
    if (kind === "part") return Boolean(this.session.model?.parts);
    return !shapeKind(kind).takes.includes("model") || this._models.length > 0;
  }

  private lengthField(name: ShapeLength): TemplateResult {
    const { label, hint, lead }: { label: string; hint: string; lead?: string } =
      words.lengths[name];
    return html`<label class="field">
      <span>${label}</span>
      <div class="length">
        ${numberInput({ name, value: this._input[name], placeholder: hint, min: 0, wrong: this.wrong === name, typed: (text) => this.change({ [name]: text }) })}
        mm
      </div>
      ${lead ? html`<small>${lead}</small>` : nothing}
    </label>`;
  }

  private angleField(name: SunAngle): TemplateResult {
    const { label, hint, lead } = words.sun[name];
    const most = kSunAngles[name];
    return html`<label class="field">
      <span>${label}</span>
      <div class="length">
        ${numberInput({ name, value: this._input[name], placeholder: hint, min: -most, max: most, wrong: this.wrong.startsWith(name), typed: (text) => this.change({ [name]: text }) })}
        °
      </div>
      <small>${lead}</small>
    </label>`;
  }

  private monthField(end: keyof Months): TemplateResult {
    const month = new Intl.DateTimeFormat(pageLocale(), { month: "long", timeZone: "UTC" });
    const choose = (event: Event): void =>
      this.change({
        months: { ...this._input.months, [end]: Number((event.target as HTMLSelectElement).value) },
      });
    return html`<label class="field">
      <span>${words.sun[end]}</span>
      <select name=${end} @change=${choose}>
        ${Array.from({ length: 12 }, (_, at) => html`<option value=${at + 1} ?selected=${at + 1 === this._input.months[end]}>${month.format(Date.UTC(2001, at))}</option>`)}
      </select>
    </label>`;
  }

  private windField(): TemplateResult {
    const { label, hint, lead } = words.rain.wind_shares;
    return html`<label class="field">
      <span>${label}</span>
      <input
        name="wind_shares"
        autocomplete="off"
        .value=${this._input.wind_shares}
        placeholder=${hint}
        aria-invalid=${this.wrong === "wind_shares" ? "true" : nothing}
        @input=${(event: Event) => this.change({ wind_shares: (event.target as HTMLInputElement).value })}
      />
      <small>${lead}</small>
    </label>`;
  }

  private rainField(name: RainNumber): TemplateResult {
    const { label, hint, lead } = words.rain[name];
    const { least, most, unit } = kRainNumbers[name];
    return html`<label class="field">
      <span>${label}</span>
      <div class="length">
        ${numberInput({ name, value: this._input[name], placeholder: hint, min: least, max: most, wrong: this.wrong === name, typed: (text) => this.change({ [name]: text }) })}
        ${unit}
      </div>
      <small>${lead}</small>
    </label>`;
  }

  private raysField(): TemplateResult {
    return html`<label class="field">
      <span>${words.rays}</span>
      ${numberInput({
        name: "rays",
        title: words.rays_hint,
        value: this._input.rays,
        placeholder: kRays.usual,
        min: kRays.least,
        max: kRays.most,
        wrong: this.wrong === "rays",
        typed: (rays) => this.change({ rays }),
      })}
    </label>`;
  }

  private absoluteField(): TemplateResult {
    return html`<label class="check">
      <input
        type="checkbox"
        name="absolute"
        .checked=${this._input.absolute}
        @change=${(event: Event) => this.change({ absolute: (event.target as HTMLInputElement).checked })}
      />
      ${words.absolute}
    </label>`;
  }

  private modelField(): TemplateResult {
    return html`<label class="field">
      <span>${words.model}</span>
      <select name="model" @change=${(event: Event) => this.change({ model: (event.target as HTMLSelectElement).value })}>
        ${this._models.map(({ id, name }) => html`<option value=${id} ?selected=${String(id) === this._input.model}>${name}</option>`)}
      </select>
    </label>`;
  }

  private lookField(): TemplateResult {
    return html`<label class="field">
      <span>${words.look}</span>
      <select name="look" @change=${(event: Event) => this.change({ look: (event.target as HTMLSelectElement).value })}>
        <option value="">${words.look_visible}</option>
        ${this._looks.map(({ id, name }) => html`<option value=${id} ?selected=${String(id) === this._input.look}>${name}</option>`)}
      </select>
    </label>`;
  }

  private propertyField(): TemplateResult {
    const files = new Set(this._properties.map(({ source }) => source)).size;
    return html`<label class="field">
      <span>${words.property}</span>
      <select name="property" @change=${(event: Event) => this.change({ property: (event.target as HTMLSelectElement).value })}>
        ${this._properties.map((each) => {
          const key = keyOf(each);
          return html`<option value=${key} ?selected=${key === this._input.property}>
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
    this._input = { ...this._input, ...change };
  }
}

const kLengths = ["radius", "registration", "projection", "normal", "distance"] as const;

const kAngles = ["latitude", "north"] as const;
const kEnds = ["from", "to"] as const;

const keyOf = ({ source, property: name }: VertexPropertyName): string => `${source}/${name}`;
