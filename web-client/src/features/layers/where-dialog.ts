// <strata-where-dialog>: fills or erases a layer where a condition over the layers is true. It is
// next to the 3D view, which highlights the matching area before any change.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { labelOf } from "../../domain/cells";
import { ApiError } from "../../net/api-error";
import { formatArea } from "../../domain/measure";
import type { SelectResponse } from "../../core/protocol.gen";
import type { Layer } from "../../core/types";
import "../../ui/dialog";
import "./expression-field";
import type { StrataExpressionField } from "./expression-field";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { radioGroup } from "../../ui/radio-group";
import { formStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../session/fields/value-picker";

@customElement("strata-where-dialog")
export class StrataWhereDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private _erases = false;
  @state() private _working = false;
  @state() private _measured: SelectResponse | null = null;
  @query("strata-expression-field") private _condition!: StrataExpressionField;

  constructor() {
    super();
    followSession(this, "painting", "layers", "tables");
  }

  static override styles = [sharedStyles, formStyles];

  override render(): TemplateResult {
    const words = texts.areas;
    const { session, layer } = this;
    return html`<strata-dialog docked heading=${words.where_title(labelOf(layer))} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="where" @submit=${(event: Event) => this.onSubmit(event)}>
        <p class="hint">${words.where_lead}</p>
        <strata-expression-field
          .session=${session}
          label=${words.condition}
          lights
          @measured=${(event: CustomEvent<SelectResponse | null>) => (this._measured = event.detail)}
          @submitted=${() => void this.apply()}
        ></strata-expression-field>
        ${radioGroup<boolean>({
          label: words.does,
          class: "segments",
          choices: [
            { value: false, content: words.paints },
            { value: true, content: words.erases },
          ],
          chosen: this._erases,
          choose: (chosen) => (this._erases = chosen),
        })}
        ${
          this._erases
            ? nothing
            : html`<strata-value-picker
              .session=${session}
              .layer=${layer}
              .value=${session.painting.brush.valueFor(layer)}
            ></strata-value-picker>`
        }
      </form>
      <button slot="actions" class="primary" form="where" ?disabled=${this._working} @click=${() => void this.apply()}>
        ${this._erases ? words.apply_erase : words.apply}
        ${this._measured ? html`<span class="numeric" aria-hidden="true">${formatArea(this._measured.area_m2)}</span>` : nothing}
      </button>
    </strata-dialog>`;
  }

  private onSubmit(event: Event): void {
    event.preventDefault();
    void this.apply();
  }

  private async apply(): Promise<void> {
    const where = this._condition.value;
    if (where === "" || this._working) {
      this._condition.focus();
      return;
    }
    const { session, layer } = this;
    const paint = this._erases
      ? { erase: true }
      : { value: session.painting.brush.valueFor(layer) };
    this._working = true;
    try {
      const { texels_changed: texelsChanged, area_m2: areaM2 } = await session.api.json(
        "POST /models/{model}/layers/{layer}/edits",
        {
          path: { model: session.modelId, layer: layer.id },
          body: {
            op: "fill",
            ...paint,
            mode: "where",
            where,
          },
        },
      );
      if (texelsChanged === 0) notices.show("info", texts.areas.nothing_changed);
      else notices.show("success", texts.areas.changed(formatArea(areaM2)));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (error instanceof ApiError) this._condition.refuse(error);
      else notices.error(error);
    } finally {
      this._working = false;
    }
  }
}
