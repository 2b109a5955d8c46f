// <strata-wand-panel>: the options of the wand: whether it selects by clicks or with a brush, what it
// compares, how far it reaches, and the value that it paints.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { readNumber } from "../../core/locale";
import { labelOf } from "../../domain/cells";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import "../../session/fields/value-picker";
import { numberInput } from "../../ui/number-input";
import { radioGroup } from "../../ui/radio-group";
import { numberFieldStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { WandBy } from "./wand";
import "./brush-width";
import "./selection-panel";
import { selectionOf } from "./selection-of";

const kWays: readonly WandBy[] = ["color", "normal", "value"];

@customElement("strata-wand-panel")
export class StrataWandPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "layers", "tables", "appearance");
  }

  static override styles = [
    sharedStyles,
    numberFieldStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-3);
      }
      h2 {
        font-size: var(--text-large);
      }
      .reach {
        display: grid;
        grid-template-columns: 1fr 5.75rem;
        align-items: center;
        gap: var(--space-3);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const layer = session.layers.selected;
    if (!layer) return html`<p class="hint">${texts.brush.no_layer}</p>`;
    const selection = selectionOf(session);
    const { wand } = selection;
    const words = texts.wand;
    const { painting } = session;
    const { erases } = painting.brush.areas;
    return html`<h2>${texts.tools.wand}</h2>
      ${radioGroup<boolean>({
        label: words.select_with,
        class: "segments",
        choices: [
          { value: false, content: words.clicks },
          { value: true, content: words.brush },
        ],
        chosen: wand.brushes,
        choose: (brushes) => selection.useBrush(brushes),
      })}
      <p class="hint">${wand.brushes ? words.how_brush : words.how}</p>
      ${wand.brushes ? html`<strata-brush-width .session=${session}></strata-brush-width>` : nothing}
      <strata-selection-panel .session=${session}></strata-selection-panel>
      ${radioGroup<WandBy>({
        label: words.by,
        class: "segments",
        choices: kWays.map((by) => ({
          value: by,
          content: words.ways[by],
          title: words.way_hints[by],
        })),
        chosen: wand.by,
        choose: (by) => wand.set({ by }),
      })}
      ${wand.by === "color" ? this.image() : wand.by === "value" ? this.layer() : nothing}
      <label class="check">
        <input
          type="checkbox"
          .checked=${wand.contiguous}
          @change=${(event: Event) => wand.set({ contiguous: (event.target as HTMLInputElement).checked })}
        />
        <span>${words.contiguous}</span>
      </label>
      ${
        wand.brushes
          ? nothing
          : html`<label class="reach">
              <span>${words.reach}</span>
              ${numberInput({
                value: wand.reachMm ?? "",
                placeholder: words.no_limit,
                min: 0,
                changed: (text) => this.setReach(text),
              })}
            </label>`
      }
      ${radioGroup<boolean>({
        label: texts.areas.does,
        class: "segments",
        choices: [
          { value: false, content: texts.areas.paints },
          { value: true, content: texts.areas.erases },
        ],
        chosen: erases,
        choose: (chosen) => painting.setBrush((brush) => (brush.areas.erases = chosen)),
      })}
      ${
        erases
          ? html`<p class="hint">${texts.brush.erases(labelOf(layer))}</p>`
          : html`<strata-value-picker .session=${session} .layer=${layer} .value=${painting.brush.valueFor(layer)}></strata-value-picker>`
      }`;
  }

  private setReach(text: string): void {
    const wand = selectionOf(this.session).wand;
    const reach = readNumber(text);
    if (text.trim() === "") wand.set({ reachMm: null });
    else if (reach > 0) wand.set({ reachMm: Math.min(1e9, Math.max(1e-6, reach)) });
    else this.requestUpdate();
  }

  private image(): TemplateResult | typeof nothing {
    const { appearance } = this.session;
    if (appearance.looks.length === 0) return nothing;
    const wand = selectionOf(this.session).wand;
    const choose = (event: Event): void => {
      const { value } = event.target as HTMLSelectElement;
      wand.set({ look: value === "" ? null : Number(value) });
    };
    return html`<label class="field">
      <span>${texts.wand.image}</span>
      <select @change=${choose}>
        <option value="" ?selected=${wand.look === null}>${texts.wand.visible_images}</option>
        ${appearance.looks.map((look) => html`<option value=${look.id} ?selected=${look.id === wand.look}>${look.name}</option>`)}
      </select>
    </label>`;
  }

  private layer(): TemplateResult {
    const { layers } = this.session;
    const wand = selectionOf(this.session).wand;
    const choose = (event: Event): void => {
      const layer = layers.find(Number((event.target as HTMLSelectElement).value));
      if (layer) wand.setLayer(layer);
    };
    return html`<label class="field">
      <span>${texts.wand.layer}</span>
      <select @change=${choose}>
        ${layers.all.map((layer) => html`<option value=${layer.id} ?selected=${layer.id === wand.layer?.id}>${labelOf(layer)}</option>`)}
      </select>
    </label>`;
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-wand-panel": StrataWandPanel;
  }
}
