// A map that names its coordinate system, on a model that has none: whether its coordinates are the
// model's is asked before it is sent.

import { css, html, type TemplateResult } from "lit";
import type { MapContents, Model } from "../../core/types";
import { texts } from "../../texts";

const words = texts.maps.crs;

/** The system to ask about; null: nothing is in doubt. */
export const crsInDoubt = (contents: MapContents | null, model: Model | null): string | null =>
  contents?.crs && model && model.crs === "" ? contents.crs : null;

/** Whether it was asked for these files, and what was answered. */
export interface CrsAnswer {
  asked: boolean;
  taken: string | null;
}
export const kNotAsked: CrsAnswer = { asked: false, taken: null };

/** For the query: the system whose coordinates the model's are. */
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

/** The question comes into sight and takes the keyboard. */
export function focusQuestion(root: ParentNode): void {
  root.querySelector(".crs")?.scrollIntoView({ block: "nearest" });
  root.querySelector<HTMLElement>(".crs button")?.focus({ preventScroll: true });
}

export const crsStyles = css`
  .crs {
    display: grid;
    gap: 0.5rem;
    padding: 0.75rem;
    border: var(--edge) solid var(--line-strong);
    border-radius: var(--radius-small);
  }
  .crs .answers {
    display: flex;
    flex-wrap: wrap;
    justify-content: flex-end;
    gap: 0.5rem;
  }
`;
