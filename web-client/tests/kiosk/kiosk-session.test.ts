// The life cycle of a kiosk without a browser: a server with fixed responses, sockets without a
// network, and a fake clock.
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Api } from "../../src/net/api";
import { ApiError } from "../../src/net/api-error";
import type { KioskSelf, View } from "../../src/core/protocol.gen";
import { KioskSession } from "../../src/kiosk/kiosk-session";
import { KioskLink } from "../../src/kiosk/link";
import { KioskStore, type KioskCache } from "../../src/kiosk/store";
import { FakeSocket, welcome } from "../fake-socket";

const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -5, 1];
const kProjection = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.2, -1, 0, 0, -2, 0];
const view = (id: number, slug: string): View => ({
  id,
  name: slug,
  slug,
  text: "",
  camera: { view: kIdentity, projection: kProjection, width: 800, height: 600 },
  layers: [],
  light: { mode: "museum" },
  user: "",
  time: "2026-01-01T00:00:00Z",
  version: 1,
});
const stop = (slug: string, more = {}) => ({
  view: slug,
  title: { en: slug },
  text: {},
  attract_s: 10,
  transition: "move" as const,
  transition_s: 2,
  layers: [],
  records: [],
  ...more,
});
const told = (change: Partial<KioskSelf["tour"]> = {}): KioskSelf => ({
  id: 1,
  name: "Foyer",
  project: "p",
  model: "pot",
  wants_reload: false,
  tour: {
    id: 1,
    slug: "t",
    name: "T",
    text: "",
    languages: ["en", "de"],
    idle_s: 60,
    stops: [stop("a"), stop("b")],
    user: "",
    time: "2026-01-01T00:00:00Z",
    version: 1,
    ...change,
  },
});

class Site {
  self: KioskSelf = told();
  away = false;
  revoked = false;
  cookie = false;
  asked: string[] = [];
  readonly api = new Api(async (address, init) => this.answer(address, init));

  async answer(address: string, init?: RequestInit): Promise<Response> {
    const path = address.replace(/^\/api\/v1/, "").replace(/[?&]as=kiosk$/, "");
    this.asked.push(`${init?.method ?? "GET"} ${path}`);
    if (this.away) throw new TypeError("Failed to fetch");
    const json = (value: unknown, status = 200): Response =>
      new Response(JSON.stringify(value), { status });
    if (path === "/auth/kiosk") {
      if (this.revoked) return json({ title: "Link not valid", status: 401 }, 401);
      this.cookie = true;
      this.self = { ...this.self, wants_reload: false };
      return json(this.self);
    }
    if (path === "/kiosk")
      return this.cookie && !this.revoked
        ? json(this.self)
        : json({ title: "Not signed in", status: 401 }, 401);
    const slug = /^\/models\/pot\/views\/([a-z]+)$/.exec(path)?.[1];
    if (slug && slug !== "gone") return json(view(slug.charCodeAt(0), slug));
    if (path.endsWith("/picture")) return new Response("JPEG");
    return json({ title: "Not found", status: 404 }, 404);
  }
}

const settle = async (): Promise<void> => void (await vi.advanceTimersByTimeAsync(1));
const count = (site: Site, path: string): number =>
  site.asked.filter((asked) => asked === path).length;

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("window", {
    location: { protocol: "https:", host: "strata.example" },
    devicePixelRatio: 1,
  });
  vi.stubGlobal("location", { origin: "https://strata.example", pathname: "/kiosk/SECRET" });
  vi.stubGlobal("matchMedia", () => ({ matches: true }));
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => setTimeout(callback, 16));
  vi.stubGlobal("cancelAnimationFrame", (id: number) => clearTimeout(id));
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

describe("the link of a kiosk", () => {
  const make = () => {
    const site = new Site();
    const host = { told: vi.fn(), missed: vi.fn(), worthless: vi.fn(), reload: vi.fn() };
    const link = new KioskLink(site.api, "SECRET", host);
    link.ask();
    return { site, host, link };
  };

  it("signs in once, and asks every half minute", async () => {
    const { site, host } = make();
    await settle();
    expect(site.asked).toEqual(["POST /auth/kiosk"]);
    await vi.advanceTimersByTimeAsync(5 * 60_000);
    expect([count(site, "POST /auth/kiosk"), count(site, "GET /kiosk")]).toEqual([1, 10]);
    expect(host.told).toHaveBeenCalledTimes(11);
    expect(vi.getTimerCount()).toBe(1);
  });

  it("loads the page anew when it is asked to", async () => {
    const { site, host } = make();
    await settle();
    site.self = { ...site.self, wants_reload: true };
    await vi.advanceTimersByTimeAsync(30_000);
    expect([host.reload.mock.calls.length, vi.getTimerCount()]).toEqual([1, 0]);
  });

  it("asks a server that is away for ever, at most every half minute, and goes on when it is back", async () => {
    const { site, host } = make();
    await settle();
    site.away = true;
    await vi.advanceTimersByTimeAsync(3600_000);
    const asked = count(site, "GET /kiosk");
    expect(asked).toBeGreaterThan(115);
    expect(asked).toBeLessThan(130);
    expect(host.worthless).not.toHaveBeenCalled();
    site.away = false;
    host.told.mockClear();
    await vi.advanceTimersByTimeAsync(30_000);
    expect(host.told).toHaveBeenCalled();
  });

  it("signs in again when only the cookie is gone", async () => {
    const { site, host } = make();
    await settle();
    site.cookie = false;
    await vi.advanceTimersByTimeAsync(30_000);
    expect([count(site, "POST /auth/kiosk"), host.worthless.mock.calls.length]).toEqual([2, 0]);
  });

  it("is worthless when it was revoked or its tour is in the trash, asks seldom, and begins anew when it is good again", async () => {
    const { site, host, link } = make();
    await settle();
    site.revoked = true;
    link.ask();
    await settle();
    expect([host.worthless.mock.calls.length, vi.getTimerCount()]).toEqual([1, 1]);
    const { length } = site.asked;
    await vi.advanceTimersByTimeAsync(3600_000);
    expect(site.asked.length).toBe(length + 12);
    expect([host.told.mock.calls.length, host.reload.mock.calls.length]).toEqual([1, 0]);
    site.revoked = false;
    await vi.advanceTimersByTimeAsync(300_000);
    expect([
      host.told.mock.calls.length,
      host.reload.mock.calls.length,
      vi.getTimerCount(),
    ]).toEqual([1, 1, 0]);
  });

  it("takes too many tries for no verdict", async () => {
    const site = new Site();
    const host = { told: vi.fn(), missed: vi.fn(), worthless: vi.fn(), reload: vi.fn() };
    const refuse = vi
      .spyOn(site.api, "json")
      .mockRejectedValue(new ApiError({ status: 429, title: "Too many tries" }));
    new KioskLink(site.api, "SECRET", host).ask();
    await vi.advanceTimersByTimeAsync(10_000);
    expect([host.missed.mock.calls.length > 2, host.worthless.mock.calls.length]).toEqual([
      true,
      0,
    ]);
    refuse.mockRestore();
    await vi.advanceTimersByTimeAsync(30_000);
    expect(host.told).toHaveBeenCalled();
  });
});

class FakeCache implements KioskCache {
  readonly things = new Map<string, string>();
  async match(key: string): Promise<Response | undefined> {
    const found = this.things.get(key);
    return found === undefined ? undefined : new Response(found);
  }
  async put(key: string, response: Response): Promise<void> {
    this.things.set(key, await response.text());
  }
  async delete(key: string): Promise<void> {
    this.things.delete(key);
  }
  async keys(): Promise<string[]> {
    return [...this.things.keys()];
  }
}

describe("what a kiosk keeps", () => {
  const make = (secret = "SECRET", cache = new FakeCache()) => {
    const site = new Site();
    const store = new KioskStore({
      openCache: async () => cache,
      secret,
      files: () => ["/assets/main-1.js"],
      fetch: async (address, init) =>
        address.startsWith("/api") ? site.answer(address, init) : new Response(`file ${address}`),
    });
    return { site, cache, store };
  };

  it("is the page, its files, the views with their pictures, and what it was told, but not its secret", async () => {
    const { cache, store, site } = make();
    await store.keep(site.self, "1");
    expect(await store.lastTold()).toEqual(site.self);
    const keys = await cache.keys();
    for (const key of [
      "/kiosk/",
      "/assets/main-1.js",
      "/api/v1/models/pot/views/a?as=kiosk",
      "/api/v1/models/pot/views/b/picture?as=kiosk",
    ])
      expect(keys).toContain(key);
    expect(JSON.stringify([...cache.things])).not.toContain("SECRET");
    expect(await make("OTHER", cache).store.lastTold()).toBeNull();
  });

  it("goes when a later state does not need it, and is not read again while nothing changed", async () => {
    const { cache, store, site } = make();
    await store.keep(site.self, "1");
    const { length } = site.asked;
    await store.keep(site.self, "1");
    expect(site.asked.length).toBe(length);
    const later = told({ stops: [stop("b"), stop("gone")], version: 2 });
    await store.keep(later, "2");
    const keys = await cache.keys();
    expect(keys.some((key) => key.includes("/views/a"))).toBe(false);
    expect(keys).toContain("/api/v1/models/pot/views/b?as=kiosk");
    await store.forget();
    expect(await cache.keys()).toEqual([]);
  });

  it("stays as it was where it cannot be read anew, which is tried again", async () => {
    const { cache, store, site } = make();
    await store.keep(site.self, "1");
    site.away = true;
    await store.keep(told({ stops: [stop("b")], version: 2 }), "2");
    expect((await cache.keys()).some((key) => key.includes("/views/a"))).toBe(true);
    site.away = false;
    await store.keep(told({ stops: [stop("b")], version: 2 }), "2");
    expect((await cache.keys()).some((key) => key.includes("/views/a"))).toBe(false);
  });

  it("is worth nothing after the link is over", async () => {
    const { store, site } = make();
    const self = { ...site.self, expires: "2026-06-01T00:00:00Z" };
    await store.keep(self, "1");
    expect(await store.lastTold(new Date("2026-05-01"))).toEqual(self);
    expect(await store.lastTold(new Date("2026-07-01"))).toBeNull();
  });

  it("is nothing where the browser has no store", async () => {
    const { site } = make();
    const store = new KioskStore({
      openCache: async () => null,
      secret: "SECRET",
      fetch: async (address) => site.answer(address),
    });
    await store.keep(site.self, "1");
    expect(await store.lastTold()).toBeNull();
    await store.forget();
  });
});

describe("the kiosk", () => {
  const make = (site = new Site(), last: KioskSelf | null = null) => {
    const sockets: FakeSocket[] = [];
    const store = {
      lastTold: vi.fn(async () => last),
      keep: vi.fn(async () => {}),
      forget: vi.fn(async () => {}),
    };
    const reload = vi.fn();
    const session = new KioskSession({
      api: site.api,
      secret: "SECRET",
      store,
      reload,
      makeSocket: (url, protocol) => {
        const socket = new FakeSocket(url, protocol);
        sockets.push(socket);
        return socket;
      },
    });
    session.open();
    return { site, session, sockets, store, reload };
  };
  const connect = (socket: FakeSocket): void => {
    socket.open();
    socket.receive({
      ...welcome(),
      model: { bounds: { min: [-1, -1, -1], max: [1, 1, 1] }, up: "z" } as never,
    });
  };

  it("plays by itself, begins at the first stop for who touches it, and rests again when they are gone", async () => {
    const { session, sockets } = make();
    await settle();
    expect([session.ready, session.resting, session.index]).toEqual([true, true, 0]);
    expect(sockets[0]!.url).toBe("wss://strata.example/api/v1/models/pot/live?as=kiosk");
    await vi.advanceTimersByTimeAsync(12_000);
    expect(session.index).toBe(1);
    session.touched();
    expect([session.resting, session.index]).toEqual([false, 0]);
    session.step(1);
    session.step(1);
    session.chooseLanguage("de");
    expect([session.index, session.language]).toEqual([1, "de"]);
    await vi.advanceTimersByTimeAsync(59_000);
    expect(session.index).toBe(1);
    await vi.advanceTimersByTimeAsync(11_500);
    expect([session.resting, session.index, session.language]).toEqual([true, 0, "en"]);
  });

  it("has pictures again by itself after the server was away, and asks at once why the connection was lost", async () => {
    const { site, session, sockets } = make();
    await settle();
    connect(sockets[0]!);
    const before = count(site, "GET /kiosk");
    site.away = true;
    sockets[0]!.lose();
    await settle();
    expect(count(site, "GET /kiosk")).toBe(before + 1);
    expect(session.show!.away).toBe(false);
    await vi.advanceTimersByTimeAsync(3500);
    expect(session.show!.away).toBe(true);
    site.away = false;
    await vi.advanceTimersByTimeAsync(10_000);
    connect(sockets.at(-1)!);
    session.show!.frameDrawn({ header: { view_id: 0, frame: 1 } } as never);
    expect([session.show!.away, session.show!.drawn]).toEqual([false, true]);
  });

  it("goes on with what it was told last where the server is away at the start", async () => {
    const site = new Site();
    site.away = true;
    const { session } = make(site, told());
    await settle();
    // this test has no worker that stores the views
    expect([session.tour?.name, session.ready]).toEqual(["T", false]);
    site.away = false;
    await vi.advanceTimersByTimeAsync(31_000);
    expect([session.ready, session.stops.length]).toEqual([true, 2]);
  });

  it("takes a changed tour, and passes over stops whose views are gone", async () => {
    const { site, session } = make();
    await settle();
    session.touched();
    session.step(1);
    site.self = told({ version: 2, stops: [stop("c"), stop("gone")] });
    await vi.advanceTimersByTimeAsync(31_000);
    expect([session.stops.map(({ view: { slug } }) => slug), session.index]).toEqual([["c"], 0]);
  });

  it("changes no layer beneath an open card", async () => {
    const { session, sockets } = make();
    await settle();
    sockets[0]!.open();
    const layers = ["sherds", "cracks"].map(
      (slug, place) => ({ id: place + 1, slug }) as NonNullable<(typeof session.choices)[number]>,
    );
    session.choices = layers;
    session.choice = layers[0]!;
    session.card = {} as NonNullable<typeof session.card>;
    session.swipe(1);
    expect([session.choice.slug, session.card === null]).toEqual(["sherds", false]);
    session.card = null;
    session.swipe(1);
    expect(session.choice.slug).toBe("cracks");
  });

  it("says so when its link is worthless, and keeps nothing", async () => {
    const { site, session, sockets, store } = make();
    await settle();
    site.revoked = true;
    sockets[0]!.lose();
    await settle();
    expect([session.worthless, session.show, store.forget.mock.calls.length]).toEqual([
      true,
      null,
      1,
    ]);
    await vi.advanceTimersByTimeAsync(600_000);
    expect([sockets.length, store.forget.mock.calls.length]).toEqual([1, 1]);
  });

  it("has no more timers and listeners after a simulated week of visitors than after a minute", async () => {
    const { session, sockets } = make();
    await settle();
    connect(sockets[0]!);
    session.show!.frameDrawn({ header: { view_id: 0, frame: 1 } } as never);
    const rounds: number[] = [];
    for (let round = 0; round < 2000; ++round) {
      session.touched();
      session.step(1);
      session.chooseLanguage("de");
      // time for the question, the timeout and the automatic tour
      await vi.advanceTimersByTimeAsync(300_000);
      expect(session.resting).toBe(true);
      sockets[0]!.sent.length = 0;
      // The fake server sends no messages here, so the page correctly closes the connection.
      if (sockets.length > 1) sockets.splice(0, sockets.length - 1);
      rounds.push(vi.getTimerCount());
    }
    expect(Math.max(...rounds)).toBeLessThanOrEqual(6);
    session.close();
    expect(vi.getTimerCount()).toBe(0);
  }, 120_000);
});
