// Keys of fields and of choices.

// share of the window per key press

/**
 * Whether the event's innermost target takes typed text or has its own use for keys, or lies in
 * something open.
 */
export function isForField(event: KeyboardEvent): boolean {
  const path = event.composedPath(); // across shadow roots, which closest() does not leave
  const [target] = path;
  if (!(target instanceof HTMLElement)) return false;
  if (path.some((each) => each instanceof HTMLElement && each.matches("dialog, [popover]")))
    return true;
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement)
    return target.type !== "range" || event.key.startsWith("Arrow");
  return target.getAttribute("role") === "separator" || target.isContentEditable;
}

/** Where an arrow key leads from the choice `at` of `count`; null for other keys. */
export function arrowStep(key: string, at: number, count: number): number | null {
  const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[key];
  return step === undefined || count === 0 ? null : (at + step + count) % count;
}

/** The innermost element that takes keys; null: none in particular. */
export function hasKeyboard(): HTMLElement | null {
  let active = document.activeElement;
  while (active?.shadowRoot?.activeElement) active = active.shadowRoot.activeElement;
  return active instanceof HTMLElement && active !== document.body ? active : null;
}
