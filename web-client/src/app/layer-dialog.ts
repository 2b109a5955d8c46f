// <strata-layer-dialog>: makes a layer, or changes one's name, classes and colours, in the words of who studies the
// object. With `layer` it edits; without, it creates.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { detail_choices, format_length } from "../core/measure";
import {
  class_palette,
  kClassColors,
  measurement_palette,
  opaque_color,
  presence_palette,
  purpose_of,
  type LayerPurpose,
} from "../core/palette";
import type { Layer, LayerCreate, Palette, Resolution } from "../core/types";
import { ApiError } from "../core/api";
import "./dialog";
import type { StrataDialog } from "./dialog";
import { icon } from "./icons";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { shared_styles } from "./styles";
import { texts } from "./texts";

type Purpose = Exclude<LayerPurpose, "records">;

interface ClassRow {
  at: number;
  label: string;
  color: string; // #rrggbbaa
}

const kMostClasses = 255;
const words = texts.layer_dialog;

@customElement("strata-layer-dialog")
export class StrataLayerDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer: Layer | null = null;

  @state() private purpose_: Purpose = "presence";
  @state() private color_ = "#d55e00ff";
  @state() private classes_: ClassRow[] = [];
  @state() private stepped_ = false;
  @state() private problem_ = "";
  @state() private problem_field_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("form") private form_!: HTMLFormElement;

  static override styles = [
    shared_styles,
    css`
      form {
        display: grid;
        gap: 16px;
      }
      .kinds {
        display: grid;
        grid-template-columns: repeat(3, 1fr);
        gap: 10px;
      }
      .kinds button {
        display: grid;
        align-content: start;
        justify-items: start;
        gap: 3px;
        height: auto;
        padding: 12px 13px;
        text-align: left;
        white-space: normal;
        border-radius: var(--radius);
      }
      .kinds button b {
        font: 600 1.02rem var(--serif);
      }
      .kinds button span {
        font-size: 0.82rem;
        line-height: 1.35;
        color: var(--ink-soft);
      }
      .kinds button[aria-checked="true"] {
        border-color: var(--accent);
        box-shadow: inset 0 0 0 1px var(--accent);
        background: var(--accent-soft);
      }
      .two {
        display: flex;
        gap: 12px;
        align-items: end;
      }
      .two > label:first-child {
        flex: 1;
      }
      .classes {
        display: grid;
        gap: 7px;
        max-height: 270px;
        overflow: auto;
        padding: 3px;
        margin: -3px;
      }
      .class {
        display: flex;
        gap: 8px;
        align-items: center;
      }
      .range {
        display: grid;
        grid-template-columns: 1fr auto 1fr 96px;
        align-items: end;
        gap: 10px;
      }
      .range > span {
        padding-bottom: 9px;
        color: var(--ink-soft);
      }
      .check {
        display: flex;
        align-items: center;
        gap: 9px;
      }
      .details {
        display: grid;
        gap: 5px;
      }
      .details .segments {
        display: flex;
      }
      .details .segments button {
        min-height: 38px;
      }
      @media (max-width: 560px) {
        .kinds {
          grid-template-columns: 1fr;
        }
        .range {
          grid-template-columns: 1fr auto 1fr;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    const { layer } = this;
    if (!layer) {
      this.classes_ = [1, 2, 3].map((at) => new_class(at));
      return;
    }
    const purpose = purpose_of(layer);
    this.purpose_ = purpose === "records" ? "classes" : purpose;
    this.color_ = layer.palette.points[0]?.color ?? this.color_;
    this.classes_ = layer.palette.points.map(({ at, label, color }) => ({ at, label: label ?? "", color }));
    this.stepped_ = layer.palette.mode === "step";
  }

  override render(): TemplateResult {
    const { layer } = this;
    return html`<strata-dialog
      wide
      heading=${layer ? words.edit_title(layer.name) : words.create_title}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      <form id="form" novalidate @submit=${this.on_submit}>
        ${layer ? nothing : this.kinds()}
        <div class="two">
          <label class="field">
            <span>${words.name}</span>
            <input
              type="text"
              name="name"
              maxlength="200"
              autocomplete="off"
              .value=${layer?.name ?? ""}
              placeholder=${words.name_hint[this.purpose_]}
              aria-invalid=${this.problem_field_ === "name" ? "true" : "false"}
            />
          </label>
          ${this.purpose_ === "presence"
            ? html`<label class="field">
                <span>${words.color}</span>
                <input
                  type="color"
                  .value=${opaque_color(this.color_)}
                  @input=${(event: Event) => (this.color_ = `${(event.target as HTMLInputElement).value}ff`)}
                />
              </label>`
            : nothing}
        </div>
        ${this.purpose_ === "classes" ? this.classes() : nothing}
        ${this.purpose_ === "measurement" ? this.measurement() : nothing} ${layer ? nothing : this.details()}
        <label class="field">
          <span>${words.description}</span>
          <textarea name="description" maxlength="10000" placeholder=${words.description_hint} .value=${layer?.description ?? ""}></textarea>
        </label>
        <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      </form>
      <button slot="actions" @click=${() => this.dialog_.close()}>${texts.cancel}</button>
      <button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => this.form_.requestSubmit()}>
        ${layer ? texts.save : words.create}
      </button>
    </strata-dialog>`;
  }

  private kinds(): TemplateResult {
    const kinds: [Purpose, string, string][] = [
      ["presence", words.presence, words.presence_lead],
      ["classes", words.classes, words.classes_lead],
      ["measurement", words.measurement, words.measurement_lead],
    ];
    return html`<div>
      <p class="caption" id="question">${words.question}</p>
      <div class="kinds" role="radiogroup" aria-labelledby="question">
        ${kinds.map(
          ([purpose, title, lead]) =>
            html`<button
              type="button"
              role="radio"
              aria-checked=${this.purpose_ === purpose}
              @click=${() => (this.purpose_ = purpose)}
            >
              <b>${title}</b><span>${lead}</span>
            </button>`,
        )}
      </div>
    </div>`;
  }

  private classes(): TemplateResult {
    return html`<div class="details">
      <p class="caption">${words.classes_title}</p>
      <div class="classes">
        ${this.classes_.map(
          (row, index) =>
            html`<div class="class">
              <input
                type="color"
                .value=${opaque_color(row.color)}
                aria-label=${words.class_color(row.at)}
                @input=${(event: Event) => this.change_class(index, { color: `${(event.target as HTMLInputElement).value}ff` })}
              />
              <input
                type="text"
                maxlength="200"
                .value=${row.label}
                placeholder=${words.class_default(row.at)}
                aria-label=${words.class_label(row.at)}
                @input=${(event: Event) => this.change_class(index, { label: (event.target as HTMLInputElement).value })}
              />
              <button
                type="button"
                class="icon quiet"
                aria-label=${words.class_remove(row.label || words.class_default(row.at))}
                ?disabled=${this.classes_.length === 1}
                @click=${() => (this.classes_ = this.classes_.filter((_, other) => other !== index))}
              >
                ${icon("close")}
              </button>
            </div>`,
        )}
      </div>
      <div class="row">
        <button type="button" @click=${this.add_class}>${icon("plus")}${words.class_add}</button>
        ${this.layer ? html`<span class="hint">${words.class_kept}</span>` : nothing}
      </div>
    </div>`;
  }

  private measurement(): TemplateResult {
    const palette = this.layer?.palette;
    return html`<div class="range">
        <label class="field">
          <span>${words.range}</span>
          <input type="number" name="min" step="any" .value=${String(palette?.min ?? 0)} />
        </label>
        <span>${words.range_to}</span>
        <label class="field">
          <span class="visually-hidden">${words.range_to}</span>
          <input
            type="number"
            name="max"
            step="any"
            .value=${String(palette?.max ?? 100)}
            aria-invalid=${this.problem_field_ === "max" ? "true" : "false"}
          />
        </label>
        <label class="field">
          <span>${words.unit}</span>
          <input type="text" name="unit" maxlength="50" autocomplete="off" .value=${this.layer?.unit ?? ""} placeholder=${words.unit_hint} />
        </label>
      </div>
      <label class="check">
        <input
          type="checkbox"
          .checked=${this.stepped_}
          @change=${(event: Event) => (this.stepped_ = (event.target as HTMLInputElement).checked)}
        />
        ${words.stepped}
      </label>`;
  }

  private details(): TemplateResult {
    const { model } = this.session;
    if (!model) return html``;
    const choices = detail_choices(model.atlas);
    const preferred = choices.find((choice) => choice.resolution === model.default_resolution) ?? choices[0];
    const chosen = this.chosen_resolution_ ?? preferred?.resolution;
    return html`<div class="details">
      <p class="caption" id="detail">${words.detail}</p>
      <div class="segments" role="radiogroup" aria-labelledby="detail">
        ${choices.map(
          (choice) =>
            html`<button
              type="button"
              role="radio"
              aria-checked=${choice.resolution === chosen}
              @click=${() => (this.chosen_resolution_ = choice.resolution)}
            >
              ${format_length(choice.detail_m)}
            </button>`,
        )}
      </div>
      <p class="hint">${words.detail_hint}</p>
    </div>`;
  }
  @state() private chosen_resolution_: number | null = null;

  private change_class(index: number, change: Partial<ClassRow>): void {
    this.classes_ = this.classes_.map((row, other) => (other === index ? { ...row, ...change } : row));
  }

  private add_class(): void {
    const used = new Set(this.classes_.map((row) => row.at));
    for (let at = 1; at <= kMostClasses; ++at) {
      if (used.has(at)) continue;
      this.classes_ = [...this.classes_, new_class(at)];
      return;
    }
    this.problem_ = words.too_many;
  }

  private async on_submit(event: Event): Promise<void> {
    event.preventDefault();
    const form = new FormData(this.form_);
    const text = (name: string): string => String(form.get(name) ?? "").trim();
    this.problem_ = this.problem_field_ = "";
    const name = text("name");
    if (!name) return this.refuse("name", words.name_missing);
    const palette = this.palette(name, Number(text("min")), Number(text("max")));
    if (!palette) return;
    this.busy_ = true;
    try {
      await this.send(name, text("unit"), text("description"), palette);
      this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse(error.problem.field ?? "", error.message);
    } finally {
      this.busy_ = false;
    }
  }

  private refuse(field: string, problem: string): void {
    this.problem_ = problem;
    this.problem_field_ = field;
  }

  private palette(name: string, min: number, max: number): Palette | null {
    switch (this.purpose_) {
      case "presence": {
        const point = this.layer?.palette.points[0];
        return point
          ? { ...this.layer!.palette, points: [{ ...point, color: this.color_, label: point.label || name }] }
          : presence_palette(name, this.color_);
      }
      case "classes": {
        if (!this.layer && this.classes_.every((row) => !row.label.trim())) {
          this.refuse("classes", words.classes_missing);
          return null;
        }
        return class_palette(
          this.classes_.map((row) => ({ ...row, label: row.label.trim() || words.class_default(row.at) })),
        );
      }
      case "measurement": {
        if (!(max > min)) {
          this.refuse("max", words.range_wrong);
          return null;
        }
        const mode = this.stepped_ ? "step" : "linear";
        const old = this.layer?.palette;
        const same = old && old.min === min && old.max === max && old.mode === mode;
        return same ? old : measurement_palette(min, max, mode);
      }
    }
  }

  private async send(name: string, unit: string, description: string, palette: Palette): Promise<void> {
    const { session, layer } = this;
    if (layer) {
      await session.change_layer(layer, { name, unit: this.purpose_ === "measurement" ? unit : layer.unit, description, palette });
      return;
    }
    const wanted: LayerCreate = {
      name,
      kind: "numeric",
      type: this.purpose_ === "measurement" ? "f32" : "u8",
      unit: this.purpose_ === "measurement" ? unit : "",
      description,
      palette,
      ...(this.chosen_resolution_ ? { resolution: this.chosen_resolution_ as Resolution } : {}),
    };
    session.add_created(await session.api.create_layer(session.model_id, wanted));
    notices.show("success", texts.layers.created(name));
  }
}

const new_class = (at: number): ClassRow => ({
  at,
  label: "",
  color: kClassColors[(at - 1) % kClassColors.length]!,
});
