// Focuses the first field with a problem, which may be outside the visible part of a dialog.

import { ReactiveElement } from "lit";

/** Waits until the element and the elements in it show the problems. */
export async function focusWrong(host: ReactiveElement): Promise<void> {
  (await firstWrong(host))?.focus();
}

async function firstWrong(root: Element): Promise<HTMLElement | null> {
  if (root instanceof HTMLElement && root.getAttribute("aria-invalid") === "true") return root;
  if (root instanceof ReactiveElement) await root.updateComplete;
  for (const part of [root.shadowRoot, root])
    for (const child of part?.children ?? []) {
      const found = await firstWrong(child);
      if (found) return found;
    }
  return null;
}
