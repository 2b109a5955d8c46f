// Several views on one sheet: the choices of the dialog and the member of the request.

import type { FigureDirection, FigureView } from "../core/protocol.gen";

export const kFewestViews = 2;
export const kMostViews = 6;

/** Directions that are drawn together. Views are in this order on the sheet. */
export const kViewSets = {
  sides: ["front", "back", "left", "right"],
  plan: ["front", "left", "right", "top"],
  all: ["front", "right", "back", "left", "top", "bottom"],
} as const satisfies Readonly<Record<string, readonly FigureDirection[]>>;
export type ViewSet = keyof typeof kViewSets;
/** One view, directions, or saved views. */
export type ViewsChoice = "one" | ViewSet | "saved";
export const kViewsChoices: readonly ViewsChoice[] = [
  "one",
  ...(Object.keys(kViewSets) as ViewSet[]),
  "saved",
];

/**
 * Returns the views of the sheet, or null if it has only one. `saved` are the ids of the chosen saved
 * views, which may be too few. `name` returns the text below a direction.
 */
export function viewsOf(
  choice: ViewsChoice,
  saved: readonly number[],
  name: (direction: FigureDirection) => string,
): FigureView[] | null {
  if (choice === "one") return null;
  if (choice === "saved") return saved.slice(0, kMostViews).map((id) => ({ view: String(id) }));
  return kViewSets[choice].map((direction) => ({ direction, title: name(direction) }));
}

/** Adds a saved view to the chosen ones, or removes it. The order is that of the choice. */
export function toggledView(saved: readonly number[], id: number): readonly number[] {
  if (saved.includes(id)) return saved.filter((each) => each !== id);
  return saved.length < kMostViews ? [...saved, id] : saved;
}
