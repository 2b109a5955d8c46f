// Keeps visitors on the page: no menu, no selection, no dragging out, no zoom of the whole page, no
// printing, no way back. The browser's bars go with the whole screen, where a touch may ask for it;
// its keys only its own kiosk mode takes away.

const refuse = (event: Event): void => event.preventDefault();

export function keepOnPage(): void {
  for (const name of ["contextmenu", "selectstart", "dragstart", "gesturestart", "gesturechange"])
    document.addEventListener(name, refuse);
  document.addEventListener("wheel", (event) => event.ctrlKey && event.preventDefault(), {
    passive: false,
  });
  // Safari zooms with two fingers whatever the page's viewport says; the stage's own gestures are
  // of pointers.
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
 * The whole screen, where the browser's own kiosk mode has not given it: browsers grant that to a
 * touch only, and visitors' browsers not at all or for as long as they want.
 */
export function fillScreen(): void {
  const hasIt =
    document.fullscreenElement !== null ||
    (innerWidth >= screen.width && innerHeight >= screen.height);
  if (document.fullscreenEnabled && !hasIt)
    document.documentElement.requestFullscreen({ navigationUI: "hide" }).catch(() => {});
}

/** The screen stays on, where the browser grants that. */
export async function stayAwake(): Promise<void> {
  try {
    if (document.visibilityState === "visible") await navigator.wakeLock?.request("screen");
  } catch {
    // Low battery, or not allowed: the screen's own settings rule.
  }
}
