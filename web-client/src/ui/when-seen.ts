// Delays requests that are expensive for the server until an element is visible.

/** Calls `seen` once, when the element becomes visible. Returns a function that cancels this. */
export function whenSeen(element: Element, seen: () => void): () => void {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    seen();
  });
  observer.observe(element);
  return () => observer.disconnect();
}
