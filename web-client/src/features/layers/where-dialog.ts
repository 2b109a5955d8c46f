// <strata-where-dialog>: fills, or erases, a layer where a condition over the layers holds.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { label_of } from "../../domain/cells";
import { ApiError } from "../../net/api";
import { format_area } from "../../domain/measure";
import type { Layer } from "../../core/types";
import "../../ui/dialog";
import "./expression-field";
import type { StrataExpressionField } from "./expression-field";
import { follow_session } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { radio_group } from "../../ui/radio-group";
import { form_styles, shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../session/fields/value-picker";

@customElement("strata-where-dialog")
export class StrataWhereDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) layer!: Layer;
  @state() private erases_ = false;
  @state() private working_ = false;
  @query("strata-expression-field") private condition_!: StrataExpressionField;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    form_styles,
    css`
      dl {
        display: grid;
        grid-template-columns: minmax(0, 2fr) minmax(0, 3fr);
        gap: 4px 16px;
        margin: 0;
        font-size: 0.88rem;
      }
      dt {
        overflow-wrap: anywhere;
        font-family: var(--mono);
      }
      dd {
        margin: 0;
        color: var(--ink-soft);
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.areas;
    const { session, layer } = this;
    return html`<strata-dialog heading=${words.where_title(label_of(layer))} way_out=${texts.cancel} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <form id="where" @submit=${(event: Event) => this.on_submit(event)}>
        <p class="hint">${words.where_lead}</p>
        <strata-expression-field
          .session=${session}
          label=${words.condition}
          placeholder=${words.condition_example}
          @submitted=${() => void this.apply()}
        ></strata-expression-field>
        <dl>${words.grammar.map(([text, does]) => html`<dt>${text}</dt><dd>${does}</dd>`)}</dl>
        ${radio_group<boolean>({
          label: words.does,
          class: "segments",
          choices: [
            { value: false, content: words.paints },
            { value: true, content: words.erases },
          ],
          chosen: this.erases_,
          choose: (chosen) => (this.erases_ = chosen),
        })}
        ${
          this.erases_
            ? nothing
            : html`<strata-value-picker
              .session=${session}
              .layer=${layer}
              .value=${session.painting.brush.value_of(layer)}
            ></strata-value-picker>`
        }
      </form>
      <button slot="actions" class="primary" form="where" ?disabled=${this.working_} @click=${() => void this.apply()}>
        ${this.erases_ ? words.apply_erase : words.apply}
      </button>
    </strata-dialog>`;
  }

  private on_submit(event: Event): void {
    event.preventDefault();
    void this.apply();
  }

  private async apply(): Promise<void> {
    const where = this.condition_.value;
    if (where === "" || this.working_) {
      this.condition_.focus();
      return;
    }
    const { session, layer } = this;
    const paint = this.erases_
      ? { erase: true }
      : { value: session.painting.brush.value_of(layer) };
    this.working_ = true;
    try {
      const { texels_changed, area_m2 } = await session.api.edit(session.model_id, layer.id, {
        op: "fill",
        ...paint,
        mode: "where",
        where,
      });
      if (texels_changed === 0) notices.show("info", texts.areas.nothing_changed);
      else notices.show("success", texts.areas.changed(format_area(area_m2)));
      this.dispatchEvent(new CustomEvent("closed"));
    } catch (error) {
      if (error instanceof ApiError) this.condition_.refuse(error);
      else notices.error(error);
    } finally {
      this.working_ = false;
    }
  }
}
