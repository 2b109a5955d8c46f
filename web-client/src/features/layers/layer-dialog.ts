// <strata-layer-dialog>: makes a layer, or changes one's name, classes and colours, in the words of
// who studies the object. With `layer` it edits; without, it creates.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { keyed } from "lit/directives/keyed.js";
import { read_number } from "../../core/locale";
import { detail_choices, format_length } from "../../domain/measure";
import {
  class_palette,
  kClassColors,
  measurement_palette,
  opaque_color,
  presence_palette,
  purpose_of,
  record_palette,
  type LayerPurpose,
} from "../../domain/palette";
import type { Layer, LayerCreate, Palette, Resolution, ValueType } from "../../core/types";
import { ApiError } from "../../net/api";
import { label_of } from "../../domain/cells";
import type { Labels, Table, Visibility } from "../../core/protocol.gen";
import "../../ui/dialog";
import "./expression-field";
import type { StrataExpressionField } from "./expression-field";
import type { StrataDialog } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import "../../ui/labels-field";
import type { StrataLabelsField } from "../../ui/labels-field";
import { layer_changes, type LayerWanted } from "./layer-changes";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { number_input } from "../../ui/number-input";
import { radio_group } from "../../ui/radio-group";
import "./shape-fields";
import type { StrataShapeFields } from "./shape-fields";
import { form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import { visibility_choice } from "../../ui/visibility";

interface ClassRow {
  at: number;
  label: string;
  color: string; // #rrggbbaa
}

/** What a new layer is for: something to paint, or values that are computed. */
type Purpose = LayerPurpose | "shape" | "formula";

const kNoWords: Labels = {};
const kMostClasses = 255;
const kTypes: Record<LayerPurpose, ValueType> = {
  presence: "u8",
  classes: "u8",
  measurement: "f32",
  records: "u32",
};
const words = texts.layer_dialog;

@customElement("strata-layer-dialog")
export class StrataLayerDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer: Layer | null = null;

  /** The layer as it was when the person began to change it, and its version. */
  @state() private base_: { layer: Layer; etag: string } | null = null;
  @state() private stale_ = false; // somebody else changed it since
  @state() private purpose_: Purpose = "presence";
  @state() private color_ = "#d55e00ff";
  @state() private classes_: ClassRow[] = [];
  @state() private stepped_ = false;
  @state() private tables_: Table[] = []; // whose records a layer may show
  @state() private table_: Table | null = null; // null: one of the layer's own
  @state() private visibility_: Visibility = "public";
  @state() private problem_ = "";
  @state() private problem_field_ = "";
  @state() private busy_ = false;
  @query("strata-dialog") private dialog_!: StrataDialog;
  @query("strata-labels-field") private labels_!: StrataLabelsField;
  @query("form") private form_!: HTMLFormElement;
  @query("strata-shape-fields") private shape_!: StrataShapeFields;
  @query("strata-expression-field") private expression_!: StrataExpressionField;

  static override styles = [
    shared_styles,
    form_styles,
    css`
      .kinds {
        display: grid;
        grid-template-columns: repeat(2, 1fr);
        gap: 0.625rem;
        margin-top: 0.375rem;
      }
      .kinds button {
        display: grid;
        place-content: start stretch;
        justify-items: start;
        gap: 3px;
        height: auto;
        padding: 0.75rem 0.8125rem;
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
      .kinds button:last-child:nth-child(odd) {
        grid-column: 1 / -1;
      }
      .kinds button[aria-checked="true"] {
        border-color: var(--accent);
        box-shadow: inset 0 0 0 1px var(--accent);
        background: var(--accent-soft);
      }
      .two {
        display: flex;
        gap: 0.75rem;
        align-items: end;
      }
      .two > label:first-child {
        flex: 1;
      }
      .classes {
        display: grid;
        gap: 0.4375rem;
        max-height: 16.875rem;
        overflow: auto;
        padding: 3px;
        margin: -3px;
      }
      .class {
        display: flex;
        gap: 0.5rem;
        align-items: center;
      }
      .range {
        display: grid;
        grid-template-columns: 1fr auto 1fr 6rem;
        align-items: end;
        gap: 0.625rem;
      }
      .range > span {
        padding-bottom: 0.5625rem;
        color: var(--ink-soft);
      }
      .details {
        display: grid;
        gap: 5px;
      }
      .details .segments {
        display: flex;
      }
      .details .segments button {
        min-height: 2.375rem;
      }
      .chosen-lead {
        display: none;
      }
      /* the fields below are to be seen as well */
      @media (max-width: 560px) {
        .kinds {
          gap: 0.5rem;
        }
        .kinds button {
          position: relative;
          align-content: center;
          padding: 0.5rem 0.6875rem;
        }
        .kinds button b {
          font-size: 0.95rem;
          line-height: 1.2;
        }
        .kinds button span {
          position: absolute;
          width: 1px;
          height: 1px;
          overflow: hidden;
          clip-path: inset(50%);
        }
        .chosen-lead {
          display: block;
          margin-top: 0.5rem;
        }
        .range {
          grid-template-columns: 1fr auto 1fr;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.layer) void this.read(this.layer);
    else {
      this.classes_ = [1, 2, 3].map((at) => new_class(at));
      void this.find_tables();
    }
  }

  private async find_tables(): Promise<void> {
    try {
      this.tables_ = await this.session.tables.all();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse("", error.message);
    }
  }

  private async read(layer: Layer): Promise<void> {
    this.refuse("", "");
    try {
      const { value, etag } = await this.session.api.layer(this.session.model_id, layer.id);
      const purpose = purpose_of(value);
      // it can have a second class one day
      this.purpose_ = purpose === "presence" ? "classes" : purpose;
      this.classes_ = value.palette.points.map(({ at, label, color }) => ({
        at,
        label: label ?? "",
        color,
      }));
      this.stepped_ = value.palette.mode === "step";
      this.visibility_ = value.visibility;
      this.base_ = { layer: value, etag };
      this.stale_ = false;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse("", error.message);
    }
  }

  override render(): TemplateResult {
    const { layer } = this;
    return html`<strata-dialog
      wide
      heading=${layer ? words.edit_title(label_of(layer)) : words.create_title}
      way_out=${texts.cancel}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${layer && !this.base_ ? html`<p class="hint" role="status" ?hidden=${this.problem_ !== ""}>${texts.loading}</p>` : this.form()}
      <p class="error" role="alert" ?hidden=${!this.problem_}>${this.problem_}</p>
      ${
        layer && (this.stale_ || !this.base_)
          ? html`<button slot="actions" class="primary" @click=${() => void this.read(layer)}>
            ${this.stale_ ? words.reload : texts.try_again}
          </button>`
          : html`<button slot="actions" class="primary" ?disabled=${this.busy_} @click=${() => this.form_.requestSubmit()}>
            ${layer ? texts.save : this.purpose_ === "shape" || this.purpose_ === "formula" ? words.compute : words.create}
          </button>`
      }
    </strata-dialog>`;
  }

  /** Made anew for every version of the layer that is read. */
  private form(): unknown {
    const layer = this.base_?.layer;
    return keyed(
      this.base_?.etag,
      html`<form id="form" novalidate @submit=${this.on_submit}>
        ${layer ? nothing : this.kinds()}
        ${
          this.purpose_ === "shape"
            ? html`<strata-shape-fields
              .session=${this.session}
              .wrong=${this.problem_field_}
              @kind-changed=${() => this.requestUpdate()}
            ></strata-shape-fields>`
            : nothing
        }
        ${this.purpose_ === "records" && !layer && this.tables_.length > 0 ? this.tables() : nothing}
        ${this.purpose_ === "formula" || layer?.expression !== undefined ? this.formula(layer) : nothing}
        <div class="two">
          <label class="field">
            <span>${words.name}</span>
            <input
              type="text"
              name="name"
              maxlength="200"
              autocomplete="off"
              .value=${layer?.name ?? ""}
              placeholder=${this.purpose_ === "shape" ? (this.shape_?.kind_title ?? "") : this.purpose_ === "formula" ? words.formula_hint : this.named_by_table ? label_of(this.table_!) : words.name_hint[this.purpose_]}
              aria-invalid=${this.problem_field_ === "name" ? "true" : "false"}
            />
          </label>
          ${
            this.purpose_ === "presence"
              ? html`<label class="field">
                <span>${words.color}</span>
                <input
                  type="color"
                  .value=${opaque_color(this.color_)}
                  @input=${(event: Event) => (this.color_ = `${(event.target as HTMLInputElement).value}ff`)}
                />
              </label>`
              : nothing
          }
        </div>
        ${this.purpose_ === "classes" ? this.classes() : nothing}
        ${this.purpose_ === "measurement" ? this.measurement() : nothing} ${layer ? nothing : this.details()}
        <label class="field">
          <span>${words.description}</span>
          <textarea name="description" maxlength="10000" placeholder=${words.description_hint} .value=${layer?.description ?? ""}></textarea>
        </label>
        <strata-labels-field .labels=${layer?.labels ?? kNoWords} .descriptions=${layer?.descriptions ?? kNoWords}></strata-labels-field>
        ${visibility_choice(this.visibility_, (visibility) => (this.visibility_ = visibility))}
      </form>`,
    );
  }

  private kinds(): TemplateResult {
    const kinds: [Purpose, string, string][] = [
      ["presence", words.presence, words.presence_lead],
      ["classes", words.classes, words.classes_lead],
      ["measurement", words.measurement, words.measurement_lead],
      ["records", words.records, words.records_lead],
      ["shape", words.shape, words.shape_lead],
      ["formula", words.formula, words.formula_lead],
    ];
    return html`<div>
      <p class="caption" id="question">${words.question}</p>
      ${radio_group<Purpose>({
        label: { id: "question" },
        class: "kinds",
        choices: kinds.map(([value, title, lead]) => ({
          value,
          content: html`<b>${title}</b><span>${lead}</span>`,
        })),
        chosen: this.purpose_,
        choose: (purpose) => (this.purpose_ = purpose),
      })}
      <p class="hint chosen-lead" aria-hidden="true">${kinds.find(([value]) => value === this.purpose_)?.[2]}</p>
    </div>`;
  }

  private tables(): TemplateResult {
    return html`<label class="field">
      <span>${words.table}</span>
      <select name="table" @change=${(event: Event) => this.choose_table(Number((event.target as HTMLSelectElement).value))}>
        <option value="0" ?selected=${this.table_ === null}>${words.own_table}</option>
        ${this.tables_.map(
          (table) =>
            html`<option value=${table.id} ?selected=${table.id === this.table_?.id}>
              ${table.kind === "terms" ? words.table_of_terms(label_of(table), table.records) : words.table_of_records(label_of(table), table.records)}
            </option>`,
        )}
      </select>
    </label>`;
  }

  private choose_table(id: number): void {
    this.table_ = this.tables_.find((table) => table.id === id) ?? null;
  }

  /** A layer that shows a table need not have another name. */
  private get named_by_table(): boolean {
    return this.purpose_ === "records" && this.table_ !== null;
  }

  private formula(layer: Layer | undefined): TemplateResult {
    return html`<strata-expression-field
        computes
        .session=${this.session}
        label=${words.expression}
        placeholder=${words.formula_example}
        .initial=${layer?.expression ?? ""}
        @submitted=${() => this.form_.requestSubmit()}
      ></strata-expression-field>
      <label class="check">
        <input type="checkbox" name="follows" .checked=${layer?.recompute === "automatic"} />
        ${words.follows}
      </label>`;
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
    const palette = this.base_?.layer.palette;
    return html`<div class="range">
        <label class="field">
          <span>${words.range}</span>
          ${number_input({ name: "min", value: palette?.min ?? 0, wrong: this.problem_field_ === "min" })}
        </label>
        <span>${words.range_to}</span>
        <label class="field">
          <span class="visually-hidden">${words.range_to}</span>
          ${number_input({ name: "max", value: palette?.max ?? 100, wrong: this.problem_field_ === "max" })}
        </label>
        <label class="field">
          <span>${words.unit}</span>
          <input type="text" name="unit" maxlength="50" autocomplete="off" .value=${this.base_?.layer.unit ?? ""} placeholder=${words.unit_hint} />
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
    const preferred =
      choices.find((choice) => choice.resolution === model.default_resolution) ?? choices[0];
    const chosen = this.chosen_resolution_ ?? preferred?.resolution;
    return html`<div class="details">
      <p class="caption" id="detail">${words.detail}</p>
      ${radio_group({
        label: { id: "detail" },
        class: "segments",
        choices: choices.map(({ resolution, detail_m }) => ({
          value: resolution,
          content: format_length(detail_m),
        })),
        chosen: chosen ?? null,
        choose: (resolution) => (this.chosen_resolution_ = resolution),
      })}
      <p class="hint">${words.detail_hint}</p>
    </div>`;
  }
  @state() private chosen_resolution_: number | null = null;

  private change_class(index: number, change: Partial<ClassRow>): void {
    this.classes_ = this.classes_.map((row, other) =>
      other === index ? { ...row, ...change } : row,
    );
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
    const said = this.said();
    if (!said) return;
    if (this.purpose_ === "shape")
      return this.compute(text("name") || this.shape_.kind_title, {
        description: text("description"),
        ...said,
      });
    const name = text("name") || (this.named_by_table ? label_of(this.table_!) : "");
    if (!name) return this.refuse("name", words.name_missing);
    const formula = this.expression_ ? this.wanted_formula(form) : {};
    if (!formula) return this.refuse("expression", words.expression_missing);
    if (!this.layer && formula.expression !== undefined)
      return this.create_computed({
        name,
        description: text("description"),
        ...said,
        visibility: this.visibility_,
        ...formula,
      });
    const palette = this.palette(name, read_number(text("min")), read_number(text("max")));
    if (!palette) return;
    await this.attempt(async () => {
      const unit = this.purpose_ === "measurement" ? text("unit") : (this.base_?.layer.unit ?? "");
      await this.send({
        name,
        unit,
        description: text("description"),
        ...said,
        palette,
        visibility: this.visibility_,
        ...formula,
      });
    });
  }

  /** Null where it is missing. */
  private wanted_formula(form: FormData): Pick<LayerCreate, "expression" | "recompute"> | null {
    const expression = this.expression_.value;
    return expression === ""
      ? null
      : { expression, recompute: form.has("follows") ? "automatic" : "manual" };
  }

  private async create_computed(layer: LayerCreate): Promise<void> {
    const { session } = this;
    await this.attempt(async () => {
      const made = await session.api.create_computed(session.model_id, {
        ...layer,
        ...this.resolution(),
      });
      if ("layer" in made) {
        session.layers.put(made.layer);
        session.show_made([made.layer.id]);
        notices.show("success", texts.expressions.computed(layer.name));
      } else {
        session.jobs.watch(layer.name, made.job, (job) => session.show_made(job.layers ?? []));
        notices.show("success", texts.shape.started(layer.name));
      }
    });
  }

  /** In other languages; null: something is wrong with it, and said there. */
  private said(): { labels: Labels; descriptions: Labels } | null {
    const labels = this.labels_.read();
    return labels && { labels, descriptions: this.labels_.written_descriptions };
  }

  private async compute(
    name: string,
    said: Pick<LayerCreate, "description" | "labels" | "descriptions">,
  ): Promise<void> {
    const compute = this.shape_.recipe();
    if ("problem" in compute) return this.refuse(compute.field, compute.problem);
    const { session } = this;
    await this.attempt(async () => {
      const { done } = await session.jobs.compute({
        name,
        ...said,
        compute,
        visibility: this.visibility_,
        ...this.resolution(),
      });
      void done.then((made) => session.show_made(made));
      notices.show("success", texts.shape.started(name));
    });
  }

  /** Closes the dialog when `work` is done, and says what is wrong otherwise. */
  private async attempt(work: () => Promise<void>): Promise<void> {
    this.busy_ = true;
    try {
      await work();
      this.dialog_.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.stale_ = error.status === 412;
      if (error.problem.field === "expression" && this.expression_) this.expression_.refuse(error);
      else if (/^(labels|descriptions)\b/.test(error.problem.field ?? ""))
        this.labels_.refuse(error.message);
      else this.refuse(error.problem.field ?? "", this.stale_ ? words.changed : error.message);
    } finally {
      this.busy_ = false;
    }
  }

  private refuse(field: string, problem: string): void {
    this.problem_ = problem;
    this.problem_field_ = field;
  }

  private resolution(): Pick<LayerCreate, "resolution"> {
    return this.chosen_resolution_ ? { resolution: this.chosen_resolution_ as Resolution } : {};
  }

  private palette(name: string, min: number, max: number): Palette | null {
    // follows from the values
    if (this.purpose_ === "formula" || this.purpose_ === "shape") return null;
    switch (this.purpose_) {
      case "presence":
        return presence_palette(name, this.color_);
      case "records":
        return this.base_?.layer.palette ?? record_palette();
      case "classes": {
        if (!this.layer && this.classes_.every((row) => !row.label.trim())) {
          this.refuse("classes", words.classes_missing);
          return null;
        }
        const palette = class_palette(
          this.classes_.map((row) => ({ ...row, label: row.label.trim() })),
        );
        const old = this.base_?.layer.palette;
        return old ? { ...old, points: palette.points } : palette;
      }
      case "measurement": {
        const wrong = Number.isNaN(min) ? "min" : Number.isNaN(max) || max <= min ? "max" : null;
        if (wrong) {
          this.refuse(wrong, Number.isNaN(min + max) ? texts.brush.bad_value : words.range_wrong);
          return null;
        }
        const mode = this.stepped_ ? "step" : "linear";
        const old = this.base_?.layer.palette;
        const same = old && old.min === min && old.max === max && old.mode === mode;
        return same ? old : measurement_palette(min, max, mode);
      }
    }
  }

  private async send(wanted: LayerWanted): Promise<void> {
    const { session, base_: base } = this;
    const purpose = this.purpose_ as LayerPurpose; // what is computed goes another way
    if (base) {
      const change = layer_changes(base.layer, wanted);
      if (Object.keys(change).length > 0)
        await session.layers.change(base.layer, change, base.etag);
      if (change.expression !== undefined)
        session.layers.put(await session.api.recompute_layer(session.model_id, base.layer.id));
      return;
    }
    const created: LayerCreate = {
      ...wanted,
      kind: purpose === "records" ? "database" : "numeric",
      type: kTypes[purpose],
      ...(this.named_by_table ? { table: this.table_!.id } : {}),
      ...this.resolution(),
    };
    const layer = await session.api.create_layer(session.model_id, created);
    // So that painting can begin at once: a number without a record is not painted.
    if (layer.table !== undefined && !this.named_by_table)
      await session.api.create_record(layer.table);
    session.add_created(layer);
    notices.show("success", texts.layers.created(wanted.name));
  }
}

const new_class = (at: number): ClassRow => ({
  at,
  label: "",
  color: kClassColors[(at - 1) % kClassColors.length]!,
});
