// <strata-changes-dialog>: what changed on a layer between the surveys of the object. It is next to
// the model, so that the pieces that changed can be seen.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { holdsFractions, type Layer } from "../../core/types";
import { labelOf } from "../../domain/cells";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../ui/dialog";
import { radioGroup } from "../../ui/radio-group";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./class-changes";
import "./survey-statistics";

const words = texts.surveys.changes;

type Shown = "classes" | "statistics";

@customElement("strata-changes-dialog")
export class StrataChangesDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _shown: Shown = "classes";
  @state() private _layer: number | null = null;

  constructor() {
    super();
    followSession(this, "layers", "surveys", "tables");
  }

  static override styles = [
    sharedStyles,
    formStyles,
    css`
      .content {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-3);
        width: min(34rem, 100%);
      }
    `,
  ];

  private get layers(): Layer[] {
    const all = [...this.session.layers.all].reverse();
    return this._shown === "classes" ? all.filter(({ type }) => !holdsFractions(type)) : all;
  }

  override render(): TemplateResult | typeof nothing {
    const { object } = this.session.surveys;
    if (!object) return nothing;
    const { layers } = this;
    const layer = layers.find(({ id }) => id === this._layer) ?? layers[0];
    return html`<strata-dialog docked heading=${words.title(object.name)} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <div class="content">
        ${radioGroup<Shown>({
          label: words.view,
          class: "segments",
          choices: (["classes", "statistics"] as const).map((value) => ({
            value,
            content: words.views[value],
          })),
          chosen: this._shown,
          choose: (shown) => (this._shown = shown),
        })}
        ${layer ? this.content(layer, layers) : html`<p>${words.no_layers}</p>`}
      </div>
    </strata-dialog>`;
  }

  private content(layer: Layer, layers: readonly Layer[]): TemplateResult {
    const { session } = this;
    return html`<label class="field">
        <span>${words.layer}</span>
        <select name="layer" @change=${(event: Event) => (this._layer = Number((event.target as HTMLSelectElement).value))}>
          ${layers.map((each) => html`<option value=${each.id} ?selected=${each.id === layer.id}>${labelOf(each)}</option>`)}
        </select>
      </label>
      ${
        this._shown === "classes"
          ? html`<strata-class-changes .session=${session} .layer=${layer}></strata-class-changes>`
          : html`<strata-survey-statistics .session=${session} .layer=${layer}></strata-survey-statistics>`
      }`;
  }
}
