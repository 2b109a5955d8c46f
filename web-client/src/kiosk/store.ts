// What a kiosk keeps in its browser, so that the tour goes on while the server is away: the page's
// files, what it was told of its tour, and all that the stops show. Where browsers have no such
// store (addresses without TLS other than localhost), nothing is kept.

import { Api, ApiError, type Fetch } from "../net/api";
import type { KioskSelf } from "../core/protocol.gen";
import { as_kiosk, patient_fetch, picture_of_view } from "./as-kiosk";
import { card_of } from "./cards";

/** As the browser has it: of CacheStorage and Cache what is used here. */
export interface StoreShelf {
  match(key: string): Promise<Response | undefined>;
  put(key: string, response: Response): Promise<void>;
  delete(key: string): Promise<unknown>;
  /** Paths with their queries. */
  keys(): Promise<string[]>;
}

export interface StoreOptions {
  open_shelf: () => Promise<StoreShelf | null>;
  secret: string;
  fetch?: Fetch;
  /** Of the page and what it has loaded. */
  files?: () => string[];
}

const kCache = "strata-kiosk";
/** Under which the page is stored, whatever its secret; what the worker has a say over. */
const kPageKey = "/kiosk/";
const kAgain_ms = 6 * 3600_000; // records may have changed without a new version of the tour

export class KioskStore {
  private kept_ = ""; // what the last complete keeping was of
  private kept_ms_ = 0;
  private keeping_ = false;

  constructor(private readonly options_: StoreOptions) {}

  /**
   * What the server told of this link last; null where that is not known, or the link is over by
   * now.
   */
  async last_told(now: Date = new Date()): Promise<KioskSelf | null> {
    const found = await (await this.options_.open_shelf())?.match(await this.self_key());
    if (!found) return null;
    const self = (await found.json()) as KioskSelf;
    return self.expires && new Date(self.expires) <= now ? null : self;
  }

  /** The link is worthless: nothing of it stays. */
  async forget(): Promise<void> {
    this.kept_ = "";
    const shelf = await this.options_.open_shelf();
    for (const key of (await shelf?.keys()) ?? []) await shelf?.delete(key);
  }

  /**
   * Keeps the tour with all that it shows, one thing after the other, and nothing else: what a
   * former state of it needed goes. `state`: another one is kept anew. What fails is tried again
   * with the next call.
   */
  async keep(self: KioskSelf, state: string): Promise<void> {
    const now_ms = performance.now();
    if (this.keeping_ || (state === this.kept_ && now_ms - this.kept_ms_ < kAgain_ms)) return;
    this.keeping_ = true;
    try {
      const shelf = await this.options_.open_shelf();
      if (shelf && (await this.keep_on(shelf, self))) {
        this.kept_ = state;
        this.kept_ms_ = now_ms;
      }
    } finally {
      this.keeping_ = false;
    }
  }

  private async keep_on(shelf: StoreShelf, self: KioskSelf): Promise<boolean> {
    const kept = new Set<string>();
    let complete = true;
    const put = async (key: string, ask: () => Promise<Response>): Promise<void> => {
      if (kept.has(key)) return;
      try {
        const response = await ask();
        if (!response.ok) complete &&= response.status < 500;
        else {
          await shelf.put(key, response);
          kept.add(key);
        }
      } catch {
        complete = false;
      }
    };
    const get = this.options_.fetch ?? patient_fetch;
    await put(await this.self_key(), async () => new Response(JSON.stringify(self)));
    await put(kPageKey, () => get(kPageKey));
    for (const file of (this.options_.files ?? files_of_page)()) await put(file, () => get(file));
    try {
      await keep_tour(self, get, put);
    } catch {
      complete = false;
    }
    if (complete) for (const key of await shelf.keys()) if (!kept.has(key)) await shelf.delete(key);
    return complete;
  }

  /** Not the secret itself: it is nobody's who reads the store. */
  private async self_key(): Promise<string> {
    const digest = await crypto.subtle.digest(
      "SHA-256",
      new TextEncoder().encode(this.options_.secret),
    );
    return `/kiosk/told/${[...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
  }
}

type Put = (key: string, ask: () => Promise<Response>) => Promise<void>;

/** Asks for all that visitors may come to see at the stops, and puts each answer away. */
async function keep_tour({ model, tour }: KioskSelf, get: Fetch, put: Put): Promise<void> {
  const api = new Api(async (address, init) => {
    const response = await get(as_kiosk(address), init);
    const copy = response.clone();
    await put(as_kiosk(address), async () => copy);
    return response;
  });
  const picture = (address: string): Promise<void> => put(address, () => get(address));
  for (const view of new Set(tour.stops.flatMap((stop) => stop.view ?? []))) {
    await unless_gone(api.view(model, view));
    await picture(picture_of_view(model, view));
  }
  for (const stop of tour.stops)
    for (const { table, keys } of stop.records)
      for (const key of keys) {
        const card = await card_of(api, {
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

async function unless_gone(asked: Promise<unknown>): Promise<void> {
  try {
    await asked;
  } catch (error) {
    if (!(error instanceof ApiError) || error.status !== 404) throw error;
  }
}

/** What the page has loaded under names that never change, and its icon. */
function files_of_page(): string[] {
  const loaded = performance.getEntriesByType("resource").map(({ name }) => new URL(name));
  const own = loaded.filter(
    ({ origin, pathname }) => origin === location.origin && pathname.startsWith("/assets/"),
  );
  return [...new Set([...own.map(({ pathname }) => pathname), "/favicon.svg"])];
}

export async function open_browser_shelf(): Promise<StoreShelf | null> {
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
export async function start_worker(): Promise<void> {
  try {
    await navigator.serviceWorker?.register("/kiosk-worker.js", { scope: kPageKey });
  } catch (error) {
    // a browser that has none, or whose owner forbids it
    console.info("no service worker:", String(error));
  }
}
