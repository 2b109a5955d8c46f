// <strata-value-picker>: chooses the value to paint in the selected layer: a class, a term or a
// number. If only one value is possible, the picker shows it.

import { readRecord } from "../../net/records";
import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { createRecord } from "../../net/records";
import { readNumber } from "../../core/locale";
import { cssColor, purposeOf } from "../../domain/palette";
import type { Layer } from "../../core/types";
import { describeValue, valueProblem } from "../layer-values";
import { followSession } from "../follow-session";
import type { ModelSession } from "../model-session";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import "./record-chooser";
import { styled } from "../../ui/styled";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import "./term-chooser";
import { texts } from "../../texts";

@customElement("strata-value-picker")
export class StrataValuePicker extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @property({ attribute: false }) value = 0;
  @state() private _wrongValue = "";
  @state() private _asking = false;
  @state() private _missing: number | null = null; // a typed key that has no record

  constructor() {
    super();
    followSession(this, "painting", "tables", "layers");
  }

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      :host {
        display: block;
      }
      .classes {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(7.375rem, 1fr));
        gap: var(--space-2);
        max-height: 13rem;
        overflow: auto;
        padding: var(--space-half);
        margin: calc(-1 * var(--space-half));
      }
      .classes button {
        justify-content: flex-start;
        min-width: 0;
        padding: 0 var(--space-2);
      }
      .classes button[aria-checked="true"] {
        border-color: var(--accent);
        box-shadow: inset 0 0 0 1px var(--accent);
        font-weight: 600;
      }
      .line {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
      }
      .value {
        display: grid;
        gap: var(--space-2);
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("layer") && changed.get("layer")?.id !== this.layer.id) {
      this._wrongValue = "";
      this._missing = null;
    }
  }

  override render(): TemplateResult {
    const { layer, value } = this;
    const purpose = purposeOf(layer);
    const { points } = layer.palette;
    if (purpose === "presence") {
      return html`<div class="line">
        <span class="swatch" ${styled({ background: cssColor(points[0]!.color) })}></span>
        <span class="ellipsis">${texts.brush.paints(describeValue(layer, value))}</span>
      </div>`;
    }
    if (purpose === "classes" && points.length > 0) {
      return radioGroup({
        label: texts.brush.class,
        class: "classes",
        choices: points.map(({ at, color }) => ({
          value: at,
          content: html`<span class="swatch" ${styled({ background: cssColor(color) })}></span>
            <span class="ellipsis">${describeValue(layer, at)}</span>`,
          title: describeValue(layer, at),
        })),
        chosen: value,
        choose: (at) => this.setValue(layer, at),
      });
    }
    if (layer.table !== undefined && this.session.tables.terms(layer.table)) {
      return html`<strata-term-chooser
        .session=${this.session}
        .layer=${layer}
        .chosen=${value}
        @chosen=${(event: CustomEvent<number>) => this.setRecord(layer, event.detail)}
      ></strata-term-chooser>`;
    }
    const steps = layer.type.startsWith("f") ? "any" : "1";
    return html`<div class="value">
      <label class="field">
        <span>${purpose === "records" ? texts.brush.record : texts.brush.value}</span>
        <span class="number">
          ${numberInput({ value: this._missing ?? value, wrong: this._wrongValue !== "", changed: (text) => this.onValue(layer, readNumber(text)) })}
          <span>${layer.unit}</span>
        </span>
      </label>
      ${
        layer.table === undefined
          ? nothing
          : html`<strata-record-chooser
            .session=${this.session}
            .table=${layer.table}
            .chosen=${[value]}
            label=${texts.brush.find_record}
            @chosen=${(event: CustomEvent<number[]>) => this.setRecord(layer, event.detail[0] ?? value)}
          ></strata-record-chooser>`
      }
      ${layer.table === undefined ? nothing : this.recordButtons(layer, layer.table)}
      ${
        purpose === "measurement"
          ? html`<input
            type="range"
            min=${layer.palette.min}
            max=${layer.palette.max}
            step=${steps === "any" ? (layer.palette.max - layer.palette.min) / 200 : 1}
            .value=${String(value)}
            aria-label=${texts.brush.value}
            @input=${(event: Event) => this.onValue(layer, (event.target as HTMLInputElement).valueAsNumber)}
          />`
          : nothing
      }
      ${this._wrongValue ? html`<p class="error" role="alert">${this._wrongValue}</p>` : nothing}
    </div>`;
  }

  private recordButtons(layer: Layer, table: number): TemplateResult {
    const missing = this._missing;
    const add = (key?: number) => () =>
      void this.ask(async () =>
        this.setRecord(
          layer,
          (await createRecord(this.session.api, table, { ...(key === undefined ? {} : { key }) }))
            .key,
        ),
      );
    return html`${
      missing === null
        ? nothing
        : html`<p class="hint" role="status">${texts.brush.no_record(missing)}</p>
            <button ?disabled=${this._asking} @click=${add(missing)}>${texts.brush.make_record(missing)}</button>`
    }
      <button title=${texts.brush.new_record_hint} ?disabled=${this._asking} @click=${add()}>${texts.brush.new_record}</button>`;
  }

  private setRecord(layer: Layer, key: number): void {
    this._missing = null;
    this.setValue(layer, key);
  }

  /**
   * Finds the record for a typed key. Only keys of records can be painted, so the picker offers to
   * create a missing record.
   */
  private async findRecord(layer: Layer, table: number, key: number): Promise<void> {
    try {
      await readRecord(this.session.api, { table }, key);
    } catch (error) {
      if (!(error instanceof ApiError) || error.status !== 404) throw error;
      this._missing = key;
      return;
    }
    this.setRecord(layer, key);
  }

  private async ask(work: () => Promise<void>): Promise<void> {
    this._asking = true;
    this._wrongValue = "";
    try {
      await work();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._wrongValue = error.message;
    } finally {
      this._asking = false;
    }
  }

  private setValue(layer: Layer, value: number): void {
    this.session.painting.setBrush((brush) => brush.setValue(layer, value));
  }

  private onValue(layer: Layer, number: number): void {
    const value = layer.type.startsWith("f") ? Number(number.toPrecision(6)) : number;
    this._wrongValue = valueProblem(layer, value) ?? "";
    if (this._wrongValue) return;
    const { table } = layer;
    if (table === undefined) this.setValue(layer, value);
    else void this.ask(() => this.findRecord(layer, table, value));
  }
}
