import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { fillScreen, keepOnPage, stayAwake } from "../../src/kiosk/guard";

/**
 * As in browsers, wheel and touch listeners on the document can cancel events only if they are
 * registered with `passive: false`.
 */
class FakeDocument extends EventTarget {
  visibilityState = "visible";
  fullscreenEnabled = true;
  fullscreenElement: object | null = null;
  documentElement = { requestFullscreen: vi.fn(() => Promise.reject(new Error("not granted"))) };
  override addEventListener(
    name: string,
    listener: (event: Event) => void,
    { passive }: { passive?: boolean } = {},
  ): void {
    if (["wheel", "touchmove"].includes(name) && passive !== false) return;
    super.addEventListener(name, listener);
  }
}

let page: FakeDocument;
beforeEach(() => vi.stubGlobal("document", (page = new FakeDocument())));
afterEach(() => void vi.unstubAllGlobals());

/**
 * Returns whether the page prevents the default of an event with this name and these properties.
 */
function refuses(name: string, properties: object = {}, cancelable = true): boolean {
  const event = Object.assign(new Event(name, { cancelable }), properties);
  const prevent = vi.spyOn(event, "preventDefault");
  page.dispatchEvent(event);
  return prevent.mock.calls.length > 0;
}

describe("what keeps visitors on the page", () => {
  let window: EventTarget;
  const history = { pushState: vi.fn() };
  beforeEach(() => {
    window = new EventTarget();
    history.pushState.mockClear();
    vi.stubGlobal("addEventListener", window.addEventListener.bind(window));
    vi.stubGlobal("history", history);
    vi.stubGlobal("location", { href: "https://strata.example/kiosk/secret" });
    keepOnPage();
  });

  it.each(["contextmenu", "selectstart", "dragstart", "gesturestart", "gesturechange"])(
    "refuses %s",
    (name) => expect(refuses(name)).toBe(true),
  );

  it("refuses the wheel that zooms, not the one that scrolls", () => {
    expect(refuses("wheel", { ctrlKey: true })).toBe(true);
    expect(refuses("wheel", { ctrlKey: false })).toBe(false);
  });

  it("refuses two fingers that zoom, where they can be refused, and lets one scroll", () => {
    expect(refuses("touchmove", { touches: [1, 2] })).toBe(true);
    // browsers would report an error for an event that cannot be canceled
    expect(refuses("touchmove", { touches: [1, 2] }, false)).toBe(false);
    expect(refuses("touchmove", { touches: [1] })).toBe(false);
  });

  it.each(["+", "-", "=", "0", "p"])(
    "refuses Ctrl and Cmd with %s, and leaves the key alone to the object",
    (key) => {
      expect(refuses("keydown", { key, ctrlKey: true })).toBe(true);
      expect(refuses("keydown", { key, metaKey: true })).toBe(true);
      expect(refuses("keydown", { key })).toBe(false);
    },
  );

  it.each(["ArrowLeft", "ArrowRight"])(
    "refuses Alt with %s, and leaves the key alone to the object",
    (key) => {
      expect(refuses("keydown", { key, altKey: true })).toBe(true);
      expect(refuses("keydown", { key })).toBe(false);
    },
  );

  it.each(["Tab", "Enter", " ", "c"])("leaves %j alone, whatever is held with it", (key) =>
    expect(refuses("keydown", { key, ctrlKey: true, altKey: true })).toBe(false),
  );

  it("is where it was after each way back", () => {
    const here = [null, "", "https://strata.example/kiosk/secret"];
    expect(history.pushState.mock.calls).toEqual([here]);
    window.dispatchEvent(new Event("popstate"));
    window.dispatchEvent(new Event("popstate"));
    expect(history.pushState.mock.calls).toEqual([here, here, here]);
  });
});

describe("a screen that stays on", () => {
  const request = vi.fn(async (_kind: string) => {});
  beforeEach(() => {
    request.mockClear();
    vi.stubGlobal("navigator", { wakeLock: { request } });
  });

  it("is asked of the browser while the page is seen", async () => {
    await stayAwake();
    expect(request.mock.calls).toEqual([["screen"]]);
    page.visibilityState = "hidden";
    await stayAwake();
    expect(request).toHaveBeenCalledTimes(1);
  });

  it("is done without where it is refused or not known", async () => {
    vi.stubGlobal("navigator", {
      wakeLock: { request: () => Promise.reject(new Error("low battery")) },
    });
    await expect(stayAwake()).resolves.toBeUndefined();
    vi.stubGlobal("navigator", {});
    await expect(stayAwake()).resolves.toBeUndefined();
  });
});

describe("the whole screen", () => {
  const fills = (width: number, height: number): boolean => {
    vi.stubGlobal("screen", { width: 1080, height: 1920 });
    vi.stubGlobal("innerWidth", width);
    vi.stubGlobal("innerHeight", height);
    fillScreen();
    return page.documentElement.requestFullscreen.mock.calls.length > 0;
  };
  it("is asked for where bars of the browser are left", () => expect(fills(1080, 1800)).toBe(true));
  it("is not where the browser's kiosk mode has given it", () =>
    expect(fills(1080, 1920)).toBe(false));
  it("is not where a browser has no such thing", () => {
    page.fullscreenEnabled = false;
    expect(fills(1080, 1800)).toBe(false);
  });
  it("is not asked for twice", () => {
    page.fullscreenElement = {};
    expect(fills(1080, 1800)).toBe(false);
  });
});
