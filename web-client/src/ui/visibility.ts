// The visibility of a layer, column or file: the choice in dialogs, and the badge of restricted
// items.

import { html, nothing, type TemplateResult } from "lit";
import type { Visibility } from "../core/protocol.gen";
import { icon, type IconName } from "./icons";
import { radioGroup } from "./radio-group";
import { texts } from "../texts";

export const kVisibilities: readonly Visibility[] = ["public", "team", "private"];
const kIcons: Record<Visibility, IconName> = { public: "eye", team: "people", private: "shield" };

/** Renders the choice of a visibility, with an explanation. */
export function visibilityChoice(
  chosen: Visibility,
  choose: (visibility: Visibility) => void,
): TemplateResult {
  const words = texts.visibility;
  return html`<div class="visibility">
    <p class="caption" id="visibility">${words.question}</p>
    ${radioGroup<Visibility>({
      label: { id: "visibility" },
      class: "segments",
      choices: kVisibilities.map((value) => ({
        value,
        content: html`${icon(kIcons[value])}${words.names[value]}`,
      })),
      chosen,
      choose,
    })}
    <p class="hint" role="status">${words.says[chosen]}</p>
  </div>`;
}

/** Renders the badge of an item. Public items have no badge. */
export function visibilityBadge(visibility: Visibility): TemplateResult | typeof nothing {
  if (visibility === "public") return nothing;
  const says = texts.visibility.says[visibility];
  return html`<span class="seen-by" role="img" aria-label=${says} title=${says}>${icon(kIcons[visibility])}</span>`;
}
