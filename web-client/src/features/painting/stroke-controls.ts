// The controls of strokes inside and outside of an area, in the toolbar over the 3D view: the side of
// the next stroke, and what the user can do next.

import { html, nothing, type TemplateResult } from "lit";
import { radioGroup } from "../../ui/radio-group";
import { texts } from "../../texts";
import type { Strokes } from "./strokes";

export function strokeControls(strokes: Strokes): TemplateResult {
  const words = texts.strokes;
  const { state } = strokes;
  return html`${radioGroup<boolean>({
    label: words.side,
    class: "segments",
    choices: [
      { value: true, content: words.inside, title: words.inside_hint },
      { value: false, content: words.outside, title: words.outside_hint },
    ],
    chosen: strokes.drawsInside,
    choose: (inside) => strokes.draw(inside),
  })}
    ${state === "found" ? nothing : html`<span class="next">${words.next[state]}</span>`}`;
}
