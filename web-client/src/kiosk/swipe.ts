// Detects horizontal swipes. Vertical movement scrolls as usual.

const kReach = 48; // CSS pixels

/**
 * Calls `swiped` with +1 for a swipe to the left, which shows the next item on the right. Calls it
 * with −1 for a swipe to the right. Returns a function that stops the detection.
 */
export function followSwipes(element: HTMLElement, swiped: (by: 1 | -1) => void): () => void {
  let start: { pointer: number; x: number; y: number } | null = null;
  let justSwiped = false;
  const down = (event: PointerEvent): void => {
    justSwiped = false;
    start = event.isPrimary
      ? { pointer: event.pointerId, x: event.clientX, y: event.clientY }
      : null;
  };
  const up = (event: PointerEvent): void => {
    if (start?.pointer !== event.pointerId) return;
    const [dx, dy] = [event.clientX - start.x, event.clientY - start.y];
    start = null;
    if (Math.abs(dx) < kReach || Math.abs(dx) < 1.5 * Math.abs(dy)) return;
    justSwiped = true;
    swiped(dx < 0 ? 1 : -1);
  };
  const cancel = (): void => void (start = null);
  /** Suppresses the click on the button at which a swipe ends. */
  const click = (event: Event): void => {
    if (justSwiped) event.stopPropagation();
    justSwiped = false;
  };
  element.addEventListener("pointerdown", down);
  addEventListener("pointerup", up);
  element.addEventListener("pointercancel", cancel);
  element.addEventListener("click", click, true);
  return () => {
    element.removeEventListener("pointerdown", down);
    removeEventListener("pointerup", up);
    element.removeEventListener("pointercancel", cancel);
    element.removeEventListener("click", click, true);
  };
}
