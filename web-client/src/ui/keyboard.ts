// Functions for keys in fields and choices.

/**
 * Whether the innermost target of the event accepts typed text or handles keys itself, or is inside
 * an open popup or dialog.
 */
export function isForField(event: KeyboardEvent): boolean {
  const path = event.composedPath(); // includes shadow roots, unlike closest()
  const [target] = path;
  if (!(target instanceof HTMLElement)) return false;
  if (path.some((each) => each instanceof HTMLElement && each.matches("dialog, [popover]")))
    return true;
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement)
    return target.type !== "range" || event.key.startsWith("Arrow");
  return target.getAttribute("role") === "separator" || target.isContentEditable;
}

/**
 * Returns the index that an arrow key selects, from index `at` of `count` items. Returns null for
 * other keys.
 */
export function arrowStep(key: string, at: number, count: number): number | null {
  const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[key];
  return step === undefined || count === 0 ? null : (at + step + count) % count;
}

/** Returns the innermost focused element, or null. */
export function hasKeyboard(): HTMLElement | null {
  let active = document.activeElement;
  while (active?.shadowRoot?.activeElement) active = active.shadowRoot.activeElement;
  return active instanceof HTMLElement && active !== document.body ? active : null;
}
