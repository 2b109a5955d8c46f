// What costs the server something is asked for once somebody can see where it goes.

/** `seen` is called once, when the element comes into sight. Returns what ends the wait. */
export function whenSeen(element: Element, seen: () => void): () => void {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    seen();
  });
  observer.observe(element);
  return () => observer.disconnect();
}
