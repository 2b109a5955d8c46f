import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

/** The history of a browser tab. It reports a navigation only after the navigation is complete. */
class FakeHistory {
  entries = ["/"];
  at = 0;
  state = null;
  told: () => void = () => {};

  pushState(_state: unknown, _title: string, path: string): void {
    this.entries.splice(++this.at, Infinity, path);
  }
  replaceState(_state: unknown, _title: string, path: string): void {
    this.entries[this.at] = path;
  }
  back(): void {
    this.at -= 1;
    this.told();
  }
  forward(): void {
    this.at += 1;
    this.told();
  }

  private get url(): URL {
    return new URL(this.entries[this.at]!, "http://here");
  }
  readonly location = ((self: FakeHistory) => ({
    get pathname() {
      return self.url.pathname;
    },
    get search() {
      return self.url.search;
    },
    get hash() {
      return self.url.hash;
    },
  }))(this);
}

let tab: FakeHistory;
let seen: string[];
let routes: typeof import("../../src/ui/routes");

beforeEach(async () => {
  vi.resetModules();
  tab = new FakeHistory();
  seen = [];
  vi.stubGlobal("history", tab);
  vi.stubGlobal("location", tab.location);
  vi.stubGlobal("addEventListener", (_name: string, listener: () => void) => (tab.told = listener));
  routes = await import("../../src/ui/routes");
  routes.onNavigate(() => seen.push(routes.pathNow()));
  routes.navigate("/models/pot");
  routes.putHash("#view=rim");
});
afterEach(() => void vi.unstubAllGlobals());

const answered = (): Promise<void> => new Promise((resolve) => void setTimeout(resolve));

describe("a page that is held", () => {
  it("is left at once where nothing holds it", () => {
    routes.holdPage(() => Promise.resolve(false))();
    tab.back();
    expect(seen).toEqual(["/models/pot", "/"]);
  });
  it("stays where the question is answered with no, by a link or by going back", async () => {
    const ask = vi.fn(() => Promise.resolve(false));
    routes.holdPage(ask);
    routes.navigate("/");
    await answered();
    tab.back();
    await answered();
    expect(ask).toHaveBeenCalledTimes(2);
    expect(seen).toEqual(["/models/pot"]);
    expect(tab.entries).toEqual(["/", "/models/pot#view=rim"]);
    expect(tab.at).toBe(1);
  });
  it("is left by a link after a yes, and holds nothing then", async () => {
    const ask = vi.fn(() => Promise.resolve(true));
    routes.holdPage(ask);
    routes.navigate("/projects/demo");
    expect(seen).toEqual(["/models/pot"]);
    await answered();
    routes.navigate("/");
    expect(ask).toHaveBeenCalledTimes(1);
    expect(seen).toEqual(["/models/pot", "/projects/demo", "/"]);
  });
  it("is left forward and back after a yes, to where the browser was", async () => {
    routes.navigate("/projects/demo");
    routes.holdPage(() => Promise.resolve(true));
    tab.back();
    await answered();
    expect(tab.location.pathname).toBe("/models/pot");
    routes.holdPage(() => Promise.resolve(true));
    tab.forward();
    await answered();
    expect(seen).toEqual(["/models/pot", "/projects/demo", "/models/pot", "/projects/demo"]);
  });
  it("asks once at a time", async () => {
    let answer: (yes: boolean) => void = () => {};
    const ask = vi.fn(() => new Promise<boolean>((resolve) => (answer = resolve)));
    routes.holdPage(ask);
    tab.back();
    tab.back();
    routes.navigate("/projects/demo");
    expect(ask).toHaveBeenCalledTimes(1);
    answer(true);
    await answered();
    expect(seen).toEqual(["/models/pot", "/"]);
  });
  it("is not left by what is looked at on it", () => {
    const ask = vi.fn(() => Promise.resolve(false));
    routes.holdPage(ask);
    routes.navigate("/models/pot#comment=3");
    tab.back();
    expect(ask).not.toHaveBeenCalled();
    expect(seen).toEqual(["/models/pot", "/models/pot", "/models/pot"]);
  });
  it("is asked about by what takes it away without going anywhere", async () => {
    expect(await routes.mayLeavePage()).toBe(true);
    const letGo = routes.holdPage(() => Promise.resolve(false));
    expect(await routes.mayLeavePage()).toBe(false);
    letGo();
    expect(await routes.mayLeavePage()).toBe(true);
  });
  it("is let go of only by who holds it", async () => {
    const letGo = routes.holdPage(() => Promise.resolve(true));
    routes.holdPage(() => Promise.resolve(false));
    letGo();
    expect(await routes.mayLeavePage()).toBe(false);
  });
});
