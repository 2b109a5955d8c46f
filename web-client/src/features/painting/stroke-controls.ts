// The controls of strokes inside and outside of an area, in the toolbar over the 3D view: the side of
// the next stroke, what the user can do next, and buttons that end the strokes.

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
    ${strokes.isOpen && state !== "found" ? giveUp(strokes) : nothing}
    ${state === "found" ? nothing : html`<span class="next">${words.next[state]}</span>`}`;
}

/** The buttons that end strokes with an area. */
export function strokeEnds(strokes: Strokes): TemplateResult {
  return html`<button class="primary" @click=${() => strokes.accept()}>${texts.strokes.accept}</button>
    ${giveUp(strokes)}`;
}

function giveUp(strokes: Strokes): TemplateResult {
  return html`<button @click=${() => strokes.giveUp()}>${texts.strokes.give_up}</button>`;
}
