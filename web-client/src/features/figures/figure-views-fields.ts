// The choice of one or several views on the sheet.

import { css, html, nothing, type TemplateResult } from "lit";
import {
  kFewestViews,
  kMostViews,
  kViewSets,
  kViewsChoices,
  toggledView,
  type ViewsChoice,
} from "../../domain/figure-views";
import type { FigureDirection } from "../../core/protocol.gen";
import type { ModelSession } from "../../session/model-session";
import { texts } from "../../texts";

const words = texts.figures.views;

export const viewsStyles = css`
  fieldset.views {
    display: grid;
    gap: var(--space-1);
    margin: 0;
    padding: 0;
    border: 0;
    min-width: 0;
  }
`;

/** Returns the words for a choice. */
export const nameOfViews = (choice: ViewsChoice): string => {
  if (choice === "one") return words.one;
  if (choice === "saved") return words.saved;
  return kViewSets[choice].map((each: FigureDirection) => words.directions[each]).join(", ");
};

/** Callbacks to the dialog. */
interface ViewsFields {
  chosen: ViewsChoice;
  saved: readonly number[];
  wrong: boolean;
  told: string | typeof nothing;
  problem: TemplateResult | typeof nothing;
  choose(choice: ViewsChoice): void;
  tick(saved: readonly number[]): void;
}

export function viewsFields(
  { views }: ModelSession,
  { chosen, saved, wrong, told, problem, choose, tick }: ViewsFields,
): TemplateResult {
  const choices = kViewsChoices.filter(
    (each) => each !== "saved" || chosen === "saved" || views.all.length >= kFewestViews,
  );
  return html`<div class="group full">
    <label class="field">
      <span>${words.title}</span>
      <select name="views" aria-invalid=${wrong && chosen !== "saved"} aria-describedby=${told} @change=${(event: Event) => choose((event.target as HTMLSelectElement).value as ViewsChoice)}>
        ${choices.map((each) => html`<option value=${each} ?selected=${each === chosen}>${nameOfViews(each)}</option>`)}
      </select>
    </label>
    ${
      chosen === "saved"
        ? html`<fieldset class="views">
          <legend class="caption">${words.which(kFewestViews, kMostViews)}</legend>
          ${views.all.map(
            (view, index) =>
              html`<label class="check">
                <input type="checkbox" name="view_${view.id}" aria-invalid=${wrong && index === 0} .checked=${saved.includes(view.id)} ?disabled=${!saved.includes(view.id) && saved.length >= kMostViews} @change=${() => tick(toggledView(saved, view.id))} />
                ${view.name}
              </label>`,
          )}
        </fieldset>`
        : nothing
    }
    ${problem}
  </div>`;
}
