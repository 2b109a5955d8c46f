// The choice of layers in the dialogs of files: by default those that the user sees.

import { html, nothing, type TemplateResult } from "lit";
import type { Layer } from "../core/types";
import { labelOf } from "../domain/cells";
import { texts } from "../texts";
import type { LayersPart } from "./parts";

const words = texts.layer_choice;

/** The chosen layers, or null for those that the user sees. */
export type ChosenLayers = readonly number[] | null;

export interface LayerChoice {
  layers: LayersPart;
  chosen: ChosenLayers;
  label: string;
  hint: string;
  choose(chosen: ChosenLayers): void;
  /** The message about a wrong choice, and the id of its element. */
  problem?: { id: string | typeof nothing; text: TemplateResult | typeof nothing };
}

/** Returns the ids of the layers from bottom to top. */
export const idsOf = (layers: LayersPart, chosen: ChosenLayers): number[] =>
  layers.all
    .filter((layer) => chosen?.includes(layer.id) ?? layers.visible(layer))
    .map(({ id }) => id);

export function layerChoice(choice: LayerChoice): TemplateResult {
  const { layers, problem } = choice;
  const all = [...layers.all].reverse(); // in the order of the layer list
  const ids = idsOf(layers, choice.chosen);
  const change = ({ id }: Layer, on: boolean): void => {
    const others = ids.filter((each) => each !== id);
    choice.choose(on ? [...others, id] : others);
  };
  const told = problem?.id ?? nothing;
  return html`<div class="group" role="group" aria-labelledby="layers" aria-describedby="layers_hint">
    <span class="caption" id="layers">${choice.label}</span>
    <p class="hint" id="layers_hint">${all.length > 0 ? choice.hint : words.none}</p>
    <div class="layers">
      ${all.map(
        (layer) =>
          html`<label class="check">
            <input type="checkbox" name="layer_${layer.id}" .checked=${ids.includes(layer.id)} aria-invalid=${told !== nothing} aria-describedby=${told} @change=${(event: Event) => change(layer, (event.target as HTMLInputElement).checked)} />
            ${labelOf(layer)}
          </label>`,
      )}
    </div>
    ${
      all.length > 0
        ? html`<button type="button" class="link" ?disabled=${choice.chosen === null} @click=${() => choice.choose(null)}>${words.visible}</button>`
        : nothing
    }
    ${problem?.text ?? nothing}
  </div>`;
}
