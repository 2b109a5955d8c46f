// Keys of fields and of choices.

/**
 * Whether the event's innermost target takes typed text or handles keys itself, or is inside an
 * open popup or dialog.
 */
export function isForField(event: KeyboardEvent): boolean {
  const path = event.composedPath(); // crosses shadow roots, unlike closest()
  const [target] = path;
  if (!(target instanceof HTMLElement)) return false;
  if (path.some((each) => each instanceof HTMLElement && each.matches("dialog, [popover]")))
    return true;
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement)
    return target.type !== "range" || event.key.startsWith("Arrow");
  return target.getAttribute("role") === "separator" || target.isContentEditable;
}

/** The index that an arrow key selects, from `at` of `count`; null for other keys. */
export function arrowStep(key: string, at: number, count: number): number | null {
  const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[key];
  return step === undefined || count === 0 ? null : (at + step + count) % count;
}

/** The innermost focused element; null: none. */
export function hasKeyboard(): HTMLElement | null {
  let active = document.activeElement;
  while (active?.shadowRoot?.activeElement) active = active.shadowRoot.activeElement;
  return active instanceof HTMLElement && active !== document.body ? active : null;
}
