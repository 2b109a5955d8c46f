// A map can have a coordinate system although the model has none. In this case, the page asks
// whether the model's coordinates are in the same system, before it sends the map.

import { css, html, type TemplateResult } from "lit";
import type { MapContents, Model } from "../../core/types";
import { texts } from "../../texts";

const words = texts.maps.crs;

/** Returns the coordinate system to ask about, or null if no question is necessary. */
export const crsInDoubt = (contents: MapContents | null, model: Model | null): string | null =>
  contents?.crs && model && model.crs === "" ? contents.crs : null;

/** Whether the page asked about these files, and the user's reply. */
export interface CrsAnswer {
  asked: boolean;
  taken: string | null;
}
export const kNotAsked: CrsAnswer = { asked: false, taken: null };

/** Returns the query parameter that sets the model's coordinate system. */
export const crsQuery = ({ taken }: CrsAnswer): { crs?: string } =>
  taken === null ? {} : { crs: taken };

export function crsQuestion(crs: string, answer: (takes: boolean) => void): TemplateResult {
  return html`<div class="crs" role="alertdialog" aria-labelledby="crs" aria-describedby="crs-hint">
    <p id="crs">${words.question(crs)}</p>
    <p id="crs-hint" class="hint">${words.hint}</p>
    <div class="answers">
      <button type="button" @click=${() => answer(false)}>${words.no}</button>
      <button type="button" class="primary" @click=${() => answer(true)}>${words.yes}</button>
    </div>
  </div>`;
}

/** Scrolls the question into view and focuses it. */
export function focusQuestion(root: ParentNode): void {
  root.querySelector(".crs")?.scrollIntoView({ block: "nearest" });
  root.querySelector<HTMLElement>(".crs button")?.focus({ preventScroll: true });
}

export const crsStyles = css`
  .crs {
    display: grid;
    gap: var(--space-2);
    padding: var(--space-3);
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
  }
  .crs .answers {
    display: flex;
    flex-wrap: wrap;
    justify-content: flex-end;
    gap: var(--space-2);
  }
`;
