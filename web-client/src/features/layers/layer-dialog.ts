// <strata-layer-dialog>: creates a layer or, with `layer`, changes its name, classes and colors.
// It uses the terms of users who study the object.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { keyed } from "lit/directives/keyed.js";
import { readNumber } from "../../core/locale";
import { detailChoices, formatLength } from "../../domain/measure";
import {
  classPalette,
  measurementPalette,
  opaqueColor,
  presencePalette,
  purposeOf,
  recordPalette,
  kTypeOfPurpose,
  type LayerPurpose,
} from "../../domain/palette";
import type { Layer, LayerCreate, Palette, Resolution } from "../../core/types";
import { ApiError } from "../../net/api-error";
import { createRecord } from "../../net/records";
import { createLayer, createLayerOrJob, readLayer, recomputeLayer } from "../../net/layers";
import { labelOf } from "../../domain/cells";
import { groupCalled } from "../../domain/layer-groups";
import type { Labels, LayerBlend, Table, Visibility } from "../../core/protocol.gen";
import "../../ui/dialog";
import "./expression-field";
import { classRows, newClass, withNewClass, type ClassRow } from "./class-rows";
import { layerDialogStyles } from "./layer-dialog-styles";
import type { StrataExpressionField } from "./expression-field";
import "./layer-preview";
import type { StrataLayerPreview } from "./layer-preview";
import type { StrataDialog } from "../../ui/dialog";
import "../../ui/labels-field";
import type { StrataLabelsField } from "../../ui/labels-field";
import { groupField } from "./group-row";
import { layerChanges, type LayerWanted } from "./layer-changes";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import "./shape-fields";
import type { StrataShapeFields } from "./shape-fields";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { visibilityChoice } from "../../ui/visibility";

/** The purpose of a new layer: painting or computed values. */
type Purpose = LayerPurpose | "shape" | "formula";

const kNoWords: Labels = {};
const kBlends: readonly LayerBlend[] = ["normal", "multiply", "screen"];
const words = texts.layer_dialog;

@customElement("strata-layer-dialog")
export class StrataLayerDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer: Layer | null = null;

  /** The layer and its version when the dialog opened. */
  @state() private _base: { layer: Layer; etag: string } | null = null;
  @state() private _stale = false; // another user has changed the layer since the dialog opened
  @state() private _purpose: Purpose = "presence";
  @state() private _color = "#d55e00ff";
  @state() private _classes: ClassRow[] = [];
  @state() private _stepped = false;
  @state() private _tables: Table[] = []; // tables whose records a layer can show
  @state() private _table: Table | null = null; // null for a new table for this layer
  @state() private _visibility: Visibility = "public";
  @state() private _problem = "";
  @state() private _problemField = "";
  @state() private _busy = false;
  @query("strata-dialog") private _dialog!: StrataDialog;
  @query("strata-labels-field") private _labels!: StrataLabelsField;
  @query("form") private _form!: HTMLFormElement;
  @query("strata-shape-fields") private _shape!: StrataShapeFields;
  @query("strata-expression-field") private _expression!: StrataExpressionField;
  @query("strata-layer-preview") private _preview!: StrataLayerPreview | null;

  static override styles = [sharedStyles, formStyles, layerDialogStyles];

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.layer) void this.read(this.layer);
    else {
      this._classes = [1, 2, 3].map((at) => newClass(at));
      void this.findTables();
    }
  }

  private async findTables(): Promise<void> {
    try {
      this._tables = await this.session.tables.all();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse("", error.message);
    }
  }

  private async read(layer: Layer): Promise<void> {
    this.refuse("", "");
    try {
      const { value, etag } = await readLayer(this.session.api, this.session.modelId, layer.id);
      const purpose = purposeOf(value);
      // the user can add a second class later
      this._purpose = purpose === "presence" ? "classes" : purpose;
      this._classes = value.palette.points.map(({ at, label, color }) => ({
        at,
        label: label ?? "",
        color,
      }));
      this._stepped = value.palette.mode === "step";
      this._visibility = value.visibility;
      this._base = { layer: value, etag };
      this._stale = false;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.refuse("", error.message);
    }
  }

  override render(): TemplateResult {
    const { layer } = this;
    return html`<strata-dialog
      wide
      heading=${layer ? words.edit_title(labelOf(layer)) : words.create_title}
      way_out=${texts.cancel}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${layer && !this._base ? html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>` : this.form()}
      ${this.isComputed ? html`<strata-layer-preview .session=${this.session} @cancelled=${() => this.renderRoot.querySelector<HTMLElement>("#preview")?.focus()}></strata-layer-preview>` : nothing}
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${
        layer && (this._stale || !this._base)
          ? html`<button slot="actions" class="primary" @click=${() => void this.read(layer)}>
            ${this._stale ? words.reload : texts.try_again}
          </button>`
          : html`${
              this.isComputed
                ? html`<button slot="actions" id="preview" ?disabled=${this._busy} @click=${() => void this.preview()}>${words.preview}</button>`
                : nothing
            }<button slot="actions" class="primary" ?disabled=${this._busy} @click=${() => this._form.requestSubmit()}>
            ${layer ? texts.save : this.isComputed ? words.compute : words.create}
          </button>`
      }
    </strata-dialog>`;
  }

  /** Renders the form again for each version of the layer. */
  private form(): unknown {
    const layer = this._base?.layer;
    return keyed(
      this._base?.etag,
      html`<form id="form" novalidate @submit=${this.onSubmit}>
        ${layer ? nothing : this.kinds()}
        ${
          this._purpose === "shape"
            ? html`<strata-shape-fields
              .session=${this.session}
              .wrong=${this._problemField}
              @input=${this.dropPreview}
              @kind-changed=${() => {
                this.dropPreview();
                this.requestUpdate();
              }}
            ></strata-shape-fields>`
            : nothing
        }
        ${this._purpose === "records" && !layer && this._tables.length > 0 ? this.tables() : nothing}
        ${this._purpose === "formula" || layer?.expression !== undefined ? this.formula(layer) : nothing}
        <div class="two">
          <label class="field">
            <span>${words.name}</span>
            <input
              type="text"
              name="name"
              maxlength="200"
              autocomplete="off"
              .value=${layer?.name ?? ""}
              placeholder=${this._purpose === "shape" ? (this._shape?.kindTitle ?? "") : this._purpose === "formula" ? words.formula_hint : this.namedByTable ? labelOf(this._table!) : words.name_hint[this._purpose]}
              aria-invalid=${this._problemField === "name" ? "true" : "false"}
            />
          </label>
          ${
            this._purpose === "presence"
              ? html`<label class="field">
                <span>${words.color}</span>
                <input
                  type="color"
                  .value=${opaqueColor(this._color)}
                  @input=${(event: Event) => (this._color = `${(event.target as HTMLInputElement).value}ff`)}
                />
              </label>`
              : nothing
          }
        </div>
        ${this._purpose === "classes" ? this.classes() : nothing}
        ${this._purpose === "measurement" ? this.measurement() : nothing} ${layer ? nothing : this.details()}
        <label class="field">
          <span>${words.description}</span>
          <textarea name="description" maxlength="10000" placeholder=${words.description_hint} .value=${layer?.description ?? ""}></textarea>
        </label>
        ${groupField(this.session, layer)}
        <label class="field">
          <span>${words.blend}</span>
          <select name="blend">
            ${kBlends.map((each) => html`<option value=${each} ?selected=${each === (layer?.blend ?? "normal")}>${words.blends[each]}</option>`)}
          </select>
          <small>${words.blend_hint}</small>
        </label>
        <strata-labels-field .labels=${layer?.labels ?? kNoWords} .descriptions=${layer?.descriptions ?? kNoWords}></strata-labels-field>
        ${visibilityChoice(this._visibility, (visibility) => (this._visibility = visibility))}
      </form>`,
    );
  }

  /** Whether the dialog makes a layer whose values are computed. */
  private get isComputed(): boolean {
    return !this.layer && (this._purpose === "shape" || this._purpose === "formula");
  }

  /** Removes the preview, which no longer shows the chosen layer. */
  private dropPreview(): void {
    this._preview?.clear();
  }

  private async preview(): Promise<void> {
    this._problem = this._problemField = "";
    const chosen = this._purpose === "shape" ? this._shape.recipe() : null;
    if (chosen && "problem" in chosen) return this.refuse(chosen.field, chosen.problem);
    const expression = chosen ? "" : this._expression.value;
    if (!chosen && expression === "") return this.refuse("expression", words.expression_missing);
    try {
      await this._preview?.show({
        name: words.preview,
        visibility: this._visibility,
        ...(chosen ? { compute: chosen } : { expression }),
        ...this.resolution(),
      });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.showProblem(error, (error.problem.field ?? "").replace(/^layer\.?/, ""));
    }
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
      ${radioGroup<Purpose>({
        label: { id: "question" },
        class: "kinds",
        choices: kinds.map(([value, title, lead]) => ({
          value,
          content: html`<b>${title}</b><span>${lead}</span>`,
        })),
        chosen: this._purpose,
        choose: (purpose) => {
          this.dropPreview();
          this._purpose = purpose;
        },
      })}
      <p class="hint chosen-lead" aria-hidden="true">${kinds.find(([value]) => value === this._purpose)?.[2]}</p>
    </div>`;
  }

  private tables(): TemplateResult {
    return html`<label class="field">
      <span>${words.table}</span>
      <select name="table" @change=${(event: Event) => this.chooseTable(Number((event.target as HTMLSelectElement).value))}>
        <option value="0" ?selected=${this._table === null}>${words.own_table}</option>
        ${this._tables.map(
          (table) =>
            html`<option value=${table.id} ?selected=${table.id === this._table?.id}>
              ${table.kind === "terms" ? words.table_of_terms(labelOf(table), table.records) : words.table_of_records(labelOf(table), table.records)}
            </option>`,
        )}
      </select>
    </label>`;
  }

  private chooseTable(id: number): void {
    this._table = this._tables.find((table) => table.id === id) ?? null;
  }

  /** Whether the layer can take the name of the table that it shows. */
  private get namedByTable(): boolean {
    return this._purpose === "records" && this._table !== null;
  }

  private formula(layer: Layer | undefined): TemplateResult {
    return html`<strata-expression-field
        computes
        .session=${this.session}
        label=${words.expression}
        .initial=${layer?.expression ?? ""}
        @input=${this.dropPreview}
        @submitted=${() => this._form.requestSubmit()}
      ></strata-expression-field>
      <label class="check">
        <input type="checkbox" name="follows" .checked=${layer?.recompute === "automatic"} />
        ${words.follows}
      </label>`;
  }

  private classes(): TemplateResult {
    return classRows({
      rows: this._classes,
      isNew: !this.layer,
      change: (rows) => (this._classes = rows),
      add: () => {
        const more = withNewClass(this._classes);
        if (more) this._classes = more;
        else this._problem = words.too_many;
      },
    });
  }

  private measurement(): TemplateResult {
    const palette = this._base?.layer.palette;
    return html`<div class="range">
        <label class="field">
          <span>${words.range}</span>
          ${numberInput({ name: "min", value: palette?.min ?? 0, wrong: this._problemField === "min" })}
        </label>
        <span>${words.range_to}</span>
        <label class="field">
          <span class="visually-hidden">${words.range_to}</span>
          ${numberInput({ name: "max", value: palette?.max ?? 100, wrong: this._problemField === "max" })}
        </label>
        <label class="field">
          <span>${words.unit}</span>
          <input type="text" name="unit" maxlength="50" autocomplete="off" .value=${this._base?.layer.unit ?? ""} placeholder=${words.unit_hint} />
        </label>
      </div>
      <label class="check">
        <input
          type="checkbox"
          .checked=${this._stepped}
          @change=${(event: Event) => (this._stepped = (event.target as HTMLInputElement).checked)}
        />
        ${words.stepped}
      </label>`;
  }

  private details(): TemplateResult {
    const { model } = this.session;
    if (!model) return html``;
    const choices = detailChoices(model.atlas);
    const preferred =
      choices.find((choice) => choice.resolution === model.default_resolution) ?? choices[0];
    const chosen = this._chosenResolution ?? preferred?.resolution;
    return html`<div class="details">
      <p class="caption" id="detail">${words.detail}</p>
      ${radioGroup({
        label: { id: "detail" },
        class: "segments",
        choices: choices.map(({ resolution, detailM }) => ({
          value: resolution,
          content: formatLength(detailM),
        })),
        chosen: chosen ?? null,
        choose: (resolution) => {
          this.dropPreview();
          this._chosenResolution = resolution;
        },
      })}
      <p class="hint">${words.detail_hint}</p>
    </div>`;
  }
  @state() private _chosenResolution: number | null = null;

  private async onSubmit(event: Event): Promise<void> {
    event.preventDefault();
    const form = new FormData(this._form);
    const text = (name: string): string => String(form.get(name) ?? "").trim();
    this._problem = this._problemField = "";
    const said = this.said(
      groupCalled(text("group"), this.session.layers.all),
      text("blend") as LayerBlend,
    );
    if (!said) return;
    if (this._purpose === "shape")
      return this.compute(text("name") || this._shape.kindTitle, {
        description: text("description"),
        ...said,
      });
    const name = text("name") || (this.namedByTable ? labelOf(this._table!) : "");
    if (!name) return this.refuse("name", words.name_missing);
    const formula = this._expression ? this.wantedFormula(form) : {};
    if (!formula) return this.refuse("expression", words.expression_missing);
    if (!this.layer && formula.expression !== undefined)
      return this.createComputed({
        name,
        description: text("description"),
        ...said,
        visibility: this._visibility,
        ...formula,
      });
    const palette = this.palette(name, readNumber(text("min")), readNumber(text("max")));
    if (!palette) return;
    await this.attempt(async () => {
      const unit = this._purpose === "measurement" ? text("unit") : (this._base?.layer.unit ?? "");
      await this.send({
        name,
        unit,
        description: text("description"),
        ...said,
        palette,
        visibility: this._visibility,
        ...formula,
      });
    });
  }

  /** Returns null if the formula is missing. */
  private wantedFormula(form: FormData): Pick<LayerCreate, "expression" | "recompute"> | null {
    const expression = this._expression.value;
    return expression === ""
      ? null
      : { expression, recompute: form.has("follows") ? "automatic" : "manual" };
  }

  private async createComputed(layer: LayerCreate): Promise<void> {
    const { session } = this;
    await this.attempt(async () => {
      const made = await createLayerOrJob(session.api, session.modelId, {
        ...layer,
        ...this.resolution(),
      });
      if ("layer" in made) {
        session.layers.put(made.layer);
        session.showMade([made.layer.id]);
        notices.show("success", texts.expressions.computed(layer.name));
      } else {
        session.jobs.watch(layer.name, made.job, (job) => session.showMade(job.layers ?? []));
        notices.show("success", texts.shape.started(layer.name));
      }
    });
  }

  /**
   * Returns the names in other languages, the group and the blending mode. Returns null if a field
   * shows a problem.
   */
  private said(
    group: string,
    blend: LayerBlend,
  ): Pick<LayerWanted, "labels" | "descriptions" | "group" | "blend"> | null {
    const labels = this._labels.read();
    return labels && { labels, descriptions: this._labels.writtenDescriptions, group, blend };
  }

  private async compute(
    name: string,
    said: Pick<LayerCreate, "description" | "labels" | "descriptions" | "group" | "blend">,
  ): Promise<void> {
    const compute = this._shape.recipe();
    if ("problem" in compute) return this.refuse(compute.field, compute.problem);
    const { session } = this;
    await this.attempt(async () => {
      const { done } = await session.jobs.compute({
        name,
        ...said,
        compute,
        visibility: this._visibility,
        ...this.resolution(),
      });
      void done.then((made) => session.showMade(made));
      notices.show("success", texts.shape.started(name));
    });
  }

  /** Closes the dialog after `work`, or shows the problem. */
  private async attempt(work: () => Promise<void>): Promise<void> {
    this._busy = true;
    try {
      await work();
      this._dialog.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._stale = error.status === 412;
      this.showProblem(error, error.problem.field ?? "");
    } finally {
      this._busy = false;
    }
  }

  private showProblem(error: ApiError, field: string): void {
    if (field === "expression" && this._expression) this._expression.refuse(error);
    else if (/^(labels|descriptions)\b/.test(field)) this._labels.refuse(error.message);
    else this.refuse(field, this._stale ? words.changed : error.message);
  }

  private refuse(field: string, problem: string): void {
    this._problem = problem;
    this._problemField = field;
  }

  private resolution(): Pick<LayerCreate, "resolution"> {
    return this._chosenResolution ? { resolution: this._chosenResolution as Resolution } : {};
  }

  private palette(name: string, min: number, max: number): Palette | null {
    // the expression or the shape determines the type
    if (this._purpose === "formula" || this._purpose === "shape") return null;
    switch (this._purpose) {
      case "presence":
        return presencePalette(name, this._color);
      case "records":
        return this._base?.layer.palette ?? recordPalette();
      case "classes": {
        if (!this.layer && this._classes.every((row) => !row.label.trim())) {
          this.refuse("classes", words.classes_missing);
          return null;
        }
        const palette = classPalette(
          this._classes.map((row) => ({ ...row, label: row.label.trim() })),
        );
        const old = this._base?.layer.palette;
        return old ? { ...old, points: palette.points } : palette;
      }
      case "measurement": {
        const wrong = Number.isNaN(min) ? "min" : Number.isNaN(max) || max <= min ? "max" : null;
        if (wrong) {
          this.refuse(wrong, Number.isNaN(min + max) ? texts.brush.bad_value : words.range_wrong);
          return null;
        }
        const mode = this._stepped ? "step" : "linear";
        const old = this._base?.layer.palette;
        const same = old && old.min === min && old.max === max && old.mode === mode;
        return same ? old : measurementPalette(min, max, mode);
      }
    }
  }

  private async send(wanted: LayerWanted): Promise<void> {
    const { session, _base: base } = this;
    const purpose = this._purpose as LayerPurpose; // other code sends computed layers
    if (base) {
      const change = layerChanges(base.layer, wanted);
      if (Object.keys(change).length > 0)
        await session.layers.change(base.layer, change, base.etag);
      if (change.expression !== undefined)
        session.layers.put(await recomputeLayer(session.api, session.modelId, base.layer.id));
      return;
    }
    const created: LayerCreate = {
      ...wanted,
      kind: purpose === "records" ? "database" : "numeric",
      type: kTypeOfPurpose[purpose],
      ...(this.namedByTable ? { table: this._table!.id } : {}),
      ...this.resolution(),
    };
    const layer = await createLayer(session.api, session.modelId, created);
    // A key without a record cannot be painted. The first record lets users paint immediately.
    if (layer.table !== undefined && !this.namedByTable)
      await createRecord(session.api, layer.table);
    session.addCreated(layer);
    notices.show("success", texts.layers.created(wanted.name));
  }
}
