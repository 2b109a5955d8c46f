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

const kShareStep = 0.02;

/**
 * Returns the value of a slider from 0 to 1 after a key. Returns null if the key does not move it.
 */
export function shareAfter(
  { key, shiftKey }: Pick<KeyboardEvent, "key" | "shiftKey">,
  share: number,
): number | null {
  const step = shiftKey ? 5 * kShareStep : kShareStep;
  switch (key) {
    case "ArrowLeft":
      return Math.max(0, share - step);
    case "ArrowRight":
      return Math.min(1, share + step);
    case "Home":
      return 0;
    case "End":
      return 1;
    default:
      return null;
  }
}

/** Returns the innermost focused element, or null. */
export function hasKeyboard(): HTMLElement | null {
  let active = document.activeElement;
  while (active?.shadowRoot?.activeElement) active = active.shadowRoot.activeElement;
  return active instanceof HTMLElement && active !== document.body ? active : null;
}
