// The search field above a long list of layers.

import { css, html, nothing, type TemplateResult } from "lit";
import { misfit, wordsOf } from "../../core/search";
import { labelOf } from "../../domain/cells";
import type { Layer } from "../../core/types";
import { icon } from "../../ui/icons";
import { radioGroup } from "../../ui/radio-group";
import { texts } from "../../texts";

/** The search field appears for more layers than this. */
export const kMostWithoutSearch = 7;

const kShown = ["all", "visible", "locked"] as const;

export interface LayerFilter {
  text: string;
  show: (typeof kShown)[number];
}

export const kNoFilter: LayerFilter = { text: "", show: "all" };

export const isFiltered = ({ text, show }: LayerFilter): boolean =>
  text.trim() !== "" || show !== "all";

/**
 * `visible` is the visibility for this user. The search also matches the name of the layer's group.
 */
export function fits(layer: Layer, { text, show }: LayerFilter, visible: boolean): boolean {
  if (show === "visible" && !visible) return false;
  if (show === "locked" && !layer.locked) return false;
  return misfit(wordsOf(text), labelOf(layer), layer.group) !== null;
}

export const layerFilterStyles = css`
  .filter {
    display: grid;
    gap: var(--space-2);
    margin-bottom: var(--space-2);
  }
  .find {
    position: relative;
  }
  .find button {
    position: absolute;
    top: 1px;
    right: 1px;
  }
  .filter .segments {
    display: flex;
  }
`;

export function layerFilter(
  filter: LayerFilter,
  change: (filter: LayerFilter) => void,
): TemplateResult {
  const words = texts.layers;
  const clear = (): void => change({ ...filter, text: "" });
  return html`<div class="filter" role="search">
    <div class="find">
      <input
        type="text"
        aria-label=${words.find}
        placeholder=${words.find}
        autocomplete="off"
        spellcheck="false"
        maxlength="200"
        .value=${filter.text}
        @input=${(event: Event) => change({ ...filter, text: (event.target as HTMLInputElement).value })}
        @keydown=${(event: KeyboardEvent) => {
          if (event.key !== "Escape") return;
          event.stopPropagation();
          if (filter.text === "") (event.target as HTMLElement).blur();
          else clear();
        }}
      />
      ${filter.text === "" ? nothing : html`<button class="icon quiet" aria-label=${texts.terms.show_all} title=${texts.terms.show_all} @click=${clear}>${icon("close")}</button>`}
    </div>
    ${radioGroup({
      label: words.title,
      class: "segments",
      choices: kShown.map((value) => ({ value, content: words.shown[value] })),
      chosen: filter.show,
      choose: (show) => change({ ...filter, show }),
    })}
  </div>`;
}
