// The steps of the introduction to a model's page: the users that see them, and the elements that
// they explain.

import type { Box } from "../../ui/beside";

export const kSteps = ["turn", "layers", "brush", "undo", "values", "share"] as const;
export type StepName = (typeof kSteps)[number];

const kForPainters: readonly StepName[] = ["brush", "undo"];

/** Returns the steps for a user who may paint here, or for one who may only view. */
export const stepsFor = (canPaint: boolean): StepName[] =>
  kSteps.filter((name) => canPaint || !kForPainters.includes(name));

/**
 * Returns the step itself if its element is present. Otherwise returns the next step whose element
 * is present, or the last such step. Returns null if no element is present.
 */
export function nearestStep(name: StepName, there: readonly StepName[]): StepName | null {
  const after = kSteps.slice(kSteps.indexOf(name)).find((each) => there.includes(each));
  return after ?? there[there.length - 1] ?? null;
}

/**
 * The element that a step explains, and the bar that contains it. With `isRoom` there is no single
 * element to mark.
 */
export interface OnboardingTarget {
  element: Element;
  bar: Element;
  isRoom?: boolean;
  /** Whether the element itself is hidden, and `element` opens it. */
  isWay?: boolean;
}

/** Returns the element of a step on the page, or null if it is missing or invisible. */
export function thingOf(name: StepName, page: ParentNode): OnboardingTarget | null {
  const found = find(name, page);
  return found && found.element.checkVisibility() && found.element.getClientRects().length > 0
    ? found
    : null;
}

function find(name: StepName, page: ParentNode): OnboardingTarget | null {
  const rail = page.querySelector("strata-tool-rail");
  const head = page.querySelector("header");
  const within = (
    bar: Element | null,
    root: ParentNode | null | undefined,
    what: string,
  ): OnboardingTarget | null => {
    const element = root?.querySelector(what);
    return bar && element ? { element, bar } : null;
  };
  switch (name) {
    case "turn": {
      const stage = page.querySelector("strata-stage");
      return stage && { element: stage, bar: stage, isRoom: true };
    }
    case "layers": {
      const panel = page.querySelector("aside");
      const bar = panel?.checkVisibility() ? panel : null;
      const way = within(bar, page, "[data-tab=layers]") ?? within(head, head, "[data-tour=panel]");
      return within(bar, page, "strata-layer-panel") ?? (way && { ...way, isWay: true });
    }
    case "brush":
    case "undo":
    case "values":
      return within(rail, rail?.shadowRoot, `[data-tour=${name}]`);
    case "share":
      return within(head, head, "[data-tour=share]");
  }
}

/** Returns the part of an element that is inside its bar and inside the window. */
export function seenBox({ element, bar, isRoom }: OnboardingTarget): Box {
  const [own, outer] = [element.getBoundingClientRect(), bar.getBoundingClientRect()];
  if (isRoom) return middleOf(own);
  const left = Math.max(own.left, outer.left, 0);
  const top = Math.max(own.top, outer.top, 0);
  return {
    left,
    top,
    width: Math.max(0, Math.min(own.right, outer.right, innerWidth) - left),
    height: Math.max(0, Math.min(own.bottom, outer.bottom, innerHeight) - top),
  };
}

const kMargin = 0.3; // share of the stage on each side of its middle part

const middleOf = ({ left, top, width, height }: DOMRect): Box => ({
  left: left + kMargin * width,
  top: top + kMargin * height,
  width: (1 - 2 * kMargin) * width,
  height: (1 - 2 * kMargin) * height,
});
