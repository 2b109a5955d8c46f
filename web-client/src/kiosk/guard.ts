// Keeps visitors on the page: no context menu, selection, dragging, page zoom, printing or history.
// Full screen, which requires a touch, hides the browser's toolbars. Only the browser's own kiosk
// mode disables the browser's keys.

const refuse = (event: Event): void => event.preventDefault();

export function keepOnPage(): void {
  for (const name of ["contextmenu", "selectstart", "dragstart", "gesturestart", "gesturechange"])
    document.addEventListener(name, refuse);
  document.addEventListener("wheel", (event) => event.ctrlKey && event.preventDefault(), {
    passive: false,
  });
  // Safari zooms with two fingers regardless of the page's viewport. The stage's own gestures use
  // pointer events.
  document.addEventListener(
    "touchmove",
    (event) => event.touches.length > 1 && event.cancelable && event.preventDefault(),
    { passive: false },
  );
  document.addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && ["+", "-", "=", "0", "p"].includes(event.key))
      event.preventDefault();
    if (event.altKey && ["ArrowLeft", "ArrowRight"].includes(event.key)) event.preventDefault();
  });
  history.pushState(null, "", location.href);
  addEventListener("popstate", () => history.pushState(null, "", location.href));
}

/**
 * Requests full screen, unless the browser's own kiosk mode provides it. Browsers grant it only
 * after a touch. The browsers of visitors' own devices may refuse or end it.
 */
export function fillScreen(): void {
  const hasIt =
    document.fullscreenElement !== null ||
    (innerWidth >= screen.width && innerHeight >= screen.height);
  if (document.fullscreenEnabled && !hasIt)
    document.documentElement.requestFullscreen({ navigationUI: "hide" }).catch(() => {});
}

/** Keeps the screen on if the browser permits it. */
export async function stayAwake(): Promise<void> {
  try {
    if (document.visibilityState === "visible") await navigator.wakeLock?.request("screen");
  } catch {
    // With a low battery or without permission, the system's settings apply.
  }
}
