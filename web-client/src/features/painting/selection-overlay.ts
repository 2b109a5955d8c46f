// The finished outlines of the selection. They are over the 3D view.

import { html, nothing, svg, type TemplateResult } from "lit";
import { middleAfter, type Selection } from "./selection";

const kDashes = { add: "none", subtract: "3 5", intersect: "9 4" };

/**
 * Renders the outlines that were drawn in the current view, with handles at their corners. `scale`
 * is the number of window pixels per CSS pixel.
 */
export function selectionOverlay(selection: Selection, scale: number): TemplateResult {
  const at = ([x, y]: readonly number[]): [number, number] => [x! / scale, y! / scale];
  const { active } = selection;
  const outlines = selection.outlines.filter(({ outline }) => selection.isInView(outline));
  return html`<svg class="over" aria-hidden="true">
    ${outlines.map(({ outline: { within, combine, corners }, step }) => {
      const { path } = within;
      const points = path.map((point) => at(point).join(",")).join(" ");
      return svg`<polygon points=${points} fill="none" stroke="var(--mark-rim)" stroke-width="3.4" stroke-linejoin="round" />
        <polygon points=${points} fill="none" stroke="var(--mark-light)" stroke-width="1.6" stroke-linejoin="round" stroke-dasharray=${kDashes[combine]} />
        ${corners ? path.map((_, corner) => handle(at(middleAfter(path, corner)), 3, false)) : nothing}
        ${
          corners
            ? path.map((point, corner) =>
                handle(at(point), 5, active?.step === step && active.corner === corner),
              )
            : nothing
        }`;
    })}
  </svg>`;
}

const handle = ([x, y]: [number, number], size: number, active: boolean): TemplateResult =>
  svg`<circle cx=${x} cy=${y} r=${active ? size + 2 : size} fill=${active ? "var(--lit)" : "var(--mark-light)"} stroke="var(--mark-dark)" stroke-width="1.5" fill-opacity=${size > 3 ? 1 : 0.75} />`;
