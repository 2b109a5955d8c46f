// <strata-value-picker>: which value is painted in the selected layer: a class, a term, a number,
// or the only one there is.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { ApiError } from "../../net/api";
import { read_number } from "../../core/locale";
import { css_color, purpose_of } from "../../domain/palette";
import type { Layer } from "../../core/types";
import { describe_value, value_problem } from "../layer-values";
import { follow_session } from "../follow-session";
import type { ModelSession } from "../model-session";
import { number_input } from "../../ui/number-input";
import { radio_group } from "../../ui/radio-group";
import "./record-chooser";
import { styled } from "../../ui/styled";
import { number_field_styles, shared_styles } from "../../ui/styles";
import "./term-chooser";
import { texts } from "../../texts";

@customElement("strata-value-picker")
export class StrataValuePicker extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @property({ attribute: false }) value = 0;
  @state() private wrong_value_ = "";
  @state() private asking_ = false;
  @state() private missing_: number | null = null; // a number that was typed and has no record

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    number_field_styles,
    css`
      :host {
        display: block;
      }
      .classes {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(7.375rem, 1fr));
        gap: 0.375rem;
        max-height: 13rem;
        overflow: auto;
        padding: 2px;
        margin: -2px;
      }
      .classes button {
        justify-content: flex-start;
        min-width: 0;
        padding: 0 0.625rem;
      }
      .classes button[aria-checked="true"] {
        border-color: var(--accent);
        box-shadow: inset 0 0 0 1px var(--accent);
        font-weight: 600;
      }
      .line {
        display: flex;
        align-items: center;
        gap: 0.5625rem;
        min-width: 0;
      }
      .value {
        display: grid;
        gap: 0.375rem;
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (changed.has("layer") && changed.get("layer")?.id !== this.layer.id) {
      this.wrong_value_ = "";
      this.missing_ = null;
    }
  }

  override render(): TemplateResult {
    const { layer, value } = this;
    const purpose = purpose_of(layer);
    const { points } = layer.palette;
    if (purpose === "presence") {
      return html`<div class="line">
        <span class="swatch" ${styled({ background: css_color(points[0]!.color) })}></span>
        <span class="ellipsis">${texts.brush.paints(describe_value(layer, value))}</span>
      </div>`;
    }
    if (purpose === "classes" && points.length > 0) {
      return radio_group({
        label: texts.brush.class,
        class: "classes",
        choices: points.map(({ at, color }) => ({
          value: at,
          content: html`<span class="swatch" ${styled({ background: css_color(color) })}></span>
            <span class="ellipsis">${describe_value(layer, at)}</span>`,
          title: describe_value(layer, at),
        })),
        chosen: value,
        choose: (at) => this.set_value(layer, at),
      });
    }
    if (layer.table !== undefined && this.session.tables.terms(layer.table)) {
      return html`<strata-term-chooser
        .session=${this.session}
        .layer=${layer}
        .chosen=${value}
        @chosen=${(event: CustomEvent<number>) => this.set_record(layer, event.detail)}
      ></strata-term-chooser>`;
    }
    const steps = layer.type.startsWith("f") ? "any" : "1";
    return html`<div class="value">
      <label class="field">
        <span>${purpose === "records" ? texts.brush.record : texts.brush.value}</span>
        <span class="number">
          ${number_input({ value: this.missing_ ?? value, wrong: this.wrong_value_ !== "", changed: (text) => this.on_value(layer, read_number(text)) })}
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
            @chosen=${(event: CustomEvent<number[]>) => this.set_record(layer, event.detail[0] ?? value)}
          ></strata-record-chooser>`
      }
      ${layer.table === undefined ? nothing : this.record_buttons(layer, layer.table)}
      ${
        purpose === "measurement"
          ? html`<input
            type="range"
            min=${layer.palette.min}
            max=${layer.palette.max}
            step=${steps === "any" ? (layer.palette.max - layer.palette.min) / 200 : 1}
            .value=${String(value)}
            aria-label=${texts.brush.value}
            @input=${(event: Event) => this.on_value(layer, (event.target as HTMLInputElement).valueAsNumber)}
          />`
          : nothing
      }
      ${this.wrong_value_ ? html`<p class="error" role="alert">${this.wrong_value_}</p>` : nothing}
    </div>`;
  }

  private record_buttons(layer: Layer, table: number): TemplateResult {
    const missing = this.missing_;
    const add = (key?: number) => () =>
      void this.ask(async () =>
        this.set_record(
          layer,
          (await this.session.api.create_record(table, { ...(key === undefined ? {} : { key }) }))
            .key,
        ),
      );
    return html`${
      missing === null
        ? nothing
        : html`<p class="hint" role="status">${texts.brush.no_record(missing)}</p>
            <button ?disabled=${this.asking_} @click=${add(missing)}>${texts.brush.make_record(missing)}</button>`
    }
      <button title=${texts.brush.new_record_hint} ?disabled=${this.asking_} @click=${add()}>${texts.brush.new_record}</button>`;
  }

  private set_record(layer: Layer, key: number): void {
    this.missing_ = null;
    this.set_value(layer, key);
  }

  /** Only records can be painted: a number that has none is offered to be made. */
  private async find_record(layer: Layer, table: number, key: number): Promise<void> {
    if (await this.session.api.has_record(table, key)) this.set_record(layer, key);
    else this.missing_ = key;
  }

  private async ask(work: () => Promise<void>): Promise<void> {
    this.asking_ = true;
    this.wrong_value_ = "";
    try {
      await work();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.wrong_value_ = error.message;
    } finally {
      this.asking_ = false;
    }
  }

  private set_value(layer: Layer, value: number): void {
    this.session.painting.set_brush((brush) => brush.set_value(layer, value));
  }

  private on_value(layer: Layer, number: number): void {
    const value = layer.type.startsWith("f") ? Number(number.toPrecision(6)) : number;
    this.wrong_value_ = value_problem(layer, value) ?? "";
    if (this.wrong_value_) return;
    const { table } = layer;
    if (table === undefined) this.set_value(layer, value);
    else void this.ask(() => this.find_record(layer, table, value));
  }
}
