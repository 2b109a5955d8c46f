// What a kiosk keeps in its browser, so that the tour goes on while the server is away: the page's
// files, what it was told of its tour, and all that the stops show. Where browsers have no such
// store (addresses without TLS other than localhost), nothing is kept.

import { Api, type Fetch } from "../net/api";
import { ApiError } from "../net/api-error";
import type { KioskSelf } from "../core/protocol.gen";
import { asKiosk, patientFetch, pictureOfView } from "./as-kiosk";
import { cardOf } from "./cards";

/** As the browser has it: of CacheStorage and Cache what is used here. */
export interface KioskCache {
  match(key: string): Promise<Response | undefined>;
  put(key: string, response: Response): Promise<void>;
  delete(key: string): Promise<unknown>;
  /** Paths with their queries. */
  keys(): Promise<string[]>;
}

export interface StoreOptions {
  openCache: () => Promise<KioskCache | null>;
  secret: string;
  fetch?: Fetch;
  /** Of the page and what it has loaded. */
  files?: () => string[];
}

const kCache = "strata-kiosk";
/** Under which the page is stored, whatever its secret; what the worker has a say over. */
const kPageKey = "/kiosk/";
const kAgainMs = 6 * 3600_000; // records may have changed without a new version of the tour

export class KioskStore {
  private _kept = ""; // what the last complete keeping was of
  private _keptMs = 0;
  private _keeping = false;

  constructor(private readonly _options: StoreOptions) {}

  /**
   * What the server told of this link last; null where that is not known, or the link is over by
   * now.
   */
  async lastTold(now: Date = new Date()): Promise<KioskSelf | null> {
    const found = await (await this._options.openCache())?.match(await this.selfKey());
    if (!found) return null;
    const self = (await found.json()) as KioskSelf;
    return self.expires && new Date(self.expires) <= now ? null : self;
  }

  /** The link is worthless: nothing of it stays. */
  async forget(): Promise<void> {
    this._kept = "";
    const cache = await this._options.openCache();
    for (const key of (await cache?.keys()) ?? []) await cache?.delete(key);
  }

  /**
   * Keeps the tour with all that it shows, one thing after the other, and nothing else: what a
   * former state of it needed goes. `state`: another one is kept anew. What fails is tried again
   * with the next call.
   */
  async keep(self: KioskSelf, state: string): Promise<void> {
    const nowMs = performance.now();
    if (this._keeping || (state === this._kept && nowMs - this._keptMs < kAgainMs)) return;
    this._keeping = true;
    try {
      const cache = await this._options.openCache();
      if (cache && (await this.keepOn(cache, self))) {
        this._kept = state;
        this._keptMs = nowMs;
      }
    } finally {
      this._keeping = false;
    }
  }

  private async keepOn(cache: KioskCache, self: KioskSelf): Promise<boolean> {
    const kept = new Set<string>();
    let complete = true;
    const put = async (key: string, ask: () => Promise<Response>): Promise<void> => {
      if (kept.has(key)) return;
      try {
        const response = await ask();
        if (!response.ok) complete &&= response.status < 500;
        else {
          await cache.put(key, response);
          kept.add(key);
        }
      } catch {
        complete = false;
      }
    };
    const get = this._options.fetch ?? patientFetch;
    await put(await this.selfKey(), async () => new Response(JSON.stringify(self)));
    await put(kPageKey, () => get(kPageKey));
    for (const file of (this._options.files ?? filesOfPage)()) await put(file, () => get(file));
    try {
      await keepTour(self, get, put);
    } catch {
      complete = false;
    }
    if (complete) for (const key of await cache.keys()) if (!kept.has(key)) await cache.delete(key);
    return complete;
  }

  /** Not the secret itself: it is nobody's who reads the store. */
  private async selfKey(): Promise<string> {
    const digest = await crypto.subtle.digest(
      "SHA-256",
      new TextEncoder().encode(this._options.secret),
    );
    return `/kiosk/told/${[...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
  }
}

type Put = (key: string, ask: () => Promise<Response>) => Promise<void>;

/** Asks for all that visitors may come to see at the stops, and puts each answer away. */
async function keepTour({ model, tour }: KioskSelf, get: Fetch, put: Put): Promise<void> {
  const api = new Api(async (address, init) => {
    const response = await get(asKiosk(address), init);
    const copy = response.clone();
    await put(asKiosk(address), async () => copy);
    return response;
  });
  const picture = (address: string): Promise<void> => put(address, () => get(address));
  for (const view of new Set(tour.stops.flatMap((stop) => stop.view ?? []))) {
    await unlessGone(api.json("GET /models/{model}/views/{view}", { path: { model, view } }));
    await picture(pictureOfView(model, view));
  }
  for (const stop of tour.stops)
    for (const { table, keys } of stop.records)
      for (const key of keys) {
        const card = await cardOf(api, {
          table,
          key,
          stop,
          language: tour.languages[0]!,
          languages: tour.languages,
        });
        for (const { small, large } of card?.pictures ?? []) {
          await picture(small);
          await picture(large);
        }
      }
}

async function unlessGone(asked: Promise<unknown>): Promise<void> {
  try {
    await asked;
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 404) throw error;
  }
}

/** What the page has loaded under names that never change, and its icon. */
function filesOfPage(): string[] {
  const loaded = performance.getEntriesByType("resource").map(({ name }) => new URL(name));
  const own = loaded.filter(
    ({ origin, pathname }) => origin === location.origin && pathname.startsWith("/assets/"),
  );
  return [...new Set([...own.map(({ pathname }) => pathname), "/favicon.svg"])];
}

export async function openBrowserCache(): Promise<KioskCache | null> {
  if (!("caches" in globalThis) || !("subtle" in crypto)) return null;
  const cache = await caches.open(kCache);
  return {
    match: (key) => cache.match(key, { ignoreVary: true }),
    put: (key, response) => cache.put(key, response),
    delete: (key) => cache.delete(key, { ignoreVary: true }),
    keys: async () =>
      (await cache.keys())
        .map(({ url }) => new URL(url))
        .map(({ pathname, search }) => pathname + search),
  };
}

/**
 * The worker that answers from the store. Without one the page goes on all the same, as long as
 * nobody loads it anew.
 */
export async function startWorker(): Promise<void> {
  try {
    await navigator.serviceWorker?.register("/kiosk-worker.js", { scope: kPageKey });
  } catch (error) {
    // a browser that has none, or whose owner forbids it
    console.info("no service worker:", String(error));
  }
}
