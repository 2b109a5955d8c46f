// <strata-cleanup-dialog>: removes small regions of a layer, fills holes, smooths borders, removes
// narrow parts, closes gaps and paints borders. It is next to the 3D view. A preview counts what would change.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { Cleanup } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { formatArea } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";
import "../../session/fields/value-picker";
import "../../ui/dialog";
import { notices } from "../../ui/notices";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { formStyles, sharedStyles } from "../../ui/styles";
import { classField } from "./class-field";
import { cleanupOf, kOperations, type CleanupInput } from "./cleanup-request";
import { kProblem, RegionJob } from "./region-job";
import { regionStyles } from "./region-styles";

const words = texts.regions;

@customElement("strata-cleanup-dialog")
export class StrataCleanupDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _input: CleanupInput = {
    operation: "sieve",
    area: "1",
    erasesRegions: false,
    radius: "2",
    width: "2",
    from: null,
    of: "",
    inside: false,
    line: null,
  };
  @state() private _erasesLine = false;
  private readonly _work = new RegionJob(this);
  /** The value of the line in the last rendering. Null: erase. */
  private _line: number | null = null;

  constructor() {
    super();
    followSession(this, "painting", "layers", "tables");
  }

  /** The value of the brush is a part of the input for borders. */
  override willUpdate(): void {
    const line = this._erasesLine ? null : this.session.painting.brush.valueFor(this.layer);
    if (line === this._line) return;
    this._line = line;
    if (this._input.operation === "border") this._work.reset();
  }

  static override styles = [sharedStyles, formStyles, regionStyles];

  override render(): TemplateResult {
    const { operation } = this._input;
    return html`<strata-dialog docked heading=${words.title(labelOf(this.layer))} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="cleanup" novalidate @submit=${(event: Event) => this.onSubmit(event)}>
        ${radioGroup({
          label: words.operation,
          class: "operations",
          choices: kOperations.map((each) => ({ value: each, content: words.operations[each] })),
          chosen: operation,
          choose: (chosen) => this.change({ operation: chosen }),
        })}
        <p class="hint">${words.leads[operation]}</p>
        ${this.fields()}
        ${this._work.render(words.regions)}
      </form>
      <button slot="actions" ?disabled=${this._work.isBusy} @click=${() => void this.run(false)}>${words.preview}</button>
      <button slot="actions" class="primary" form="cleanup" ?disabled=${this._work.isBusy} @click=${() => void this.run(true)}>
        ${words.apply}
      </button>
    </strata-dialog>`;
  }

  private fields(): TemplateResult {
    switch (this._input.operation) {
      case "sieve":
        return html`${this.size("area", words.smaller_than, "cm²", "area_cm2")}
          ${this.check(words.erase_regions, this._input.erasesRegions, (erasesRegions) => this.change({ erasesRegions }))}`;
      case "fill-holes":
        return this.size("area", words.smaller_than, "cm²", "area_cm2");
      case "majority":
        return this.size("radius", words.radius, "mm", "radius_mm");
      case "open":
      case "close":
        return html`${this.size("width", words.narrower_than, "mm", "width_mm")}
          ${classField({ layer: this.layer, value: this._input.of, empty: words.only_value, wrong: this._work.field === "of", typed: (of) => this.change({ of }) })}`;
      case "border":
        return this.borderFields();
    }
  }

  private borderFields(): TemplateResult {
    const { session, layer } = this;
    const { from, of, inside } = this._input;
    const others = session.layers.all.filter(
      (each) => each.id !== layer.id && each.resolution === layer.resolution,
    );
    const regions = others.find(({ id }) => id === from) ?? layer;
    return html`${this.size("width", words.width, "mm", "width_mm")}
      <label class="field">
        <span>${words.regions_of}</span>
        <select @change=${(event: Event) => this.change({ from: idOf((event.target as HTMLSelectElement).value), of: "" })}>
          <option value="" ?selected=${from === null}>${labelOf(layer)}</option>
          ${others.map((each) => html`<option value=${each.id} ?selected=${each.id === from}>${labelOf(each)}</option>`)}
        </select>
      </label>
      ${classField({ layer: regions, value: of, wrong: this._work.field === "of", typed: (text) => this.change({ of: text }) })}
      ${of === "" ? nothing : this.check(words.inside, inside, (now) => this.change({ inside: now }))}
      ${radioGroup<boolean>({
        label: texts.areas.does,
        class: "segments",
        choices: [
          { value: false, content: texts.areas.paints },
          { value: true, content: texts.areas.erases },
        ],
        chosen: this._erasesLine,
        choose: (chosen) => (this._erasesLine = chosen),
      })}
      ${
        this._erasesLine
          ? nothing
          : html`<strata-value-picker .session=${session} .layer=${layer} .value=${session.painting.brush.valueFor(layer)}></strata-value-picker>`
      }`;
  }

  private size(
    member: "area" | "radius" | "width",
    label: string,
    unit: string,
    field: string,
  ): TemplateResult {
    return html`<label class="field">
      <span>${label}</span>
      <div class="size">
        ${numberInput({
          name: member,
          value: this._input[member],
          min: 0,
          wrong: this._work.field === field,
          toldAt: kProblem,
          typed: (text) => this.change({ [member]: text }),
        })}
        ${unit}
      </div>
    </label>`;
  }

  private check(label: string, checked: boolean, change: (now: boolean) => void): TemplateResult {
    return html`<label class="check">
      <input type="checkbox" .checked=${checked} @change=${(event: Event) => change((event.target as HTMLInputElement).checked)} />
      ${label}
    </label>`;
  }

  private change(part: Partial<CleanupInput>): void {
    this._input = { ...this._input, ...part };
    this._work.reset();
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
  }

  private async run(apply: boolean): Promise<void> {
    const body = cleanupOf({ ...this._input, line: this._line }, apply);
    if ("problem" in body) return this._work.refuse(body.problem, body.field);
    const report = await this._work.run(() => this.start(body), apply);
    if (report?.skipped_texels) notices.show("info", words.skipped);
    if (!report?.applied) return;
    notices.show("success", texts.areas.changed(formatArea(report.area_m2)));
    this.dispatchEvent(new CustomEvent("closed"));
  }

  private start(body: Cleanup) {
    return this.session.api.json("POST /models/{model}/layers/{layer}/cleanup", {
      path: { model: this.session.modelId, layer: this.layer.id },
      body,
    });
  }
}

const idOf = (value: string): number | null => (value === "" ? null : Number(value));
