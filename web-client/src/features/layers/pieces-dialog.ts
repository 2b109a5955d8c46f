// <strata-pieces-dialog>: creates a record for each connected piece of a class. It is next to the
// 3D view. A preview counts the pieces.

import { html, LitElement, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { PieceRecords } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import "../../ui/dialog";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { formStyles, sharedStyles } from "../../ui/styles";
import { classField } from "./class-field";
import { piecesOf, type PiecesInput } from "./cleanup-request";
import { kProblem, RegionJob } from "./region-job";
import { regionStyles } from "./region-styles";

const words = texts.regions;

/** Returns the layers of records that can get the pieces of a layer. */
export function targetsOf(layers: readonly Layer[], layer: Layer): Layer[] {
  return layers.filter(
    ({ id, table, resolution }) =>
      id !== layer.id && table !== undefined && resolution === layer.resolution,
  );
}

@customElement("strata-pieces-dialog")
export class StrataPiecesDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _input: Omit<PiecesInput, "into"> = {
    of: "",
    minArea: "",
    number: "",
    area: "",
    perimeter: "",
    inReadingOrder: false,
    asLines: false,
    length: "",
    width: "",
    greatestWidth: "",
  };
  @state() private _into: number | null = null;
  private readonly _work = new RegionJob(this);

  constructor() {
    super();
    followSession(this, "layers", "tables");
  }

  static override styles = [sharedStyles, formStyles, regionStyles];

  override render(): TemplateResult {
    const target = this.target();
    return html`<strata-dialog docked heading=${words.pieces_title(labelOf(this.layer))} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="pieces" novalidate @submit=${(event: Event) => event.preventDefault()}>
        <p class="hint">${words.pieces_lead}</p>
        ${target ? this.fields(target) : html`<p>${words.no_targets}</p>`}
        ${this._work.render(words.pieces)}
      </form>
      <button slot="actions" ?disabled=${this._work.isBusy || !target} @click=${() => void this.run(false)}>${words.preview}</button>
      <button slot="actions" class="primary" form="pieces" ?disabled=${this._work.isBusy || !target} @click=${() => void this.run(true)}>
        ${words.make_records}
      </button>
    </strata-dialog>`;
  }

  private target(): Layer | undefined {
    const targets = targetsOf(this.session.layers.all, this.layer);
    return targets.find(({ id }) => id === this._into) ?? targets[0];
  }

  private fields(target: Layer): TemplateResult {
    const { session, layer } = this;
    return html`${classField({ layer, value: this._input.of, wrong: this._work.field === "of", typed: (of) => this.change({ of }) })}
      <label class="field">
        <span>${words.into}</span>
        <select @change=${(event: Event) => this.choose(Number((event.target as HTMLSelectElement).value))}>
          ${targetsOf(session.layers.all, layer).map(
            (each) =>
              html`<option value=${each.id} ?selected=${each.id === target.id}>${labelOf(each)}</option>`,
          )}
        </select>
      </label>
      <label class="field">
        <span>${words.min_area}</span>
        <div class="size">
          ${numberInput({ name: "min_area", value: this._input.minArea, min: 0, wrong: this._work.field === "min_area_cm2", toldAt: kProblem, typed: (minArea) => this.change({ minArea }) })}
          cm²
        </div>
      </label>
      ${this.column("number", words.number_column, target)}
      ${this.column("area", words.area_column, target)}
      ${this.column("perimeter", words.perimeter_column, target)}
      <label class="check">
        <input type="checkbox" name="as_lines" .checked=${this._input.asLines} @change=${(event: Event) => this.change({ asLines: (event.target as HTMLInputElement).checked })} />
        ${words.as_lines}
      </label>
      <p class="hint">${words.as_lines_hint}</p>
      ${this._input.asLines ? this.lineColumns(target) : this.order()}`;
  }

  private order(): TemplateResult {
    return html`<label class="check">
        <input type="checkbox" name="in_reading_order" .checked=${this._input.inReadingOrder} @change=${(event: Event) => this.change({ inReadingOrder: (event.target as HTMLInputElement).checked })} />
        ${words.in_reading_order}
      </label>
      <p class="hint">${words.in_reading_order_hint}</p>`;
  }

  private lineColumns(target: Layer): TemplateResult {
    return html`${this.column("length", words.length_column, target)}
    ${this.column("width", words.width_column, target)}
    ${this.column("greatestWidth", words.greatest_width_column, target)}`;
  }

  private column(
    member: "number" | "area" | "perimeter" | "length" | "width" | "greatestWidth",
    label: string,
    target: Layer,
  ): TemplateResult {
    const columns = this.session.tables.find(target.table!)?.columns ?? [];
    const numbers = columns.filter(({ kind }) => kind === "numeric" || kind === "integer");
    return html`<label class="field">
      <span>${label}</span>
      <select @change=${(event: Event) => this.change({ [member]: (event.target as HTMLSelectElement).value })}>
        <option value="" ?selected=${this._input[member] === ""}>${words.no_column}</option>
        ${numbers.map(
          (each) =>
            html`<option value=${each.slug} ?selected=${each.slug === this._input[member]}>${labelOf(each)}</option>`,
        )}
      </select>
    </label>`;
  }

  private choose(into: number): void {
    this._into = into;
    this.change({
      number: "",
      area: "",
      perimeter: "",
      length: "",
      width: "",
      greatestWidth: "",
    });
  }

  private change(part: Partial<PiecesInput>): void {
    this._input = { ...this._input, ...part };
    this._work.reset();
  }

  private async run(apply: boolean): Promise<void> {
    const target = this.target();
    if (!target) return;
    const body = piecesOf({ ...this._input, into: target.id }, apply);
    if ("problem" in body) return this._work.refuse(body.problem, body.field);
    const report = await this._work.run(() => this.start(body), apply);
    if (report?.skipped_texels) notices.show("info", words.skipped);
    if (!report?.applied) return;
    const unpainted = report.unpainted_keys?.length ?? 0;
    notices.show("success", words.records_made(report.regions));
    if (unpainted > 0) notices.show("info", words.unpainted(unpainted));
    this.dispatchEvent(new CustomEvent("closed"));
  }

  private start(body: PieceRecords) {
    return this.session.api.json("POST /models/{model}/layers/{layer}/piece-records", {
      path: { model: this.session.modelId, layer: this.layer.id },
      body,
    });
  }
}
